/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpWaveformFit_h
#define vpWaveformFit_h

#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <visp3/vlp_detection/vpStripeAnalyzer.h>

BEGIN_VISP_NAMESPACE

/*!
  Least squares of a profile to a blinking lamp: light = offset + exp(envelope(y)) S(f t + phase), S the one-
  or two-pulse waveform averaged over the exposure, y the line scaled to [-1, 1] over the profile.
*/
class vpWaveformFit
{
public:
  //! Waveform parameters, in this order; envelope coefficients follow.
  enum Parameter { frequency, phase, duty, exposure, offset, phaseDifference, waveformParameters };

  struct Settings {
    int envelopeOrder = 0;
    bool twoPulse = false;
    double modelError = 0.03;
    double exposureTolerance = 0.5;
  };

  vpWaveformFit(const vpStripeProfile &profile, const Settings &settings);

  //! \param start f (Hz), phase (periods, at the middle of the profile), duty, k; \param envelope log of the
  //! light when lit. \param exposure s, where it is to start from another one than the profile's.
  bool run(double f, double phase, double duty, double k, const Eigen::VectorXd &envelope,
           double exposure = 0);

  /*!
    Pulse and exposure are both boxes, and which is which the profile does not say: swaps them where that
    brings exposure and duty together nearer to the stated exposure and to the duties that lamps have.
  */
  bool preferStatedExposure(int attempts = 2);

  double value(Parameter p) const { return m_x(p); }
  double sigma(Parameter p) const { return m_sigma(p); }
  //! Chi-square of profile and priors together.
  double cost() const { return m_cost; }
  //! Adds to the variance of a parameter.
  void widen(Parameter p, double variance) { m_sigma(p) = std::sqrt(m_sigma(p) * m_sigma(p) + variance); }
  int degreesOfFreedom() const;
  //! Share of the stripes' power left unexplained, beyond what noise explains.
  double misfit() const;

  //! Light of a lamp at phase \e x (periods), averaged over \e width periods about it.
  static double waveform(double x, double width, double duty);

private:
  double model(const Eigen::VectorXd &x, size_t line) const;
  double cost(const Eigen::VectorXd &x, Eigen::VectorXd &weighted) const;
  Eigen::MatrixXd descend(double reach, Eigen::VectorXd &residual);
  bool isFree(int parameter) const;
  void keepPossible(Eigen::VectorXd &x) const;
  double prior(int parameter, double &mean) const;

  const vpStripeProfile *m_profile;
  Settings m_settings;
  double m_middle = 0;         // s
  double m_half = 1;           // s
  double m_startFrequency = 0; // Hz
  Eigen::VectorXd m_weight;    // 1 / standard deviation of each line
  Eigen::VectorXd m_x;
  Eigen::VectorXd m_sigma;
  double m_cost = 0;
};

END_VISP_NAMESPACE

#endif
