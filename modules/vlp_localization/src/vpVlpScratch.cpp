/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpVlpScratch.h"

#include <algorithm>
#include <cmath>

BEGIN_VISP_NAMESPACE

const vpVlpFilter &vpVlpLocalizer::Scratch::predicted(const vpVlpFilter &filter, double time)
{
  there = filter;
  there.manoeuvreShare = 1;
  there.advance(time);
  return there;
}

const vpLampFrame &vpVlpLocalizer::Scratch::frameOf(const vpVlpRig &rig, const vpLampMap &map,
                                                    const std::vector<vpLampObservation> &observations,
                                                    const std::vector<size_t> &usable, double time,
                                                    bool compensateShutter)
{
  frame.rig = &rig;
  frame.lineTime = lineTime;
  frame.timestamp = time;
  frame.logUniform = -std::log(rig.width / rig.camera.get_px() * rig.height / rig.camera.get_py());
  frame.lamps.clear();
  for (size_t i : usable) {
    const vpLampObservation &seen = observations[i];
    if (const vpLamp *known = lamp(map, seen)) {
      vpLampSight sight = vpLampSight::from(*known, seen, rig.camera);
      const double logPeak = logNormal(Eigen::Vector2d::Zero(), sight.covariance);
      frame.lamps.push_back(
          {i, known, &seen, time + (compensateShutter ? seen.time : 0), std::move(sight), logPeak});
    }
  }
  std::sort(frame.lamps.begin(), frame.lamps.end(),
            [](const vpFrameLamp &a, const vpFrameLamp &b) { return a.time < b.time; });
  return frame;
}

END_VISP_NAMESPACE
