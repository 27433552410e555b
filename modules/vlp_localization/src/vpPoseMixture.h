/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPoseMixture_h
#define vpPoseMixture_h

#include <vector>

#include <visp3/vlp_localization/vpVlpLocalizer.h>

#include "vpPoseHypothesis.h"

BEGIN_VISP_NAMESPACE

//! The places where the robot may be, mostly one, and how probable each is (MODEL.md, 4).
class vpPoseMixture
{
public:
  bool empty() const { return m_places.empty(); }
  const vpPoseHypothesis &likeliest() const { return m_places.front(); }
  //! What is known of lamps, wherever the robot is.
  const vpLampHistory &lamps() const { return empty() ? m_lamps : likeliest().history; }

  //! Nothing is known of the robot any more, and of the lamps how large they are.
  void lose();
  //! The robot is at one place for sure.
  void restart(const vpPoseHypothesis &place);
  //! All places go on to a frame. \param odometry Has the samples that came meanwhile.
  void follow(const vpLampFrame &frame, const vpVlpFilter &odometry);
  //! Whether the frame is so unlikely from all of them that a robot that was put elsewhere may explain it
  //! better.
  bool mayBeElsewhere(const vpLampFrame &frame, const vpVlpHypotheses &hypotheses) const;
  //! Whether so much was told of the motion that camera and map may be off instead.
  bool mayBeOff(const vpLampFrame &frame, const vpVlpHypotheses &hypotheses);
  //! Camera and map are less exact than they say: the latest frame under such claims. \param isFirst It is
  //! the first frame of the likeliest place as well.
  void addWider(vpPoseHypothesis place, const vpVlpHypotheses &hypotheses, bool isFirst);
  //! The robot was put there with the latest frame.
  void addElsewhere(const vpLampFrame &frame, vpPoseHypothesis place, const vpVlpHypotheses &hypotheses);
  //! It may have been put where the latest frame's lamps do not tell.
  void addAnywhere(const vpLampFrame &frame, const vpVlpHypotheses &hypotheses);
  //! Whether all are so uncertain that they mean nothing.
  bool lost() const;
  //! Likewise at a time to come (s), had the robot started or stopped since.
  bool lostAt(double time) const;
  //! Drops what is improbable. \param filter Becomes that of the likeliest place. \param location Likewise,
  //! its covariance that of all.
  void settle(const vpLampFrame &frame, const vpVlpHypotheses &hypotheses, vpVlpFilter &filter,
              vpVlpLocation &location);

private:
  static constexpr double nowhere = -1e300; // logarithm of 0

  void compare(size_t lamp);
  //! Log probability that the robot was put elsewhere since the frame before, wherever that is.
  double logPut(const vpVlpHypotheses &hypotheses) const;
  void reduce(const vpVlpHypotheses &hypotheses);
  void tell(const vpLampFrame &frame, const vpVlpHypotheses &hypotheses, vpVlpLocation &location) const;
  static bool isLost(const vpPoseHypothesis &place);
  static bool agree(const vpPoseHypothesis &place, const vpPoseHypothesis &other);

  std::vector<vpPoseHypothesis> m_places; // the likeliest first
  double m_logAnywhere = nowhere;         // log probability of none of them
  vpLampHistory m_lamps;                  // where there is no place
};

END_VISP_NAMESPACE

#endif
