/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpVlpScratch_h
#define vpVlpScratch_h

#include <string>
#include <unordered_map>
#include <vector>

#include <visp3/vlp_localization/vpVlpLocalizer.h>

#include "vpLampFrame.h"

BEGIN_VISP_NAMESPACE

//! Whether roll and pitch are estimated, too.
inline bool attitudeIsFree(const vpVlpLocalizer &localizer)
{
  return localizer.manyLamps.attitude == vpManyLampSolver::Attitude::free &&
         localizer.solver == vpVlpLocalizer::Solver::all;
}

/*!
  What vpVlpLocalizer works on within a frame and never changes, or kept so that the next one takes no memory:
  each is assigned to before it is read, and none means anything from frame to frame.
*/
struct vpVlpLocalizer::Scratch {
  Scratch(const vpVlpRig &rig, const vpLampMap &map)
      : lineTime(rig.lineTiming().meanLineTime()),
        halfReadout(rig.lineTiming().middleAt(0.5 * (rig.lineTiming().lines() - 1))), there(rig)
  {
    for (size_t i = 0; i < map.lamps.size(); ++i) {
      lampOf.emplace(map.lamps[i].id, i);
    }
  }

  //! The map's lamp of an observation, by its id; nullptr: none.
  const vpLamp *lamp(const vpLampMap &map, const vpLampObservation &observation) const
  {
    const auto found = lampOf.find(observation.id);
    return found == lampOf.end() ? nullptr : &map.lamps[found->second];
  }

  //! The filter as predicted to a time: by a robot that may start and stop. Until the next call.
  const vpVlpFilter &predicted(const vpVlpFilter &filter, double time);

  //! The lamps that a filter can use, in the order in which their lines were read, or all as if seen at the
  //! time stamp (s). Until the next call.
  const vpLampFrame &frameOf(const vpVlpRig &rig, const vpLampMap &map,
                             const std::vector<vpLampObservation> &observations,
                             const std::vector<size_t> &usable, double time, bool compensateShutter);

  double lineTime;                                // s, from line to line
  double halfReadout;                             // s, from a frame's time stamp to its middle line
  std::unordered_map<std::string, size_t> lampOf; // index into the map, by id
  vpVlpFilter there;                              // a filter that goes on to some other time
  vpLampFrame frame;
  std::vector<vpLampObservation> apart; // a frame's, as seen by itself,
  vpVlpFix alone;                       // and its pose
  std::vector<size_t> usable;
  std::vector<vpRect> windows;
};

END_VISP_NAMESPACE

#endif
