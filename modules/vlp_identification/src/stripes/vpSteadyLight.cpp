/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpSteadyLight.h"

#include <algorithm>
#include <cstddef>
#include <vector>

BEGIN_VISP_NAMESPACE

namespace
{
//! How far some value lies below the lower one of the largest before and the largest after it, beyond \e
//! tolerance: (a - b) / (a + b), were it the largest of all.
double deepestDip(const std::vector<double> &values, double tolerance)
{
  std::vector<double> after(values.size()); // the largest from there on
  double most = 0;
  for (size_t i = values.size(); i-- > 0;) {
    most = std::max(most, values[i]);
    after[i] = most;
  }
  double before = 0, deepest = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    before = std::max(before, values[i]);
    deepest = std::max(deepest, std::min(before, after[i]) - values[i] - tolerance);
  }
  return deepest / std::max(2 * most - deepest, 1.0);
}
} // namespace

double vpDeepestDip(const cv::Mat_<unsigned char> &lines, const vpLedRoi &roi)
{
  static const size_t fewest = 12; // lines
  static const int reach = 4;      // samples beyond the ends of a chord, past a little blur
  if (roi.chords.size() < fewest || roi.chords.size() != static_cast<size_t>(roi.box.height)) {
    return 1;
  }
  std::vector<double> light, length;
  light.reserve(roi.chords.size());
  length.reserve(roi.chords.size());
  double outside = 255;
  for (const vpLedChord &chord : roi.chords) {
    const unsigned char *row = lines[chord.line];
    const int quarter = (chord.last - chord.first) / 4, step = 1 + quarter / 16;
    int sum = 0, samples = 0;
    for (int x = chord.first + quarter; x <= chord.last - quarter; x += step, ++samples) {
      sum += row[x];
    }
    light.push_back(static_cast<double>(sum) / samples);
    length.push_back(chord.last - chord.first + 1);
    for (const int x : {chord.first - reach, chord.last + reach}) {
      outside = x >= 0 && x < lines.cols ? std::min<double>(outside, row[x]) : outside;
    }
  }
  for (double &grey : light) {
    grey = std::max(0.0, grey - outside);
  }
  static const double noise = 2, ragged = 3; // grey levels, samples
  return std::max(deepestDip(light, noise), deepestDip(length, ragged));
}

END_VISP_NAMESPACE
