/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpWindowSums_h
#define vpWindowSums_h

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <visp3/core/vpImage.h>
#include <visp3/core/vpRect.h>

#include "vpTargetModel.h"

BEGIN_VISP_NAMESPACE

/*!
  A window's extent along one axis, clipped to the picture, under the kernel 1 - (2 x / length)^2 about its
  middle. A target fills the middle of its window; towards the borders there is more and more background. Of a
  large window one pixel of `step` is looked at: what is left tells the middle as well as that of a small one.
*/
struct vpKernelAxis {
  int step = 1;             // pixels
  int first = 0;            // pixel
  std::vector<int> weights; // of the pixels first, first + step, ..., in 255ths
  double middle = 0;        // of the whole window, pixel
  double sum = 0;           // of the weights
  double visible = 0;       // share of the kernel that lies inside the picture
  double targetMean = 0;    // px from the middle: mean under the kernel of the part inside of a disc there

  void set(double centre, double length, double targetLength, unsigned int pixels);
  static int stepOf(double length)
  {
    static const double enough = 50; // pixels across
    return std::max(1, static_cast<int>(length / enough));
  }
};

//! Back projection of a model onto a window, summed up under the kernel.
struct vpWindowMoments {
  double mass = 0;               // mean weight of the pixels inside the picture, 0 to 1
  double meanU = 0, meanV = 0;   // px from the window's middle
  double sigmaU = 0, sigmaV = 0; // px, spread about the mean
};

/*!
  Sums over a window of a picture and nothing else; no picture of the back projection is made. Kept between
  frames for its memory.
*/
class vpWindowSums
{
public:
  //! Share of the kernel inside the picture, of the last window.
  double visible() const { return m_across.visible * m_down.visible; }

  //! Histogram under the kernel of the part inside the picture.
  template <class Pixel, class Bins>
  vpBinShares histogram(const vpImage<Pixel> &I, const Bins &binOf, const vpRect &window);

  //! Plain histogram of what lies in \e outer, but not in \e inner.
  template <class Pixel, class Bins>
  vpBinShares histogramAround(const vpImage<Pixel> &I, const Bins &binOf, const vpRect &inner,
                              const vpRect &outer);

  /*!
    Zeroth to second moments. At the border of the picture a target loses a part, and what is left has its
    mean farther inside; as much as a disc's in the middle of the window would is taken off, so that a target
    half outside is not pulled in. \e share: of the window's sides that the target has.
  */
  template <class Pixel, class Bins>
  vpWindowMoments moments(const vpImage<Pixel> &I, const Bins &binOf, const vpTargetModel::Weights &weights,
                          const vpRect &window, double share);

private:
  // Neighbouring pixels mostly fall into the same bin, and would wait for each other's sum.
  using Lanes = std::array<std::array<std::uint64_t, vpColourBins::count>, 4>;

  template <class Pixel>
  void place(const vpImage<Pixel> &I, const vpRect &window, double share)
  {
    const vpImagePoint centre = window.getCenter();
    m_across.set(centre.get_u(), window.getWidth(), share * window.getWidth(), I.getWidth());
    m_down.set(centre.get_v(), window.getHeight(), share * window.getHeight(), I.getHeight());
  }
  static vpBinShares shares(const Lanes &lanes);
  vpWindowMoments summedUp(const std::vector<std::uint64_t> &rows) const;

  vpKernelAxis m_across, m_down;
  std::vector<std::uint32_t> m_columns; // back projection under the kernel's down axis
  std::vector<std::uint64_t> m_rows;    // under its across axis
};

template <class Pixel, class Bins>
vpBinShares vpWindowSums::histogram(const vpImage<Pixel> &I, const Bins &binOf, const vpRect &window)
{
  place(I, window, 1);
  Lanes lanes{};
  const size_t width = m_across.weights.size(), step = static_cast<size_t>(m_across.step);
  const int *across = m_across.weights.data();
  for (size_t y = 0; y < m_down.weights.size(); ++y) {
    const Pixel *row = I[m_down.first + static_cast<int>(y) * m_down.step] + m_across.first;
    const int down = m_down.weights[y];
    for (size_t x = 0; x < width; ++x) {
      lanes[x & 3][binOf(row[x * step])] += static_cast<unsigned int>(across[x] * down);
    }
  }
  return shares(lanes);
}

template <class Pixel, class Bins>
vpBinShares vpWindowSums::histogramAround(const vpImage<Pixel> &I, const Bins &binOf, const vpRect &inner,
                                          const vpRect &outer)
{
  auto clipped = [](double edge, unsigned int pixels) {
    return static_cast<int>(std::lround(std::clamp(edge, 0.0, double(pixels))));
  };
  const int left = clipped(outer.getLeft(), I.getWidth()),
            right = clipped(outer.getRight() + 1, I.getWidth());
  const int innerLeft = std::clamp(clipped(inner.getLeft(), I.getWidth()), left, right);
  const int innerRight = std::clamp(clipped(inner.getRight() + 1, I.getWidth()), left, right);
  const int innerTop = clipped(inner.getTop(), I.getHeight());
  const int innerBottom = clipped(inner.getBottom() + 1, I.getHeight());
  const int bottom = clipped(outer.getBottom() + 1, I.getHeight());
  const int across = vpKernelAxis::stepOf(outer.getWidth()), down = vpKernelAxis::stepOf(outer.getHeight());
  Lanes lanes{};
  for (int y = clipped(outer.getTop(), I.getHeight()); y < bottom; y += down) {
    const Pixel *row = I[y];
    const bool beside = y >= innerTop && y < innerBottom;
    for (int x = left; x < (beside ? innerLeft : right); x += across) {
      ++lanes[x & 3][binOf(row[x])];
    }
    for (int x = beside ? innerRight : right; x < right; x += across) {
      ++lanes[x & 3][binOf(row[x])];
    }
  }
  return shares(lanes);
}

template <class Pixel, class Bins>
vpWindowMoments vpWindowSums::moments(const vpImage<Pixel> &I, const Bins &binOf,
                                      const vpTargetModel::Weights &weights, const vpRect &window,
                                      double share)
{
  place(I, window, share);
  const size_t width = m_across.weights.size(), step = static_cast<size_t>(m_across.step);
  m_columns.assign(width, 0);
  m_rows.assign(m_down.weights.size(), 0);
  const int *across = m_across.weights.data();
  std::uint32_t *columns = m_columns.data();
  for (size_t y = 0; y < m_rows.size(); ++y) {
    const Pixel *row = I[m_down.first + static_cast<int>(y) * m_down.step] + m_across.first;
    const unsigned int down = static_cast<unsigned int>(m_down.weights[y]);
    std::uint64_t sum = 0;
    for (size_t x = 0; x < width; ++x) {
      const unsigned int weight = static_cast<unsigned int>(weights[binOf(row[x * step])]);
      sum += weight * static_cast<unsigned int>(across[x]);
      columns[x] += weight * down;
    }
    m_rows[y] = sum;
  }
  return summedUp(m_rows);
}

END_VISP_NAMESPACE

#endif
