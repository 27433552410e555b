/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLevelStripes_h
#define vpLevelStripes_h

#include <cstddef>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! A picture above one grey level: its stripes, and which of them may be one lamp.
struct vpLevelStripes {
  struct Run {
    int line;
    int first;
    int last;
    int stripe; // index of the stripe that it is in
  };

  //! A connected region of pixels.
  struct Stripe {
    cv::Rect box;
    int parent = -1;      // stripe of the level below that holds it
    int group = -1;       // node of the detector's tree
    bool settled = false; // nothing is looked for in it at higher levels
    std::vector<int> runs;

    int lastLine() const { return box.y + box.height - 1; }
  };

  //! Stripes that may be one lamp, and the tree of links between those that face each other.
  struct Set {
    std::vector<int> stripes;
    std::vector<std::pair<int, int>> links;

    //! The two sets that remain without a link: that of its first stripe, and that of its second.
    std::pair<Set, Set> cutAt(size_t link) const;
  };

  double grey = 0;
  cv::Size picture;
  std::vector<Run> runs; // in line order
  std::vector<Stripe> stripes;

  vpLevelStripes() = default;
  //! Stripes that have a pixel of at least \e leastPeak, looked for inside those of the level \e below that
  //! are not settled; everywhere, where that is null.
  vpLevelStripes(const cv::Mat_<unsigned char> &lines, double grey, double leastPeak,
                 const vpLevelStripes *below);

  //! Links stripes that face each other across dark gaps of no more than \e maxDarkGap times their width, nor
  //! of \e mostLines.
  std::vector<Set> sets(double maxDarkGap, double mostLines) const;
};

END_VISP_NAMESPACE

#endif
