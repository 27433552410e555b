/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampTrack_h
#define vpLampTrack_h

#include <memory>
#include <vector>

#include <visp3/vlp_tracking/vpLampTracker.h>

BEGIN_VISP_NAMESPACE

//! A lamp that is followed.
struct vpLampTracker::Track {
  unsigned int number = 0;
  std::unique_ptr<vpTargetTracker> target;
  vpLedIdEvidence evidence;
  vpRect window;            // px, where it is expected in the frame at hand
  vpImagePoint before;      // px, where its target was in the frame before
  double seenLast = 0;      // s
  vpRect told;              // px, where it blinked last
  bool fits = false;        // a lamp of the map, as it was seen last
  unsigned int strange = 0; // frames in a row in which it fitted no lamp of the map
  bool taken = false;       // by an observation of the frame at hand
  vpRect place;             // px, where it was seen last
  bool astray = false;      // its target is another lamp, which looks the same: it is waited for at its place
  std::vector<unsigned char> look; // pixels of the place, line by line
  vpLampObservation known;         // as it was seen last,
  bool sure = false;               // and whether it may be reacquired
  vpLampObservation seen;          // as reacquired,
  bool found = false;              // where it was expected

  //! Whether a region tells too little of its own to be the same lamp, far from where that blinked last or
  //! hardly as that did.
  bool isElsewhere(const vpLampObservation &lamp) const;
  //! \param enough Frames that agree on it.
  void learn(const vpLampObservation &lamp, unsigned int enough, double minConfidence);
  void remember(const vpImage<unsigned char> &I);
  bool shown() const { return !look.empty(); }
  bool showsAgain(const vpImage<unsigned char> &I) const;
};

END_VISP_NAMESPACE

#endif
