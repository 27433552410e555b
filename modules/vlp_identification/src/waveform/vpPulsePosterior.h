/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPulsePosterior_h
#define vpPulsePosterior_h

#include <vector>

#include <Eigen/Core>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  The posterior of a lamp with one pulse a period, where lines leave gaps between their exposures and the cost
  is flat with walls.

  Unknown are the frequency, the phase of the pulses' middles and their length; offset and amplitude are
  linear and eliminated in each place. The chi-square is a sum over pulses, and that of one pulse depends on
  nothing but when it is and how long: it is tabled once, so that a place on a grid of frequency, phase and
  length costs a look-up for each pulse. The grid narrows down on the places that explain the lines until the
  posterior fills it, and the moments are sums over it. Nothing is sampled, and no minimum has to be known
  better than to a line.
*/
class vpPulsePosterior
{
public:
  //! The lines of a profile.
  struct Lines {
    Eigen::ArrayXf time;   // s, middle of the exposure
    Eigen::ArrayXf light;  // grey levels
    Eigen::ArrayXf weight; // 1 / variance
    Eigen::ArrayXf lit;    // grey levels above the dark lamp while the lamp is lit
    double dark = 0;       // grey levels of the dark lamp, about
    double darkness = 0;   // 1 / variance of that about 0
    double step = 0;       // s, from line to line
    double exposure = 0;   // s
  };

  //! Of frequency (Hz), phase (periods that have passed at time 0 since a pulse began) and duty.
  struct Moments {
    Eigen::Vector3d mean;
    Eigen::Matrix3d covariance;
    double chiSquare = 0;   // the least
    double logEvidence = 0; // logarithm of the likelihood's integral, to a constant
  };

  //! \param start Frequency, phase and duty, good to a line. \param freeDuty Whether the duty is unknown.
  //! \param inflation Of the variances of the lines.
  static Moments about(const Lines &lines, const Eigen::Vector3d &start, bool freeDuty, double inflation);

  //! Frequency, phase and duty.
  struct Place {
    Eigen::Vector3d at;
    double least; // a bound of chi-square from below, at all places nearer to it than to others of the grid
  };
  //! The likeliest place of the first, coarse grid about the start.
  static Place likeliest(const Lines &lines, const Eigen::Vector3d &start, bool freeDuty);

private:
  struct Range;
  struct Places;
  struct Pulse;
  vpPulsePosterior(const Lines &lines, const Eigen::Vector3d &start);
  Range firstRange(bool freeDuty) const;
  Eigen::Vector3d parametersAt(const Eigen::Vector3d &place) const;
  Eigen::Matrix3d byPlace() const;
  void evaluate(const Range &range);
  double changeBetween(const Range &range) const;
  Places likely(const Range &range, double limit) const;
  Moments moments(const Range &range, double limit, double inflation) const;
  void tabulate(const Range &range, double length);
  void addPulses(const Range &range, double ofFrequency);

  const Lines &m_lines;
  Eigen::Vector3d m_start;
  bool m_inverted; // the dark part of a period is the pulse
  double m_length; // s, of a pulse at the start
  double m_half;   // s, of the profile
  double m_weights = 0, m_lights = 0, m_squares = 0;
  std::vector<Pulse> m_pulses;
  Eigen::ArrayXf m_shares, m_products, m_shareSquares; // sums over pulses, one a phase
  std::vector<float> m_chiSquares;                     // length, frequency, phase
};

END_VISP_NAMESPACE

#endif
