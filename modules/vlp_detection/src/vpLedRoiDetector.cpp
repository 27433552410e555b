/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_detection/vpLedRoiDetector.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include "vpChordShape.h"

BEGIN_VISP_NAMESPACE

namespace
{

struct Run {
  int line;
  int first;
  int last;
  int blob; // after labelling: index of its stripe
};

//! A connected region of pixels above one level.
struct Stripe {
  cv::Rect box;
  int parent = -1; // stripe of the level below that holds it
  int group = -1;
  std::vector<int> runs;

  int lastLine() const { return box.y + box.height - 1; }
};

//! Stripes that may be one lamp, at one level; a node of the tree.
struct Group {
  vpLedRoi roi;
  int parent = -1;
  std::vector<int> children;
};

struct Level {
  double dark = 0; // grey value of the background
  double grey = 0;
  std::vector<Run> runs;
  std::vector<Stripe> stripes;
};

struct Background {
  double level;
  double noise;
};

//! Level and noise of the dark part of the picture, from a sparse sample of it.
Background background(const cv::Mat_<unsigned char> &lines)
{
  const int step = std::max(1, static_cast<int>(std::sqrt(lines.total() / 2.0e5)));
  std::array<size_t, 256> histogram{};
  size_t count = 0;
  for (int y = 0; y < lines.rows; y += step) {
    for (int x = 0; x < lines.cols; x += step) {
      ++histogram[lines(y, x)];
      ++count;
    }
  }
  auto quantile = [](const std::array<size_t, 256> &h, size_t total, double share) {
    size_t sum = 0;
    for (size_t grey = 0; grey < h.size(); ++grey) {
      sum += h[grey];
      if (sum > share * total) {
        return static_cast<int>(grey);
      }
    }
    return 255;
  };
  const int low = quantile(histogram, count, 0.02);
  const int median = quantile(histogram, count, 0.5);

  // Differences of neighbours in the darker half: stripes and edges are few among them.
  std::array<size_t, 256> differences{};
  count = 0;
  for (int y = 0; y < lines.rows; y += step) {
    for (int x = 0; x + 1 < lines.cols; x += step) {
      if (lines(y, x) <= median) {
        ++differences[std::abs(lines(y, x + 1) - lines(y, x))];
        ++count;
      }
    }
  }
  // The median of |difference| of two Gaussian pixels is 0.954 sigma; it comes in whole grey levels, so
  // interpolate.
  double noise = 0.3;
  size_t sum = 0;
  for (size_t d = 0; d < differences.size() && count > 0; ++d) {
    if (sum + differences[d] > count / 2) {
      const double within = (0.5 * count - sum) / differences[d];
      noise = std::max(noise, (d - 0.5 + within) / 0.954);
      break;
    }
    sum += differences[d];
  }
  return {low + 2 * noise, noise};
}

//! Runs of pixels above \e grey, looked for inside the runs of the level below (everywhere, where there is
//! none).
std::vector<Run> runsAbove(const cv::Mat_<unsigned char> &lines, double grey, const Level *below)
{
  std::vector<Run> runs;
  auto scan = [&](int y, int first, int last, int parent) {
    const unsigned char *row = lines[y];
    for (int x = first; x <= last; ++x) {
      if (row[x] <= grey) {
        continue;
      }
      const int start = x;
      while (x < last && row[x + 1] > grey) {
        ++x;
      }
      runs.push_back({y, start, x, parent});
    }
  };
  if (below != nullptr) {
    for (const Run &run : below->runs) {
      scan(run.line, run.first, run.last, run.blob);
    }
  } else {
    for (int y = 0; y < lines.rows; ++y) {
      scan(y, 0, lines.cols - 1, -1);
    }
  }
  return runs;
}

int rootOf(std::vector<int> &root, int i)
{
  while (root[i] != i) {
    root[i] = root[root[i]];
    i = root[i];
  }
  return i;
}

//! Joins runs of neighbouring lines that touch (8-neighbourhood) into stripes; narrow specks are dropped.
void joinRuns(Level &level, int minWidth)
{
  std::vector<Run> &runs = level.runs;
  std::vector<int> root(runs.size());
  std::iota(root.begin(), root.end(), 0);
  size_t above = 0;
  for (size_t i = 0; i < runs.size(); ++i) {
    while (above < i && (runs[above].line < runs[i].line - 1 ||
                         (runs[above].line == runs[i].line - 1 && runs[above].last < runs[i].first - 1))) {
      ++above;
    }
    for (size_t j = above; j < i && runs[j].line == runs[i].line - 1 && runs[j].first <= runs[i].last + 1;
         ++j) {
      root[rootOf(root, static_cast<int>(i))] = rootOf(root, static_cast<int>(j));
    }
  }

  std::vector<int> label(runs.size(), -1);
  std::vector<Stripe> stripes;
  for (size_t i = 0; i < runs.size(); ++i) {
    const int r = rootOf(root, static_cast<int>(i));
    if (label[r] < 0) {
      label[r] = static_cast<int>(stripes.size());
      stripes.emplace_back();
      stripes.back().parent = runs[i].blob;
      stripes.back().box = cv::Rect(runs[i].first, runs[i].line, 0, 0);
    }
    Stripe &stripe = stripes[label[r]];
    stripe.box |= cv::Rect(runs[i].first, runs[i].line, runs[i].last - runs[i].first + 1, 1);
    stripe.runs.push_back(static_cast<int>(i));
  }

  std::vector<Run> kept;
  for (Stripe &stripe : stripes) {
    if (stripe.box.width < minWidth) {
      continue;
    }
    for (int &run : stripe.runs) {
      runs[run].blob = static_cast<int>(level.stripes.size());
    }
    level.stripes.push_back(std::move(stripe));
  }
  // Renumber: the next level scans the runs in line order.
  std::vector<int> number(runs.size(), -1);
  for (size_t s = 0; s < level.stripes.size(); ++s) {
    for (int run : level.stripes[s].runs) {
      number[run] = static_cast<int>(s);
    }
  }
  for (Stripe &stripe : level.stripes) {
    stripe.runs.clear();
  }
  for (size_t i = 0; i < runs.size(); ++i) {
    if (number[i] >= 0) {
      level.stripes[number[i]].runs.push_back(static_cast<int>(kept.size()));
      kept.push_back(runs[i]);
    }
  }
  runs = std::move(kept);
}

//! Whether the lower stripe may go on where the upper one ended, behind a dark gap.
bool facing(const Stripe &upper, const Stripe &lower, double maxDarkGap, int samples)
{
  const int gap = lower.box.y - upper.lastLine() - 1;
  const int overlap = std::min(upper.box.br().x, lower.box.br().x) - std::max(upper.box.x, lower.box.x);
  if (gap < 0 || overlap < 0.6 * std::min(upper.box.width, lower.box.width)) {
    return false;
  }
  // A stripe as wide as the picture belongs to a lamp wider than it, of a height that nobody knows.
  const bool wide = upper.box.width >= samples - 2 && lower.box.width >= samples - 2;
  return wide || gap <= maxDarkGap * std::max(upper.box.width, lower.box.width);
}

//! Sets of stripes linked, each to the nearest that it faces below.
std::vector<std::vector<int>> linkStripes(const std::vector<Stripe> &stripes, double maxDarkGap, int samples)
{
  std::vector<int> order(stripes.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return stripes[a].box.y < stripes[b].box.y; });
  int widest = 0;
  for (const Stripe &stripe : stripes) {
    widest = std::max(widest, stripe.box.width);
  }
  const int reach =
      widest >= samples - 2 ? std::numeric_limits<int>::max() / 2 : static_cast<int>(maxDarkGap * widest) + 1;

