/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_detection/vpLedRoiDetector.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "vpBackground.h"
#include "vpBinnedSearch.h"
#include "vpCeiling.h"
#include "vpChordShape.h"
#include "vpDips.h"
#include "vpLampGroup.h"
#include "vpLevelStripes.h"
#include "vpOwnStripes.h"
#include <visp3/vlp_core/vpBrighter.h>

BEGIN_VISP_NAMESPACE

namespace
{

using Group = vpLampGroup;

//! Whether light falls at the ends of the chords by more than noise makes it seem: the fewer the ends, the
//! more is asked of them. A fringe of noise on slowly changing light has no such fall.
bool significant(const Group &group, double noise)
{
  static const double least = 1.2;  // standard deviations of the noise, whatever the number of ends
  static const double single = 4.0; // more of them, for a single end
  if (5 * group.edge.ends <= static_cast<int>(group.roi.chords.size())) {
    return true; // from border to border: no ends to judge by
  }
  return group.edge.step >= (least + single / std::sqrt(group.edge.ends)) * std::max(group.edge.noise, noise);
}

const double margin = 0.08; // of lampness, by which children have to be better: between equals the larger one

const double likeALamp = 0.5; // of lampness: parts of the ceiling have less

//! Whether no children that higher levels may have will be chosen in its place: these have no more ends, and
//! the number of ends bounds what any lampness can be.
bool settled(const Group &group, double noise)
{
  return group.roi.lampness + margin >= vpChordShape::mostLampness(2 * group.roi.box.height) &&
         significant(group, noise);
}

//! Of the most lines that follow each other.
size_t longestStretch(const vpLedRoi &roi)
{
  size_t longest = 0, begun = 0;
  for (size_t i = 0; i < roi.chords.size(); ++i) {
    if (i > 0 && roi.chords[i].line != roi.chords[i - 1].line + 1) {
      begun = i;
    }
    longest = std::max(longest, i - begun + 1);
  }
  return longest;
}

/*!
  Whether a region that is mostly one stripe, and so may be a window or a part of the ceiling of any shape,
  holds far brighter light than its own.
*/
bool mayHoldLamps(const Group &group, const cv::Mat_<unsigned char> &lines, double dark)
{
  static const double farBrighter = 1.5;
  static const int smallest = 24; // px of a lamp's stripes; fewer are specks
  const vpLedRoi &roi = group.roi;
  const double grey = dark + farBrighter * group.edge.light;
  if (grey >= 255 || 2 * longestStretch(roi) <= roi.chords.size()) {
    return false;
  }
  int pixels = 0;
  for (const vpLedChord &chord : roi.chords) {
    const unsigned char *row = lines[chord.line] + chord.first;
    const int samples = chord.last - chord.first + 1;
    if (vpBrighter::brightest(row, samples) > grey) {
      pixels += vpBrighter::count(row, samples, static_cast<unsigned char>(grey));
      if (pixels >= smallest) {
        return true;
      }
    }
  }
  return false;
}

//! Where the next stripe of a region may be, before its first or after its last.
cv::Rect withNextStripes(const vpLedRoi &roi)
{
  static const int more = 1; // lines, half lit at either end of a gap
  const int reach = vpChordShape::longestGap(roi) + more + 1;
  return {roi.box.x, roi.box.y - reach, roi.box.width, roi.box.height + 2 * reach};
}

/*!
  Says of a level's stripes in which of them nothing is looked for at higher levels: even ones, and those of
  lamps for certain. One beside a region that is no lamp, as the ceiling, may lack stripes that run together
  with that. \param begun The level's first node of the tree.
*/
void settle(vpLevelStripes &level, const std::vector<Group> &tree, int begun,
            const cv::Mat_<unsigned char> &lines, const vpBackground &dark)
{
  std::vector<char> good(tree.size() - begun);
  for (size_t i = 0; i < good.size(); ++i) {
    const Group &group = tree[begun + i];
    good[i] = group.roi.even || (settled(group, dark.noise) && !mayHoldLamps(group, lines, dark.level));
  }
  for (size_t i = 0; i < good.size(); ++i) {
    const Group &group = tree[begun + i];
    const cv::Rect around = good[i] != 0 ? withNextStripes(group.roi) : cv::Rect();
    const bool last =
        group.roi.even ||
        (good[i] != 0 &&
         std::none_of(level.stripes.begin(), level.stripes.end(), [&](const vpLevelStripes::Stripe &other) {
           return good[other.group - begun] == 0 && (around & other.box).area() > 0;
         }));
    for (int s : group.set.stripes) {
      level.stripes[s].settled = last;
    }
  }
}

bool isWithin(const cv::Rect &box, const std::vector<cv::Rect> &others)
{
  return std::any_of(others.begin(), others.end(),
                     [&box](const cv::Rect &other) { return (box & other) == box; });
}

cv::Rect boxOf(const vpLevelStripes &level, const vpLevelStripes::Set &set)
{
  cv::Rect box;
  for (int s : set.stripes) {
    box |= level.stripes[s].box;
  }
  return box;
}

/*!
  Takes out what is but a brighter part of \e around, unlike a lamp and without stripes of its own. \return
  Whether a lamp is left that hangs before it.
*/
bool onlyLampsBefore(const Group &around, const std::vector<Group> &tree,
                     const cv::Mat_<unsigned char> &lines, const vpBackground &dark, std::vector<int> &above)
{
  static const double farLarger = 2;
  std::vector<int> lamps;
  bool any = false;
  for (int node : above) {
    const Group &part = tree[node];
    const bool like = part.roi.lampness > likeALamp,
               own = around.size() > farLarger * part.size() &&
                     vpOwnStripes(part.roi, around.roi, lines, dark.level);
    any = any || (like && own);
    if (like || own) {
      lamps.push_back(node);
    }
  }
  if (any) {
    above = std::move(lamps);
  }
  return any;
}

/*!
  The best regions at or above \e node: itself, or those of its children where these, weighted by their size,
  make better lamps. So a lamp beats its own fragments, and two lamps beat the blot that joins them. A ceiling
  that does not blink with the lamps before it never beats these, however many parts of it weigh them down.
  Regions that do not stand out of the noise count for nothing, and none is chosen. Returns the lampness of
  the choice.
*/
double bestBranch(const std::vector<Group> &tree, int node, const cv::Mat_<unsigned char> &lines,
                  const vpBackground &dark, std::vector<int> &chosen)
{
  const Group &group = tree[node];
  std::vector<int> above;
  double sum = 0;
  double weight = 0;
  for (int child : group.children) {
    const size_t before = above.size();
    const double best = bestBranch(tree, child, lines, dark, above);
    if (above.size() > before) {
      sum += tree[child].size() * best;
      weight += tree[child].size();
    }
  }
  const bool stands = significant(group, dark.noise);
  // A lamp that reaches beyond it shows what this one has lost to the ceiling.
  const bool larger = std::any_of(above.begin(), above.end(), [&](int lamp) {
    const vpLedRoi &roi = tree[lamp].roi;
    return roi.lampness > likeALamp && (roi.box | group.roi.box) != group.roi.box;
  });
  bool better = weight > 0 && (!stands || sum / weight > group.roi.lampness + (larger ? -margin : margin));
  if (weight > 0 && !better && onlyLampsBefore(group, tree, lines, dark, above)) {
    better = true;
    sum = weight = 0;
    for (int lamp : above) {
      sum += tree[lamp].size() * tree[lamp].roi.lampness;
      weight += tree[lamp].size();
    }
  }
  if (better) {
    chosen.insert(chosen.end(), above.begin(), above.end());
    return sum / weight;
  }
  if (stands) {
    chosen.push_back(node);
  }
  return stands ? group.roi.lampness : 0;
}

//! Whether a region lies between the chords of a larger, hardly worse one: stripes of it that another level
//! linked.
bool partOf(const vpLedRoi &small, const vpLedRoi &large)
{
  if (large.box.area() <= small.box.area() || large.lampness + 0.1 < small.lampness ||
      (large.box & small.box).area() == 0) {
    return false;
  }
  std::vector<cv::Point> ends;
  for (const vpLedChord &chord : large.chords) {
    ends.emplace_back(chord.first, chord.line);
    ends.emplace_back(chord.last, chord.line);
  }
  std::vector<cv::Point> hull;
  cv::convexHull(ends, hull);
  size_t inside = 0;
  for (const vpLedChord &chord : small.chords) {
    const cv::Point2f middle(0.5f * (chord.first + chord.last), static_cast<float>(chord.line));
    inside += cv::pointPolygonTest(hull, middle, false) >= 0;
  }
  return 2 * inside > small.chords.size();
}

//! The regions that are lamps of their own.
std::vector<vpLedRoi> sifted(const std::vector<Group> &groups)
{
  std::vector<vpLedRoi> rois;
  for (const Group &small : groups) {
    const bool part = std::any_of(groups.begin(), groups.end(),
                                  [&](const Group &large) { return partOf(small.roi, large.roi); });
    if (!part) {
      rois.push_back(small.roi);
    }
  }
  return rois;
}

} // namespace

