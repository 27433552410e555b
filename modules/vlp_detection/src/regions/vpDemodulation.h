/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpDemodulation_h
#define vpDemodulation_h

#include <vector>

#include <opencv2/core.hpp>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! A box with \e by pixels more on each side.
inline cv::Rect vpGrown(const cv::Rect &box, int by)
{
  return {box.x - by, box.y - by, box.width + 2 * by, box.height + 2 * by};
}

//! A few lit lines together: what they have more than the dark lines beside them, sample by sample.
struct vpLitBand {
  int first, last;                // lines
  std::vector<float> light, dark; // dark: what the dark lines have
  float own; // the lamp's own part of dark, as a share of light: above 0 where short gaps leave no line dark
};

//! Samples of a band that are brighter than some level.
struct vpLitRun {
  size_t band;
  int first, last;
};

//! Lit and dark lines of a window, and what the former have more.
class vpDemodulation
{
public:
  static constexpr int thick = 3; // lines of a band, most

  vpDemodulation(const cv::Mat_<unsigned char> &lines, const std::vector<float> &lit, const cv::Rect &window);
  void drop(const std::vector<cv::Rect> &others);
  std::vector<vpLitRun> runsAbove(double level) const;
  const std::vector<vpLitBand> &bands() const { return m_bands; }
  double noise() const; // grey levels, standard deviation of a band's light
  //! Median grey value of dark lines, where a lamp's region has no samples.
  double background(const cv::Rect &lamp = {}) const;
  double brightest() const;

private:
  void addBands(int first, int last, const std::vector<int> &dark, const std::vector<float> &lit);
  void dropOthers();

  const cv::Mat_<unsigned char> &m_lines;
  cv::Rect m_window;
  std::vector<vpLitBand> m_bands;
};

END_VISP_NAMESPACE

#endif
