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
#include "vpLampHistory.h"
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
    bool wasStranger = false; // in the frame before
    double logLikelihood = 0; // of the ray, whatever it is
    double strayed = 0;       // nats, that a stranger does not hang still
    bool another = false;     // stranger than in the frame before
    bool surprises = false;   // stranger only now, and as large as the lamp was

    double logPeak() const { return logNormal(Eigen::Vector2d::Zero(), innovation.covariance); } // of a lamp
  };

  //! \param filter Its settings and odometry.
  vpPoseHypothesis(const vpVlpFilter &filter, const vpVlpHypotheses &hypotheses,
                   const vpLampHistory &history);

  //! Begins with a frame, at the pose at which the filter was started. \param isFirst There was no place: the
  //! odometry tells how the robot moves. Else what is wrong may be the odometry.
  void begin(const vpLampFrame &frame, bool isFirst);
  //! Goes on to a frame. \return Log likelihood of the frame.
  double follow(const vpLampFrame &frame);
  //! As it would be after the latest frame, were none of that frame's lamps the map's.
  vpPoseHypothesis coasted(const vpLampFrame &frame) const;

  //! Log likelihoods of the frame that it began with.
  struct Begun {
    double put;    // had the robot been put there, from where it was
    double copied; // had lamps moved as if it had been
  };
  Begun begun(const vpPoseHypothesis &before) const;
  //! Probability that the odometry, where there is any, does not tell the velocity.
  double odometryIsOff() const { return m_modes.odometryIsOff(); }

  //! The pose at the frame's time stamp, and the lamps that it rests on.
  void tell(const vpLampFrame &frame, vpVlpFix &fix) const;
  //! Which lamps were accepted, and why others were not.
  void mark(const vpLampFrame &frame, std::vector<vpLampObservation> &observations) const;
  size_t accepted() const { return accepted(verdicts); }
  //! Whether lamps are strangers that were none, and none is where it is expected.
  bool isSurprised() const;
  //! Of a lamp of the latest frame: log likelihood that it adds where it was a stranger before, and is one
  //! still, had a lamp in its place \e asLamp.
  double asStill(size_t lamp, double asLamp) const;
  double logLikelihood() const { return m_logLikelihood; } // of the latest frame
  double since() const { return m_since; }                 // s, from the frame before to the latest one
  //! What the frames since the start have told of the motion, nats.
  double information() const { return m_modes.information(); }

  vpVlpFilter filter;
  vpLampHistory history;
  double logWeight = 0;
  int frames = 0;       // followed
  double asked = 0;     // information() at which it is compared with wider claims next
  bool borneOut = true; // else it was put there, which no lamp more than a pose needs has shown since
  std::vector<Verdict> verdicts; // on the lamps of the latest frame

private:
  struct Pass {
    vpVlpFilter filter;
    std::vector<Verdict> verdicts;
    double logLikelihood;
  };

  static size_t accepted(const std::vector<Verdict> &verdicts);
  void correct(const vpLampFrame &frame, double least, Pass &pass) const;
  void attempt(const vpLampFrame &frame, const vpVlpFilter &before, size_t mode, double least, Pass &pass);
  Verdict judge(const vpLampFrame &frame, size_t which, bool told, vpLampSight &sight,
                const vpVlpFilter &filter, const vpVlpFilter::Predicted &predicted) const;
  double weigh(const vpLampFrame &frame, double dt);
  size_t mix(vpVlpFilter &mixed, size_t first, size_t end) const;
  void mixInnovations();
  void compare(const vpLampFrame &frame);
  void learn(const vpLampFrame &frame);
  void learnStranger(const vpLampFrame &frame, size_t which);
  vpLampExtent expectedExtent(const vpLampFrame &frame, const vpLamp &lamp) const;

  vpVlpHypotheses m_hypotheses;
  vpMotionModes m_modes;
  std::vector<Pass> m_passes;
  std::array<vpVlpFilter, 2> m_apart; // the odometry is off; it is right
  bool m_parted = false;              // there was odometry in the latest frame
  std::vector<bool> m_strangers;      // which lamps of the latest frame were so before it
  std::vector<std::string> m_changes; // of each lamp of the latest frame; empty: as before
  vpVlpFilter m_there;                // attempt(): takes no memory
  vpVlpFilter m_before;               // before the latest frame,
  std::array<vpVlpFilter, 2> m_apartBefore;
  vpMotionModes m_modesBefore;
  double m_since = 0;         // s, from the frame before to the latest one
  double m_time = 0;          // s, of the latest frame
  double m_logLikelihood = 0; // of the latest frame
};

END_VISP_NAMESPACE

#endif