vpLinePicture::vpLinePicture(const vpImage<unsigned char> &I, bool alongColumns) : transposed(alongColumns)
{
  const cv::Mat_<unsigned char> view(static_cast<int>(I.getHeight()), static_cast<int>(I.getWidth()),
                                     I.bitmap);
  if (transposed) {
    cv::transpose(view, grey);
  } else {
    grey = view;
  }
}

std::vector<vpLedRoi> vpLedRoiDetector::detect(const cv::Mat_<unsigned char> &lines) const
{
  if (lines.empty()) {
    return {};
  }
  const std::vector<vpPictureBlock> blocks = vpPictureBlock::of(lines);
  const vpBackground dark = vpBackground::of(blocks);
  const bool uneven = dark.median - dark.level > 0.5 * lowest(dark);
  const std::optional<vpCeiling> ceiling = uneven ? vpCeiling::of(blocks, dark.noise) : std::nullopt;
  if (!ceiling) {
    return detect(lines, dark, {});
  }
  const cv::Mat_<unsigned char> even = ceiling->takenOff(lines);
  std::vector<vpLedRoi> rois = detect(even, vpBackground::of(vpPictureBlock::of(even)), {});
  for (vpLedRoi &roi : rois) {
    roi.level += ceiling->above(0.5 * cv::Point2d(roi.box.tl() + roi.box.br()), lines.size());
  }
  return rois;
}