  std::vector<int> root(stripes.size());
  std::iota(root.begin(), root.end(), 0);
  std::vector<int> open; // stripes above that may still be continued
  for (int lower : order) {
    open.erase(
        std::remove_if(open.begin(), open.end(),
                       [&](int a) { return stripes[lower].box.y - stripes[a].lastLine() - 1 > reach; }),
        open.end());
    int nearest = -1;
    for (int upper : open) {
      if (facing(stripes[upper], stripes[lower], maxDarkGap, samples) &&
          (nearest < 0 || stripes[upper].lastLine() > stripes[nearest].lastLine())) {
        nearest = upper;
      }
    }
    if (nearest >= 0) {
      root[rootOf(root, lower)] = rootOf(root, nearest);
    }
    open.push_back(lower);
  }
  std::vector<std::vector<int>> sets;
  std::vector<int> label(stripes.size(), -1);
  for (int s : order) {
    const int r = rootOf(root, s);
    if (label[r] < 0) {
      label[r] = static_cast<int>(sets.size());
      sets.emplace_back();
    }
    sets[label[r]].push_back(s);
  }
  return sets;
}

//! The chords of a set of stripes: on each line from its first to its last lit sample.
vpLedRoi roiOf(const Level &level, const std::vector<int> &stripes, const cv::Mat_<unsigned char> &lines)
{
  vpLedRoi roi;
  roi.level = level.grey;
  for (int s : stripes) {
    roi.box |= level.stripes[s].box;
  }
  std::vector<vpLedChord> chords(roi.box.height, vpLedChord{-1, 0, 0});
  for (int s : stripes) {
    for (int r : level.stripes[s].runs) {
      const Run &run = level.runs[r];
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
  roi.lampness = vpChordShape::lampness(roi, lines, level.dark);
  return roi;
}

/*!
  Lamps one above the other may lie closer than the longest dark gap of one lamp. Where the whole is no good
  lamp, tries to cut it at each gap, and keeps a cut whose two parts both are better ones.
*/
void splitWhereBetter(const Level &level, const std::vector<int> &stripes,
                      const cv::Mat_<unsigned char> &lines,
                      std::vector<std::pair<std::vector<int>, vpLedRoi>> &out)
{
  static const double goodLamp = 0.6;
  static const double gain = 0.1;
  static const size_t mostStripes = 200; // more are no lamps but noise
  vpLedRoi whole = roiOf(level, stripes, lines);
  if (whole.lampness < goodLamp && stripes.size() > 1 && stripes.size() < mostStripes) {
    double best = whole.lampness + gain;
    size_t cut = 0;
    for (size_t k = 1; k < stripes.size(); ++k) {
      const std::vector<int> upper(stripes.begin(), stripes.begin() + static_cast<long>(k));
      const std::vector<int> lower(stripes.begin() + static_cast<long>(k), stripes.end());
      const double worse = std::min(roiOf(level, upper, lines).lampness, roiOf(level, lower, lines).lampness);
      if (worse > best) {
        best = worse;
        cut = k;
      }
    }
    if (cut > 0) {
      splitWhereBetter(level, {stripes.begin(), stripes.begin() + static_cast<long>(cut)}, lines, out);
      splitWhereBetter(level, {stripes.begin() + static_cast<long>(cut), stripes.end()}, lines, out);
      return;
    }
  }
  out.emplace_back(stripes, std::move(whole));
}

/*!
  The best regions at or above \e node: itself, or those of its children where these, weighted by their size,
  make better lamps. So a lamp beats its own fragments, and two lamps beat the blot that joins them.
*/
double bestBranch(const std::vector<Group> &tree, int node, std::vector<int> &chosen)
{
  const Group &group = tree[node];
  std::vector<int> above;
  double sum = 0;
  double weight = 0;
  for (int child : group.children) {
    const double size = std::max(tree[child].roi.box.width, tree[child].roi.box.height);
    sum += size * bestBranch(tree, child, above);
    weight += size;
  }
  static const double margin = 0.03; // between equals the lower, larger one
  if (weight > 0 && sum / weight > group.roi.lampness + margin) {
    chosen.insert(chosen.end(), above.begin(), above.end());
    return sum / weight;
  }
  chosen.push_back(node);
  return group.roi.lampness;
}

//! Removes small regions beside or inside a much larger and better one: pieces of its halo.
void dropCrumbs(std::vector<vpLedRoi> &rois)
{
  static const double much = 3;
  auto crumb = [&](const vpLedRoi &small) {
    return std::any_of(rois.begin(), rois.end(), [&](const vpLedRoi &large) {
      if (large.box.area() < much * much * small.box.area() || large.lampness < small.lampness) {
        return false;
      }
      const cv::Size margin(large.box.width / 4, large.box.height / 4);
      const cv::Rect around(large.box.tl() - cv::Point(margin), large.box.size() + margin + margin);
      return (around & small.box).area() > 0;
    });
  };
  std::vector<vpLedRoi> kept;
  std::copy_if(rois.begin(), rois.end(), std::back_inserter(kept),
               [&](const vpLedRoi &roi) { return !crumb(roi); });
  rois = std::move(kept);
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
  std::vector<Group> tree;
  if (lines.empty()) {
    return {};
  }
  double brightest = 0;
  cv::minMaxLoc(lines, nullptr, &brightest);
  const Background dark = background(lines);

  Level below;
  const double lowest = std::max(noiseFactor * dark.noise, minContrast);
  for (double contrast = lowest; dark.level + contrast < brightest; contrast *= levelRatio) {
    Level level;
    level.dark = dark.level;
    level.grey = dark.level + contrast;
    level.runs = runsAbove(lines, level.grey, contrast > lowest ? &below : nullptr);
    joinRuns(level, 3);
    for (const std::vector<int> &set : linkStripes(level.stripes, maxDarkGap, lines.cols)) {
      std::vector<std::pair<std::vector<int>, vpLedRoi>> parts;
      splitWhereBetter(level, set, lines, parts);
      for (auto &[stripes, roi] : parts) {
        const int largest = *std::max_element(stripes.begin(), stripes.end(), [&](int a, int b) {
          return level.stripes[a].box.area() < level.stripes[b].box.area();
        });
        const int parent = contrast > lowest ? below.stripes[level.stripes[largest].parent].group : -1;
        for (int s : stripes) {
          level.stripes[s].group = static_cast<int>(tree.size());
        }
        if (parent >= 0) {
          tree[parent].children.push_back(static_cast<int>(tree.size()));
        }
        tree.push_back({std::move(roi), parent, {}});
      }
    }
    below = std::move(level);
  }

  std::vector<int> chosen;
  for (size_t node = 0; node < tree.size(); ++node) {
    if (tree[node].parent < 0) {
      bestBranch(tree, static_cast<int>(node), chosen);
    }
  }
  std::vector<vpLedRoi> rois;
  for (int node : chosen) {
    vpLedRoi &roi = tree[node].roi;
    if (roi.box.width >= minWidth && roi.box.height >= minHeight) {
      rois.push_back(std::move(roi));
    }
  }
  dropCrumbs(rois);
  return rois;
}

END_VISP_NAMESPACE
