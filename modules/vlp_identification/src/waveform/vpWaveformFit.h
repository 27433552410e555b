/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpWaveformFit_h
#define vpWaveformFit_h

#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <visp3/vlp_identification/vpStripeAnalyzer.h>

#include "vpPulsePosterior.h"
#include "vpPulseWave.h"

BEGIN_VISP_NAMESPACE

/*!
  A blinking lamp fitted to a profile: light = offset + envelope(y) S(f t + phase), S the one- or two-pulse
  waveform averaged over the exposure in closed form, the envelope a given one times a polynomial in y, the
  line scaled to [-1, 1] over the profile.

  Offset and envelope are linear and solved for at each step (variable projection, Golub and Pereyra 1973);
  Levenberg and Marquardt's method does the rest. Where the grey scale cuts off lit lines, the wave is as
  bright as white, and of a shorter exposure: a trapezoid that is cut off is one.

  Where the lines leave gaps between their exposures, an edge of a pulse may lie anywhere in one: the cost is
  flat there and its curvature says nothing. So integrate() takes mean and standard deviation from the
  posterior itself: of one pulse a period summed over a grid (vpPulsePosterior), of two by slice sampling
  (Neal 2003), with the same random numbers each time.
*/
class vpWaveformFit
{
public:
  enum Parameter { frequency, phase, duty, exposure, phaseDifference, parameters };
  using Vector = Eigen::Matrix<double, parameters, 1>;
  using Matrix = Eigen::Matrix<double, parameters, parameters>;

  struct Settings {
    int envelopeOrder = 0;    // up to 4
    int envelopeUnknowns = 0; // that the given envelope was told with
    bool twoPulse = false;
    double modelError = 0.03;
    double exposureTolerance = 0.02;
  };

  //! \param envelope How bright the lamp is at each line while it is lit, about, grey levels.
  vpWaveformFit(const vpStripeProfile &profile, const Settings &settings,
                const std::vector<double> &envelope);

  /*!
    Where to start from. \param f Hz. \param startPhase Periods, at the middle of the profile. \param k Phase
    difference, periods. \param startExposure s; 0: the profile's.
  */
  void begin(double f, double startPhase, double startDuty, double k, double startExposure = 0);
  //! The first steps of least squares, which tell good starts from others.
  void approach();
  //! The rest of them. \return False where they lead nowhere.
  bool arrive();
  //! All from a start.
  bool run(double f, double startPhase, double startDuty, double k, double startExposure = 0)
  {
    begin(f, startPhase, startDuty, k, startExposure);
    return arrive();
  }

  /*!
    Pulse and exposure are both boxes, and which is which the profile does not say, nor which of them are the
    dark rest of the period: takes what of these is together nearest to the stated exposure, to the duties
    that lamps have and to a lamp that goes dark.
  */
  bool preferStatedExposure();

  //! Where the lines leave gaps, an edge that no line sees leads no descent out of its gap: goes on from the
  //! likeliest place about the minimum.
  void leaveGap();

  //! Turns values and standard deviations into those of the posterior about the minimum that run() found.
  void integrate();

  /*!
    Whether pulses may stay within single lines over the whole profile: short ones of a bright lamp and longer
    ones of a dim lamp then look alike, and the frequency depends on which they are.
  */
  bool hidesDuty() const;
  //! The posterior of the frequency at duties about the fitted one, as far as they explain the profile; none
  //! where no other duty does. After integrate().
  std::vector<vpDutySlice> alongDuty() const;

  double value(Parameter p) const { return m_x(p); }
  double sigma(Parameter p) const { return m_sigma(p); }
  /*!
    Standard deviation, Hz, that the frequency would have of a sinusoid as strong and as noisy as the stripes
    (Rife and Boorstyn 1974), its edges as often as not in gaps between the exposures. After integrate().
  */
  double frequencyBound() const;
  //! What noise leaves of the frequency's standard deviation, Hz; the rest is of where edges hide from the
  //! lines. After integrate().
  double frequencyNoise() const;
  //! Whether few lines make a pattern that repeats over the whole profile: its edges pass from line to line
  //! all at once.
  bool repeats() const;
  //! Chi-square of profile and priors together.
  double cost() const { return m_cost; }
  //! The same with what offset and envelope have to explain to be worth their unknowns (Schwarz 1978).
  double criterion() const
  {
    return m_cost +
           (1 + m_bends + m_settings.envelopeUnknowns) * std::log(static_cast<double>(m_time.size()));
  }
  //! Share of the stripes' power left unexplained, beyond what noise explains.
  double misfit() const;
  //! How bright the lamp is at each line while it is lit, as it was fitted, grey levels.
  Eigen::ArrayXd envelope() const;

private:
  static constexpr int mostLinear = 6;