double vpLedRoiDetector::lowest(const vpBackground &dark) const
{
  return std::max(noiseFactor * dark.noise, minContrast);
}

//! All but what lies inside \e known boxes.
std::vector<vpLedRoi> vpLedRoiDetector::detect(const cv::Mat_<unsigned char> &lines, const vpBackground &dark,
                                               const std::vector<cv::Rect> &known) const
{
  std::vector<vpLedRoi> rois = lampsOf(lines, dark, known);
  for (const int width : vpBinnedSearch::widths(dark)) {
    rois = vpBinnedSearch::merged(std::move(rois), lampsOf(vpBinnedSearch::binned(lines, width),
                                                           vpBinnedSearch::binned(dark, width), known));
  }
  rois.erase(std::remove_if(rois.begin(), rois.end(),
                            [&known](const vpLedRoi &roi) { return isWithin(roi.box, known); }),
             rois.end());
  return rois;
}

//! The regions at the samples' own resolution, those inside \e known boxes not taken apart.
std::vector<vpLedRoi> vpLedRoiDetector::lampsOf(const cv::Mat_<unsigned char> &lines,
                                                const vpBackground &dark,
                                                const std::vector<cv::Rect> &known) const
{
  static const double peakFactor = 2.5, white = 255;
  std::vector<Group> tree;
  vpLevelStripes below;
  long workLeft = 60000; // chords and stripes looked at for splitting
  const double lowestContrast = lowest(dark);
  for (double contrast = lowestContrast; dark.level + contrast < white; contrast *= levelRatio) {
    const bool first = contrast <= lowestContrast;
    if (!first && below.stripes.empty()) {
      break; // nothing is brighter
    }
    const double grey = dark.level + contrast;
    const auto begun = static_cast<int>(tree.size()); // the level's first node
    vpLevelStripes level(lines, grey, grey + peakFactor * dark.noiseAt(grey), first ? nullptr : &below);
    for (vpLevelStripes::Set &set : level.sets(maxDarkGap, longestPeriod)) {
      const cv::Rect box = boxOf(level, set);
      const bool tall = box.height > longestPeriod,
                 even = isWithin(box, known) ||
                        (std::isfinite(longestPeriod) && (tall || set.stripes.size() == 1) &&
                         !vpMayBlink(lines, box, dark.level, dark.noiseAt(grey), longestPeriod));
      long none = 0; // what is even is not taken apart
      for (Group &group : Group::lampsOf(level, std::move(set), lines, dark.level, even ? none : workLeft)) {
        const int node = static_cast<int>(tree.size());
        group.roi.even = even;
        group.roi.steady = even && tall;
        const int largest =
            *std::max_element(group.set.stripes.begin(), group.set.stripes.end(), [&](int a, int b) {
              return level.stripes[a].box.area() < level.stripes[b].box.area();
            });
        for (int s : group.set.stripes) {
          level.stripes[s].group = node;
        }
        if (!first) {
          group.parent = below.stripes[level.stripes[largest].parent].group;
          tree[group.parent].children.push_back(node);
        }
        tree.push_back(std::move(group));
      }
    }
    settle(level, tree, begun, lines, dark);
    below = std::move(level);
  }

  std::vector<int> chosen;
  for (size_t node = 0; node < tree.size(); ++node) {
    if (tree[node].parent < 0) {
      bestBranch(tree, static_cast<int>(node), lines, dark, chosen);
    }
  }
  std::vector<Group> large;
  for (int node : chosen) {
    const cv::Rect &box = tree[node].roi.box;
    if (box.width >= minWidth && box.height >= minHeight) {
      large.push_back(std::move(tree[node]));
    }
  }
  std::vector<vpLedRoi> rois = sifted(large);
  for (vpLedRoi &roi : rois) {
    vpChordShape::markCuts(roi, lines.size());
  }
  return rois;
}

END_VISP_NAMESPACE
