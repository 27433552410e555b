/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLampGroup.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

BEGIN_VISP_NAMESPACE

namespace
{

using Group = vpLampGroup;

//! The stripes' chords: on each line from the first to the last lit sample.
Group groupOf(const vpLevelStripes &level, vpLevelStripes::Set set, const cv::Mat_<unsigned char> &lines,
              double dark)
{
  Group group;
  vpLedRoi &roi = group.roi;
  roi.level = level.grey;
  for (int s : set.stripes) {
    roi.box |= level.stripes[s].box;
  }
  std::vector<vpLedChord> chords(roi.box.height, vpLedChord{-1, 0, 0});
  for (int s : set.stripes) {
    for (int r : level.stripes[s].runs) {
      const vpLevelStripes::Run &run = level.runs[r];
      vpLedChord &chord = chords[run.line - roi.box.y];
      if (chord.line < 0) {
        chord = {run.line, run.first, run.last};
      } else {
        chord.first = std::min(chord.first, run.first);
        chord.last = std::max(chord.last, run.last);
      }
    }
  }
  std::copy_if(chords.begin(), chords.end(), std::back_inserter(roi.chords),
               [](const vpLedChord &chord) { return chord.line >= 0; });
  roi.cutAcross = roi.box.x <= 0 || roi.box.br().x >= lines.cols;
  roi.cutAlong = roi.box.y <= 0 || roi.box.br().y >= lines.rows;
  vpChordShape::Score score = vpChordShape::score(roi, lines, dark);
  roi.lampness = score.lampness;
  group.shortfall = std::move(score.shortfall);
  group.edge = score.edge;
  group.set = std::move(set);
  return group;
}

//! Weighted by size.
double meanLampness(const Group &a, const Group &b)
{
  return (a.size() * a.roi.lampness + b.size() * b.roi.lampness) / (a.size() + b.size());
}

//! Links between stripes of which one falls far short of the hull, worst first.
std::vector<size_t> waists(const vpLevelStripes &level, const Group &group)
{
  static const float notable = 1.5; // tolerances
  static const size_t most = 6;
  std::vector<float> shortfall(group.roi.box.height, 0); // of each line
  for (size_t i = 0; i < group.roi.chords.size(); ++i) {
    shortfall[group.roi.chords[i].line - group.roi.box.y] = group.shortfall[i];
  }
  auto worstOf = [&](const vpLevelStripes::Stripe &stripe) {
    const auto first = shortfall.begin() + (stripe.box.y - group.roi.box.y);
    return *std::max_element(first, first + stripe.box.height);
  };
  std::vector<std::pair<float, size_t>> worst;
  for (size_t k = 0; k < group.set.links.size(); ++k) {
    const float upper = worstOf(level.stripes[group.set.links[k].first]);
    const float lower = worstOf(level.stripes[group.set.links[k].second]);
    if (std::max(upper, lower) > notable) {
      worst.emplace_back(std::max(upper, lower) + 0.01f * std::min(upper, lower), k);
    }
  }
  std::sort(worst.begin(), worst.end(), [](const auto &a, const auto &b) { return a.first > b.first; });
  std::vector<size_t> links;
  for (size_t i = 0; i < std::min(most, worst.size()); ++i) {
    links.push_back(worst[i].second);
  }
  return links;
}

/*!
  Lamps one behind the other along the readout may lie closer than the longest dark gap of one lamp. One lamp
  is convex; where the whole has a waist between two stripes, tries to cut it there, and keeps the cut that
  makes the best lamps of its parts, weighted by their size. \e workLeft bounds the work on clutter.
*/
void splitAtWaists(const vpLevelStripes &level, Group whole, const cv::Mat_<unsigned char> &lines,
                   double dark, long &workLeft, std::vector<Group> &out)
{
  static const double gain = 0.15;
  double best = whole.roi.lampness + gain;
  std::pair<Group, Group> parts;
  bool cut = false;
  const bool good = best >= vpChordShape::mostLampness(2 * whole.roi.box.height); // no cut will be better
  for (size_t k : good ? std::vector<size_t>() : waists(level, whole)) {
    workLeft -= static_cast<long>(whole.roi.chords.size() + whole.set.stripes.size());
    if (workLeft < 0) {
      break;
    }
    auto [upperSet, lowerSet] = whole.set.cutAt(k);
    Group upper = groupOf(level, std::move(upperSet), lines, dark);
    Group lower = groupOf(level, std::move(lowerSet), lines, dark);
    const double mean = meanLampness(upper, lower);
    if (mean > best) {
      best = mean;
      parts = {std::move(upper), std::move(lower)};
      cut = true;
    }
  }
  if (!cut) {
    out.push_back(std::move(whole));
    return;
  }
  splitAtWaists(level, std::move(parts.first), lines, dark, workLeft, out);
  splitAtWaists(level, std::move(parts.second), lines, dark, workLeft, out);
}

} // namespace

std::vector<Group> vpLampGroup::lampsOf(const vpLevelStripes &level, vpLevelStripes::Set set,
                                        const cv::Mat_<unsigned char> &lines, double dark, long &workLeft)
{
  std::vector<Group> parts;
  splitAtWaists(level, groupOf(level, std::move(set), lines, dark), lines, dark, workLeft, parts);
  return parts;
}

END_VISP_NAMESPACE
