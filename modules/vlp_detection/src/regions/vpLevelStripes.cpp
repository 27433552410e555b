/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLevelStripes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <utility>

#include <visp3/vlp_core/vpBrighter.h>

BEGIN_VISP_NAMESPACE

namespace
{

using Run = vpLevelStripes::Run;
using Stripe = vpLevelStripes::Stripe;

const int minStripeWidth = 3; // samples; narrower ones are specks

//! Appends the runs of line \e y, from sample \e first to \e last, that are brighter than \e grey.
void scan(const unsigned char *row, int y, int first, int last, unsigned char grey, int parent,
          std::vector<Run> &runs)
{
  int start = -1; // of the run at hand
  for (int x = first; x <= last; x += vpBrighter::block) {
    if (start < 0) { // nearly always nothing
      while (x + vpBrighter::wide - 1 <= last && !vpBrighter::anyWide(row + x, grey)) {
        x += vpBrighter::wide;
      }
      while (x + vpBrighter::block - 1 <= last && !vpBrighter::any(row + x, grey)) {
        x += vpBrighter::block;
      }
      if (x > last) {
        break;
      }
    }
    const int samples = std::min(vpBrighter::block, last - x + 1);
    const std::uint64_t mask = vpBrighter::mask(row + x, samples, grey);
    for (int i = 0; i < samples;) {
      const std::uint64_t left = (start < 0 ? mask : ~mask) >> i;
      if (left == 0) {
        break; // no change in the rest of the block
      }
      i += __builtin_ctzll(left);
      if (i >= samples) {
        break;
      }
      if (start < 0) {
        start = x + i;
      } else {
        runs.push_back({y, start, x + i - 1, parent});
        start = -1;
      }
    }
  }
  if (start >= 0) {
    runs.push_back({y, start, last, parent});
  }
}

std::vector<Run> runsAbove(const cv::Mat_<unsigned char> &lines, double level, const vpLevelStripes *below)
{
  static const size_t pixels = 64; // of a picture, for a run each
  std::vector<Run> runs;
  runs.reserve(below != nullptr ? below->runs.size() : lines.total() / pixels);
  const auto grey =
      static_cast<unsigned char>(std::clamp(std::floor(level), 0.0, 255.0)); // above both or neither
  if (below != nullptr) {
    for (const Run &run : below->runs) {
      if (!below->stripes[run.stripe].settled) {
        scan(lines[run.line], run.line, run.first, run.last, grey, run.stripe, runs);
      }
    }
  } else {
    for (int y = 0; y < lines.rows; ++y) {
      scan(lines[y], y, 0, lines.cols - 1, grey, -1, runs);
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

//! For each run a run of the same stripe, common to all of that stripe: runs of neighbouring lines that touch
//! (8-neighbourhood) are joined.
std::vector<int> joinTouching(const std::vector<Run> &runs)
{
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
  for (size_t i = 0; i < runs.size(); ++i) {
    root[i] = rootOf(root, static_cast<int>(i));
  }
  return root;
}

//! What there is of a stripe, run by run in line order.
struct Extent {
  int left = std::numeric_limits<int>::max(), right = -1, top = -1, bottom = -1;
  int peak = 0;    // grey level
  int number = -1; // of the stripe

  void add(const Run &run)
  {
    left = std::min(left, run.first);
    right = std::max(right, run.last);
    top = top < 0 ? run.line : top;
    bottom = run.line;
  }
  int width() const { return right - left + 1; }
  cv::Rect box() const { return {left, top, width(), bottom - top + 1}; }
};

//! Whether the lower stripe may go on where the upper one ended, behind a dark gap.
bool facing(const Stripe &upper, const Stripe &lower, double maxDarkGap, double mostLines, int samples)
{
  const int gap = lower.box.y - upper.lastLine() - 1;
  const int overlap = std::min(upper.box.br().x, lower.box.br().x) - std::max(upper.box.x, lower.box.x);
  if (gap < 0 || gap > mostLines || overlap < 0.6 * std::min(upper.box.width, lower.box.width)) {
    return false;
  }
  // A stripe as wide as the picture belongs to a lamp wider than it, of a height that nobody knows.
  const bool wide = upper.box.width >= samples - 2 && lower.box.width >= samples - 2;
  return wide || gap <= maxDarkGap * std::max(upper.box.width, lower.box.width);
}

//! Whether two stripes look like pieces of one, broken by noise: side by side, little between them.
bool pieces(const Stripe &a, const Stripe &b)
{
  const int between = std::max(a.box.x, b.box.x) - std::min(a.box.br().x, b.box.br().x);
  const int end = std::abs(a.lastLine() - b.lastLine());
  return end <= 1 && between <= std::max(2, std::min(a.box.width, b.box.width) / 2);
}

} // namespace

vpLevelStripes::vpLevelStripes(const cv::Mat_<unsigned char> &lines, double level, double leastPeak,
                               const vpLevelStripes *below)
    : grey(level), picture(lines.size())
{
  const std::vector<Run> found = runsAbove(lines, grey, below);
  const std::vector<int> root = joinTouching(found);
  std::vector<Extent> extents(found.size()); // of the roots
  for (size_t i = 0; i < found.size(); ++i) {
    extents[root[i]].add(found[i]);
  }
  for (size_t i = 0; i < found.size(); ++i) {
    Extent &whole = extents[root[i]];
    if (whole.peak < leastPeak && whole.width() >= minStripeWidth) {
      whole.peak = std::max<int>(whole.peak, vpBrighter::brightest(lines[found[i].line] + found[i].first,
                                                                   found[i].last - found[i].first + 1));
    }
  }
  for (size_t i = 0; i < found.size(); ++i) {
    Extent &whole = extents[root[i]];
    if (whole.width() < minStripeWidth || whole.peak < leastPeak) {
      continue;
    }
    if (whole.number < 0) {
      whole.number = static_cast<int>(stripes.size());
      stripes.emplace_back();
      stripes.back().box = whole.box();
      stripes.back().parent = found[i].stripe;
    }
    stripes[whole.number].runs.push_back(static_cast<int>(runs.size()));
    runs.push_back({found[i].line, found[i].first, found[i].last, whole.number});
  }
}

std::pair<vpLevelStripes::Set, vpLevelStripes::Set> vpLevelStripes::Set::cutAt(size_t link) const
{
  std::vector<int> sorted = stripes;
  std::sort(sorted.begin(), sorted.end());
  auto indexOf = [&](int stripe) {
    return static_cast<int>(std::lower_bound(sorted.begin(), sorted.end(), stripe) - sorted.begin());
  };
  std::vector<int> root(sorted.size());
  std::iota(root.begin(), root.end(), 0);
  for (size_t i = 0; i < links.size(); ++i) {
    if (i != link) {
      root[rootOf(root, indexOf(links[i].first))] = rootOf(root, indexOf(links[i].second));
    }
  }
  const int upper = rootOf(root, indexOf(links[link].first));
  std::pair<Set, Set> parts;
  auto partOf = [&](int stripe) -> Set & {
    return rootOf(root, indexOf(stripe)) == upper ? parts.first : parts.second;
  };
  for (int stripe : stripes) {
    partOf(stripe).stripes.push_back(stripe);
  }
  for (size_t i = 0; i < links.size(); ++i) {
    if (i != link) {
      partOf(links[i].first).links.push_back(links[i]);
    }
  }
  return parts;
}

std::vector<vpLevelStripes::Set> vpLevelStripes::sets(double maxDarkGap, double mostLines) const
{
  std::vector<int> order(stripes.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return stripes[a].box.y < stripes[b].box.y; });

  std::vector<int> root(stripes.size());
  std::iota(root.begin(), root.end(), 0);
  std::vector<std::pair<int, int>> links;
  std::vector<int> above(picture.width, -1); // on each sample, the stripe begun last
  for (int lower : order) {
    const Stripe &stripe = stripes[lower];
    std::vector<int> upper;
    for (int x = stripe.box.x; x < stripe.box.br().x; ++x) {
      if (above[x] >= 0 && (upper.empty() || upper.back() != above[x]) &&
          facing(stripes[above[x]], stripe, maxDarkGap, mostLines, picture.width)) {
        upper.push_back(above[x]);
      }
    }
    const auto nearest = std::max_element(upper.begin(), upper.end(), [&](int a, int b) {
      return stripes[a].lastLine() < stripes[b].lastLine();
    });
    for (int u : upper) {
      if ((u == *nearest || pieces(stripes[u], stripes[*nearest])) &&
          rootOf(root, lower) != rootOf(root, u)) {
        root[rootOf(root, lower)] = rootOf(root, u);
        links.emplace_back(u, lower);
      }
    }
    for (int r : stripe.runs) {
      std::fill(above.begin() + runs[r].first, above.begin() + runs[r].last + 1, lower);
    }
  }

  std::vector<Set> sets;
  std::vector<int> label(stripes.size(), -1); // of a root's set
  for (int s : order) {
    const int r = rootOf(root, s);
    if (label[r] < 0) {
      label[r] = static_cast<int>(sets.size());
      sets.emplace_back();
    }
    sets[label[r]].stripes.push_back(s);
  }
  for (const std::pair<int, int> &link : links) {
    sets[label[rootOf(root, link.first)]].links.push_back(link);
  }
  return sets;
}

END_VISP_NAMESPACE
