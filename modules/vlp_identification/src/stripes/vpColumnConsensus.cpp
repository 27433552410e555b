/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// vpStripeProfile::agreedByColumns(): the modulation that all columns of a lamp share, whatever its emission
// pattern.

#include <visp3/vlp_identification/vpStripeAnalyzer.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <visp3/vlp_core/vpBrighter.h>

BEGIN_VISP_NAMESPACE

namespace
{
//! Moves the values, of which there are some, about.
double medianOf(std::vector<double> &values)
{
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

//! Standard deviation of a region's pixels, grey levels: what neighbours differ by, whatever pattern they
//! show.
double noiseOf(const cv::Mat_<unsigned char> &lines, const cv::Rect &box)
{
  static const double least = 0.3,
                      perMedian = 0.954; // 8 bits round; median of two Gaussian pixels' difference
  std::vector<double> differences;
  for (int line = box.y; line < box.br().y; ++line) {
    for (int x = box.x; x + 1 < box.br().x; ++x) {
      differences.push_back(std::abs(lines(line, x + 1) - lines(line, x)));
    }
  }
  return differences.empty() ? least : std::max(least, medianOf(differences) / perMedian);
}

//! Means of a region's lines in strips of columns, grey levels above its darkest twentieth; one row a line.
cv::Mat_<double> stripsOf(const cv::Mat_<unsigned char> &lines, const cv::Rect &box, int width)
{
  cv::Mat_<double> strips(box.height, box.width / width);
  std::vector<double> all;
  for (int line = 0; line < strips.rows; ++line) {
    for (int strip = 0; strip < strips.cols; ++strip) {
      strips(line, strip) =
          static_cast<double>(vpBrighter::sum(lines[box.y + line] + box.x + strip * width, width)) / width;
      all.push_back(strips(line, strip));
    }
  }
  static const long few = 20;
  const auto darkest = all.begin() + static_cast<long>(all.size()) / few;
  std::nth_element(all.begin(), darkest, all.end());
  strips -= *darkest;
  return strips;
}

//! The most light of each strip within so many lines to both sides.
cv::Mat_<double> envelopeOf(const cv::Mat_<double> &strips, int lines)
{
  cv::Mat_<double> most(strips.size());
  for (int strip = 0; strip < strips.cols; ++strip) {
    for (int line = 0; line < strips.rows; ++line) {
      const int first = std::max(0, line - lines), last = std::min(strips.rows - 1, line + lines);
      double peak = 0;
      for (int i = first; i <= last; ++i) {
        peak = std::max(peak, strips(i, strip));
      }
      most(line, strip) = peak;
    }
  }
  return most;
}

//! What the strips of one line say of its light, as a share of the most.
struct LineShare {
  double median = 0, sigma = 0;
  double leftOverRight = 0; // median of one half less that of the other
  bool known = false, halvesKnown = false;

  LineShare(const double *strip, const double *most, int strips, double enough)
  {
    static const size_t fewest = 5;
    static const double perDeviation = 1.4826, ofMedian = 1.2533; // of normal deviates
    std::vector<double> shares, ofLeft, ofRight;
    for (int i = 0; i < strips; ++i) {
      if (most[i] > enough) {
        (2 * i < strips ? ofLeft : ofRight).push_back(strip[i] / most[i]);
        shares.push_back(strip[i] / most[i]);
      }
    }
    halvesKnown = std::min(ofLeft.size(), ofRight.size()) > fewest / 2;
    if (halvesKnown) {
      leftOverRight = medianOf(ofLeft) - medianOf(ofRight);
    }
    known = shares.size() >= fewest;
    if (known) {
      median = medianOf(shares);
      for (double &share : shares) {
        share = std::abs(share - median);
      }
      sigma = ofMedian * perDeviation * medianOf(shares) / std::sqrt(static_cast<double>(shares.size()));
    }
  }
};
} // namespace

vpStripeProfile vpStripeProfile::agreedByColumns(const cv::Mat_<unsigned char> &lines,
                                                 const vpLineTiming &timing, const vpLedRoi &roi)
{
  static const int mostStrips = 24, narrowest = 2; // samples
  static const int periods = 4;                    // that a lamp shows, or more
  static const double sigmas = 10, dimmest = 0.04; // standard deviations; of the brightest strip
  static const double lit = 100, least = 0.5;      // grey levels, of a lit line; of its standard deviation
  vpStripeProfile profile;
  profile.exposure = std::hypot(timing.exposure(), timing.averaging());
  profile.logExposureSigma = timing.logExposureSigma();
  const int width = std::max(narrowest, roi.box.width / mostStrips);
  if (roi.box.width < width) {
    return profile;
  }
  const cv::Mat_<double> strips = stripsOf(lines, roi.box, width);
  const cv::Mat_<double> most = envelopeOf(strips, std::max(2, roi.box.height / (2 * periods)));
  const double enough = std::max(sigmas * noiseOf(lines, roi.box) / std::sqrt(width),
                                 dimmest * *std::max_element(most.begin(), most.end()));
  double differences = 0; // of the halves, sum of squares
  int halves = 0, last = -1;
  for (int line = 0; line < strips.rows; ++line) {
    const LineShare share(strips[line], most[line], strips.cols, enough);
    if (share.halvesKnown) {
      differences += share.leftOverRight * share.leftOverRight;
      ++halves;
    }
    if (share.known) {
      if (line > last + 1 && last >= 0) {
        return {}; // dark for longer than a lamp of so many periods is
      }
      last = line;
      profile.time.push_back(timing.middle(static_cast<unsigned int>(roi.box.y + line)));
      profile.light.push_back(lit * share.median);
      profile.sigma.push_back(std::max(least, lit * share.sigma));
    }
  }
  if (halves == 0) {
    return {};
  }
  // Neighbouring columns may share texture; all share the modulation.
  const double texture = 0.5 * lit * std::sqrt(differences / halves);
  for (double &sigma : profile.sigma) {
    sigma = std::max(sigma, texture);
  }
  return profile;
}

END_VISP_NAMESPACE
