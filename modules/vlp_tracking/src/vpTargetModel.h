/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpTargetModel_h
#define vpTargetModel_h

#include <array>

#include <visp3/core/vpRGBa.h>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  Into which bin of a histogram a pixel falls. Grey: 32 bins of 8 grey levels. Colour: 16 hues of 4
  saturations each; pixels too grey or too dark to have a hue fall into 8 bins of intensity instead, so that a
  white lamp in a colour picture is a target too.
*/
struct vpGreyBins {
  static constexpr int count = 32;
  static constexpr int width = 8; // grey levels
  int operator()(unsigned char grey) const { return grey >> 3; }
};

struct vpColourBins {
  static constexpr int hues = 16;
  static constexpr int saturations = 4;
  static constexpr int intensities = 8;
  static constexpr int count = hues * saturations + intensities;
  using Table = std::array<unsigned char, 1 << 15>; // bins by the upper five bits of red, green and blue

  const Table &bins = table();
  int operator()(const vpRGBa &pixel) const
  {
    return bins[(pixel.R >> 3) << 10 | (pixel.G >> 3) << 5 | pixel.B >> 3];
  }
  static const Table &table();
};

//! Shares of the bins; unused ones stay 0.
using vpBinShares = std::array<double, vpColourBins::count>;

/*!
  What the target looks like: its histogram q, and by how much each bin tells it from its surroundings, whose
  histogram is o.

  A bin's weight is w = (max(0, q - o) / (q + o))^2, after Comaniciu, Ramesh and Meer, Kernel-based object
  tracking, PAMI 2003, section 6.1, whose weights min(o)/o depend on the rarest bin alone: 1 for what the
  target alone has, 0 for what the surroundings have at least as much of. Squared, for bins of little weight
  are all over a window, and would pull more than they tell.

  The histograms are smoothed over neighbouring bins: a stripe that meets the lines at another phase has other
  grey levels, all of them between those of the lit lamp and of the dark. So grey values are smoothed by a
  share of what the target differs from its surroundings: little where that is little.
*/
class vpTargetModel
{
public:
  //! Weights are in 255ths, as a back projection has them.
  using Weights = std::array<int, vpColourBins::count>;

  void learn(bool colour, const vpBinShares &target, const vpBinShares &surroundings);

  //! Moves the model by the share \e rate of the way to what is seen now.
  void refresh(const vpBinShares &target, const vpBinShares &surroundings, double rate);

  const Weights &weights() const { return m_weights; }

  //! Share of a histogram that tells the target from its surroundings: sum of w p.
  double mass(const vpBinShares &shares) const;

  /*!
    Bhattacharyya coefficient of the weighted histograms, sum of sqrt(p' q') with p' = w p / max(sum w p, sum
    w q) and q' = w q / sum w q: 0 to 1. The candidate is not blown up to sum 1 where it has less to show than
    the target: a window in which half of the target is hidden has 0.71, one that shows a sliver nearly 0.
  */
  double bhattacharyya(const vpBinShares &candidate) const;

private:
  vpBinShares smoothed(const vpBinShares &shares) const;
  void setSmoothing(double greyLevels);
  double contrast() const; // grey levels
  void weigh();

  bool m_colour = false;
  std::array<std::array<double, vpGreyBins::count>, vpGreyBins::count> m_blur{}; // each bin's, onto others
  vpBinShares m_target{};
  vpBinShares m_surroundings{};
  Weights m_weights{};
};

END_VISP_NAMESPACE

#endif
