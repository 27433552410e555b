/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// From the lamps of a frame to a pose: alone, and carried from frame to frame (MODEL.md).

#include <visp3/vlp_localization/vpVlpLocalizer.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "vpLampConsensus.h"
#include "vpLampGeometry.h"
#include "vpPoseMixture.h"
#include "vpVlpScratch.h"

BEGIN_VISP_NAMESPACE

namespace
{
/*!
  Places the lamps' middles in their outlines anew. The detector did so for a robot that stands level; a
  camera that leans otherwise sees the middle of a disc elsewhere in its ellipse.
*/
void placeMiddles(std::vector<vpLampObservation> &observations, const vpVlpRig &rig,
                  const Eigen::Matrix3d &wRb)
{
  const Eigen::Vector3d vertical = vpMountFrame(rig).bRc.transpose() * wRb.row(2).transpose();
  for (vpLampObservation &lamp : observations) {
    lamp.point = lamp.outline.middle(rig.camera, vertical);
  }
}
} // namespace

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

//! The pose of these lamps alone, of two of them or of all that agree with each other.
vpVlpFix vpVlpLocalizer::solve(std::vector<vpLampObservation> &observations,
                               const std::vector<size_t> &usable) const
{
  std::vector<const vpLamp *> lamps;
  for (const vpLampObservation &seen : observations) {
    lamps.push_back(m_scratch->lamp(m_map, seen));
  }
  std::vector<size_t> which;
  std::copy_if(usable.begin(), usable.end(), std::back_inserter(which),
               [&](size_t i) { return lamps[i] == nullptr || !m_places->lamps().isStranger(*lamps[i]); });
  if (which.size() <= poseLamps) { // none of which bears the others out
    which = usable;
  }
  auto solved = [&] {
    const vpLampConsensus consensus(lamps, m_rig, observations, mapTolerance, outlierLikelihood);
    return consensus.solve(which, [this](const std::vector<vpLampSight> &lamps) {
      return solver == Solver::two ? twoLamps.solveBestPair(lamps, m_rig) : manyLamps.solve(lamps, m_rig);
    });
  };
  vpVlpFix fix = solved();
  if (fix.valid && attitudeIsFree(*this)) {
    placeMiddles(observations, m_rig, vpBasePose::of(fix.wMb).wRb);
    fix = solved();
  }
  vpLampConsensus::explain(fix, usable, observations);
  return fix;
}

/*!
  A place that begins with a frame. \param put The robot was put there, else it has come from the last pose.
  \param wider Times that camera and map are taken for less exact than they say: vpVlpFilter::widenClaims().
*/
vpPoseHypothesis vpVlpLocalizer::placeAt(const vpVlpFix &fix, const vpLampFrame &frame, bool put,
                                         int wider) const
{
  vpVlpFilter start = filter;
  start.freeAttitude = manyLamps.attitude == vpManyLampSolver::Attitude::free;
  for (int step = 0; step < wider; ++step) {
    start.widenClaims();
  }
  vpLampHistory lamps = m_places->lamps();
  lamps.mapTolerance = mapTolerance;
  lamps.seeFrom(frame, fix.wMb);
  for (const vpFrameLamp &lamp : frame.lamps) {
    if (lamp.seen->accepted || lamp.seen->remark == vpLampConsensus::elsewhere) {
      lamps.setStranger(*lamp.lamp, !lamp.seen->accepted);
    }
  }
  start.start(fix.wMb, frame.timestamp);
  if (!put && m_lastPose) {
    const double since = frame.timestamp - m_lastPose->time;
    const vpHomogeneousMatrix way = m_lastPose->fix.wMb.inverse() * fix.wMb;
    if (std::hypot(way[0][3], way[1][3]) < maxSpeed * since &&
        std::abs(std::atan2(way[1][0], way[0][0])) < maxTurnRate * since) {
      start.comeFrom(m_lastPose->fix, since);
    }
  }
  vpPoseHypothesis place(start, hypotheses, lamps);
  place.begin(frame, m_places->empty());
  return place;
}

//! The pose of this frame alone; where frames are followed, the first of them.
void vpVlpLocalizer::begin(vpVlpLocation &location, const std::vector<size_t> &usable)
{
  location.fix = solve(location.observations, usable);
  if (!tracking || !location.fix.valid) {
    return;
  }
  const vpLampFrame &frame =
      m_scratch->frameOf(m_rig, m_map, location.observations, usable, location.timestamp, compensateShutter);
  if (!m_places->lamps().looksAsBefore(frame, location.fix.wMb)) {
    location.fix =
        refusedFix("the lamps are not as large as they were: partly hidden, or one behind the other");
    vpLampConsensus::explain(location.fix, usable, location.observations);
  } else if (!location.fix.ambiguous) {
    const vpPoseHypothesis exact = placeAt(location.fix, frame, false, 0),
                           wider = placeAt(location.fix, frame, false, 1),
                           widest = placeAt(location.fix, frame, false, 3);
    m_places->restart(exact);
    if (location.fix.degreesOfFreedom > 0) {
      m_places->addWider(wider, hypotheses, true);
      m_places->addWider(widest, hypotheses, true);
    }
    const vpVlpFix alone = location.fix;
    m_places->settle(m_scratch->frame, hypotheses, filter, location);
    // One frame hardly tells a robot that moves from lamps that hang a little elsewhere.
    if (!filter.hasOdometry()) {
      const Eigen::Matrix<double, 6, 1> moved =
          vpBasePose::of(alone.wMb).stepTo(vpBasePose::of(location.fix.wMb));
      location.fix.wMb = alone.wMb;
      location.fix.wMc = alone.wMc;
      location.fix.covariance += moved * moved.transpose();
    }
  }
}

//! All places where the robot may be go on to this frame; it may have been put elsewhere, too.
void vpVlpLocalizer::follow(vpVlpLocation &location, const std::vector<size_t> &usable)
{
  std::vector<vpLampObservation> &apart = m_scratch->apart;
  vpVlpFix &alone = m_scratch->alone;
  const auto aloneIsGood = [&] {
    apart = location.observations;
    alone = solve(apart, usable);
    return alone.valid && !alone.ambiguous &&
           m_places->lamps().looksAsBefore(
               m_scratch->frameOf(m_rig, m_map, apart, usable, location.timestamp, compensateShutter),
               alone.wMb);
  };
  if (attitudeIsFree(*this)) {
    placeMiddles(location.observations, m_rig, filter.pose().wMb.rotation());
  }
  m_places->follow(
      m_scratch->frameOf(m_rig, m_map, location.observations, usable, location.timestamp, compensateShutter),
      filter);
  const bool elsewhere = m_places->mayBeElsewhere(m_scratch->frame, hypotheses),
             off = m_places->mayBeOff(m_scratch->frame, hypotheses);
  const bool tells = (elsewhere || off) && aloneIsGood();
  if (!tells) {
    m_places->addAnywhere(m_scratch->frame, hypotheses);
  } else {
    if (elsewhere) {
      m_places->addElsewhere(m_scratch->frame, placeAt(alone, m_scratch->frame, true, 0), hypotheses);
    }
    if (off) {
      m_places->addWider(placeAt(alone, m_scratch->frame, false, 1), hypotheses, false);
    }
  }
  if (m_places->lost()) {
    filter.stop();
    m_places->lose();
    begin(location, usable);
    return;
  }
  m_places->settle(m_scratch->frame, hypotheses, filter, location);
}

END_VISP_NAMESPACE