  struct Prior {
    double chiSquare = 0, weight = 0, mean = 0;
  };
  struct LookAlike {
    Vector x;
    double unlikely; // chi-square
  };
  struct Posterior {
    Vector mean;
    Matrix covariance;
  };
  class Moments;
  class Uniform;
  Posterior posterior();
  Posterior sliced(const Posterior &bell);
  Posterior onGrid(const Posterior &bell);
  vpPulsePosterior::Lines linesWith(double exposed) const;
  bool goOnFrom(const Eigen::Vector3d &place);
  Moments sweep(const Matrix &covariance, int sweeps, double temperature, Vector &x, Uniform &uniform);
  double slice(const Vector &axis, double width, double level, Vector &x, double &here, Uniform &uniform);
  void judgeResiduals();
  vpDutySlice slice(double atDuty);

  //! Whether gaps between exposures matter.
  bool leavesGaps() const
  {
    static const double apart = 1.15; // exposures from line to line
    return m_line >= apart * m_x(exposure);
  }
  double gap() const { return std::max(0.0, m_line - m_profile->exposure); } // s, from exposure to exposure
  double sinusoidSigma() const;
  void prepareSums();
  void evaluateWave(const Vector &x, const Eigen::ArrayXd &time, vpPulseWave &wave,
                    vpPulseWave &second) const;
  void evaluateValue(const Vector &x);
  //! Cost where offset and envelope fit best. Fills m_coefficient.
  double cost(const Vector &x);
  //! At m_x, with all that goes with it.
  void settle();
  void normalEquations(Matrix &H, Vector &g);
  void descend(int iterations);
  bool bendEnvelope();
  Eigen::ArrayXd residuals() const;
  bool isFree(int parameter) const
  {
    switch (parameter) {
    case phaseDifference:
      return m_settings.twoPulse;
    case duty:
      return m_freeDuty;
    default:
      return true;
    }
  }
  //! Whether keepPossible() would leave it as it is.
  bool isPossible(const Vector &x) const
  {
    Vector possible = x;
    keepPossible(possible);
    return possible == x;
  }
  double pulses() const { return m_settings.twoPulse ? 2 : 1; } // of a period
  double leastOffset(double share) const;
  double unlikely(const Vector &x, double darkest) const;
  std::vector<LookAlike> lookAlikes() const;
  void keepPossible(Vector &x) const;
  Prior prior(int parameter, const Vector &x) const;
  int degreesOfFreedom() const;

  const vpStripeProfile *m_profile;
  Settings m_settings;
  int m_bends = 1;                        // envelope coefficients
  double m_half = 1;                      // s
  double m_line = 0;                      // s, mean distance of the lines
  double m_startFrequency = 0;            // Hz
  double m_logEdgeSigma;                  // as the profile states it
  double m_logExposureSigma;              // prior of the exposure's logarithm
  double m_leastExposure, m_mostExposure; // s
  bool m_freeDuty = true;
  double m_darkness = 0; // 1 / variance of the offset about 0
  // Of each line.
  Eigen::ArrayXd m_time;                             // s, from the profile's middle
  Eigen::ArrayXd m_light;                            // grey levels
  Eigen::ArrayXd m_weight;                           // 1 / variance
  Eigen::ArrayXd m_given;                            // envelope, grey levels
  Eigen::MatrixXd m_powers;                          // the same times powers of the time
  Eigen::MatrixXd m_ofWave, m_ofSquare;              // by which to sum the wave, its square
  double m_weights = 0, m_lights = 0, m_squares = 0; // sums of weights, times light, times its square
  Vector m_x = Vector::Zero();
  Vector m_sigma = Vector::Zero();
  Matrix m_curvature = Matrix::Zero(); // of half the cost, priors included
  double m_cost = 0;
  double m_chiSquare = 0; // of the profile alone
  double m_inflation = 1; // of all variances, by what the model leaves out
  // At m_x: at each line the wave (of two pulses: both, and the second one).
  vpPulseWave m_wave, m_second;
  std::array<double, mostLinear> m_coefficient{}; // the linear parameters of the latest cost()
  // Kept from step to step for their memory.
  Eigen::ArrayXd m_value, m_square, m_column, m_residual;
  Eigen::MatrixXd m_jacobian;
};

END_VISP_NAMESPACE

#endif
