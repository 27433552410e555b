/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPoseHypothesis_h
#define vpPoseHypothesis_h

#include <array>
#include <string>
#include <vector>

#include "vpLampFrame.h"
#include "vpLampTrust.h"
#include "vpMotionModes.h"

BEGIN_VISP_NAMESPACE

/*!
  A place where the robot may be, carried from frame to frame: the filter, how the robot may move, and what
  each lamp may be from there (MODEL.md).
*/
class vpPoseHypothesis
{
public:
  //! What a lamp's ray says of it.
  struct Verdict {
    vpVlpFilter::Innovation innovation;
    bool accepted = false;    // likelier the map's than not
    double logLikelihood = 0; // of the ray, whatever it is
  };

  //! \param filter Its settings and odometry.
  vpPoseHypothesis(const vpVlpFilter &filter, const vpVlpHypotheses &hypotheses, const vpLampTrust &trust);

  //! Begins at a pose, with a frame. \param filter Started there.
  void begin(const vpLampFrame &frame);
  //! Goes on to a frame. \return Log likelihood of the frame.
  double follow(const vpLampFrame &frame);
  //! As it would be after the latest frame, were none of that frame's lamps the map's.
  vpPoseHypothesis coasted(const vpLampFrame &frame) const;

  /*!
    Log likelihood of the frame that it began with, lamps having moved in the picture as if the robot had been
    put there. \param before The hypothesis from which it was.
  */
  double logStep(const vpPoseHypothesis &before) const;
  //! Probability that the odometry, where there is any, does not tell the velocity.
  double odometryIsOff() const { return m_modes.odometryIsOff(); }

  //! The pose at the frame's time stamp, and the lamps that it rests on.
  void tell(const vpLampFrame &frame, vpVlpFix &fix) const;
  //! Which lamps were accepted, and why others were not.
  void mark(const vpLampFrame &frame, std::vector<vpLampObservation> &observations) const;
  size_t accepted() const;
  double logLikelihood() const { return m_logLikelihood; } // of the latest frame
  //! Probability that the robot keeps its velocity.
  double steady() const { return m_modes.steady(); }

  vpVlpFilter filter;
  vpLampTrust trust;
  double logWeight = 0;
  int frames = 0;                // followed
  bool borneOut = true;          // else it was put there, which no lamp more than a pose needs has shown since
  std::vector<Verdict> verdicts; // on the lamps of the latest frame

private:
  struct Pass {
    vpVlpFilter filter;
    std::vector<Verdict> verdicts;
    double logLikelihood;
  };

  void correct(const vpLampFrame &frame, Pass &pass) const;
  void attempt(const vpLampFrame &frame, const vpVlpFilter &before, size_t mode, Pass &pass) const;
  Verdict judge(const vpLamp &lamp, bool asLarge, vpLampSight &sight, const vpVlpFilter &filter,
                double logUniform) const;
  double weigh(const vpLampFrame &frame, double dt);
  void compare(const vpLampFrame &frame);
  void learn(const vpLampFrame &frame);
  vpLampExtent expectedExtent(const vpLampFrame &frame, const vpLamp &lamp) const;

  vpVlpHypotheses m_hypotheses;
  vpMotionModes m_modes;
  std::vector<Pass> m_passes;
  size_t m_likeliest = 0;
  std::vector<std::string> m_changes; // of each lamp of the latest frame; empty: as before
  vpVlpFilter m_before;               // before the latest frame,
  vpMotionModes m_modesBefore;
  double m_since = 0;                 // s, from the frame before to the latest one
  double m_time = 0;                  // s, of the latest frame
  double m_logLikelihood = 0;         // of the latest frame
};

END_VISP_NAMESPACE

#endif
