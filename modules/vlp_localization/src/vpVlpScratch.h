/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpVlpScratch_h
#define vpVlpScratch_h

#include <string>
#include <vector>

#include <visp3/vlp_localization/vpVlpLocalizer.h>

#include "vpLampTrust.h"

BEGIN_VISP_NAMESPACE

const double mostStrain = 8; // standard deviations, of vpVlpLocalizer::strain()

/*!
  What vpVlpLocalizer works on within a frame, kept so that the next one takes no memory: each is assigned to
  before it is read, and none means anything from frame to frame.
*/
struct vpVlpLocalizer::Scratch {
  explicit Scratch(const vpVlpRig &rig) : there(rig), before(rig), alone(rig) {}

  vpVlpFilter there;  // filterAt()
  vpVlpFilter before; // correctRestless(): what each attempt begins with,
  vpLampTrust trusted;
  std::vector<vpLampObservation> seen;
  bool displaced = false; // correct(): a lamp counted for less, as it is not where the map has it
  vpVlpFilter alone;      // strain()
  std::vector<vpLampObservation> all, apart; // follow()
  std::vector<size_t> usable;                // process()
  std::vector<size_t> same;                  // unchanged()
  std::vector<size_t> ordered;               // inTime()
  std::vector<const vpLamp *> lamps;         // lampsOf()
  std::vector<vpRect> windows;               // expectedWindows()
};

END_VISP_NAMESPACE

#endif
