/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpMotionModes_h
#define vpMotionModes_h

#include <array>

#include <visp3/vlp_localization/vpVlpFilter.h>
#include <visp3/vlp_localization/vpVlpHypotheses.h>

BEGIN_VISP_NAMESPACE

//! How a robot may move, what its odometry may be worth, and how probable each is (MODEL.md, 2).
class vpMotionModes
{
public:
  static constexpr size_t count = 6, alone = 4; // the first ones do without odometry

  //! Whether a mode takes the odometry to be right.
  static bool byOdometry(size_t mode) { return mode >= alone; }

  //! As it is before anything is known.
  explicit vpMotionModes(const vpVlpHypotheses &hypotheses);

  //! Lets a filter go on as in a mode.
  void apply(size_t mode, vpVlpFilter &filter) const;

  //! After \e dt seconds, before a frame is seen. \param odometry Whether there is any.
  void predict(double dt, bool odometry);
  //! Share of the probability that the odometry is off (0) or right (1) that comes of the other one's.
  double changed(size_t right) const { return m_changed[right]; }
  size_t likeliest() const;
  //! How many modes there are for that frame.
  size_t possible() const { return m_odometry ? count : alone; }
  //! Probability that the odometry, where there is any, does not tell the velocity.
  double odometryIsOff() const { return m_odometry ? 1 - m_right : 1; }
  //! What the frames since the start have told of the motion, nats (Kullback and Leibler 1951).
  double information() const { return m_information; }
  double operator[](size_t mode) const { return m_probability[mode]; }
  //! For frames whose lamps do not tell: whether it goes on steadily or as the wheels say, by how likely the
  //! least likely of their samples is (log density), if they are right, of which they tell nothing.
  void heedOdometry(const std::array<double, count> &logDensity);
  //! By how likely each mode makes the frame. \return Log likelihood of the frame.
  double correct(const std::array<double, count> &logLikelihood);

private:
  vpVlpHypotheses m_hypotheses;
  bool m_odometry = false;
  double m_right; // the odometry is
  std::array<double, 2> m_changed{};
  double m_information = 0;
  std::array<double, alone> m_without;    // kinds of motion, where it is not,
  std::array<double, count - alone> m_by; // where it is
  std::array<double, count> m_probability;
};

END_VISP_NAMESPACE

#endif
