/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPointServo_h
#define vpPointServo_h

#include <Eigen/Core>
#include <visp3/core/vpHomogeneousMatrix.h>
#include <visp3/robot/vpUnicycle.h>
#include <visp3/visual_features/vpFeaturePoint3D.h>
#include <visp3/vlp_servo/vpPathReference.h>
#include <visp3/vs/vpServo.h>

BEGIN_VISP_NAMESPACE

struct VISP_EXPORT vpPointServoSettings {
  double lookAhead = 0.08;     // m, from the axle to the control point; along the path, errors fade by it
  double gain = 2.5;           // 1/s, lambda of small errors
  double gainFar = 1;          // 1/s, lambda of large ones; no more than gain
  double gainSlope = 5;        // 1/s per m/s or rad/s of J^+ e, by which lambda falls from small errors on
  double integralGain = 0.3;   // 1/s; 0: none
  double steepest = 1;         // speed across the path that feedback asks for, as a share of that along it
  double slowest = 0.01;       // m/s, that this is a share of at least
  double mostSpeedScale = 0.2; // share, most that the integral adds to the reference's speed
  double mostCurvature = 1;    // 1/m, likewise to its curvature

  //! \throw vpException (badValue) with one line: the field, what came and what was expected.
  void check() const;
};

/*!
  The visual task of a unicycle that follows a moving reference.

  The control frame c stands \e lookAhead ahead of the base b, its axes those of b. The feature is ViSP's
  vpFeaturePoint3D, X and Y only: the reference's own point, as far ahead of it, as seen in c. Desired: in c's
  origin. With vpServo::EYEINHAND_L_cVe_eJe, the unicycle's eJe for (v, w) and cVe = (cMb):
  \f[ J = L\, {}^cV_e\, {}^eJ_e = \begin{pmatrix} -1 & Y \\ 0 & -(d + X) \end{pmatrix} \f]
  which can be inverted as long as the reference's point is not beside the axle: that is why the point is
  ahead of it. The velocities are
  \f[ \dot q = -\lambda(e) J^+ e - J^+ \frac{\partial e}{\partial t} + q_i \f]
  the first term out of vpServo::computeControlLaw() with an adaptive gain; the second the feed-forward of the
  reference, \f$ \partial e / \partial t \f$ being the velocity of its point in c; the third the integral
  against constant disturbances. Wheels of unlike size and slip err in proportion to the speed, so what is
  summed up is a curvature and a scale of the speed, \f$ q_i = v_r (\sigma, \kappa) \f$.

  Once the control point is on the reference's, the base itself swings in on the path within a way of
  \e lookAhead: its heading error obeys d(error)/ds = -sin(error) / lookAhead, whatever the wheels do.

  Feedback across the path is limited by the reference's speed (\e steepest), so that a base far off comes
  back at an angle, and one that stands does not twist.
*/
class VISP_EXPORT vpPointServo
{
public:
  //! \throw vpException (badValue) where the settings are out of range.
  explicit vpPointServo(const vpPointServoSettings &settings);
  ~vpPointServo();
  vpPointServo(const vpPointServo &) = delete;
  vpPointServo &operator=(const vpPointServo &) = delete;

  /*!
    The velocities of the base (m/s, rad/s) that stands at \e wMb, of which x, y and the heading count.
    \param dt s, since the last call, over which the integral sums; 0: it does not, as where the base did not
    do what it was told.
  */
  vpBaseVelocity velocity(const vpHomogeneousMatrix &wMb, const vpReference &reference, double dt);

  //! X and Y of the reference's point in c as of the last call, m: the error of the task before any limit.
  const Eigen::Vector2d &error() const { return m_error; }

  //! What the integral found: scale of the speed (share) and curvature (1/m).
  const Eigen::Vector2d &disturbance() const { return m_integral; }
  void forgetDisturbance() { m_integral.setZero(); }

private:
  Eigen::Vector2d limited(const Eigen::Vector2d &error, double speed) const;
  void integrate(double speed, double dt);

  vpPointServoSettings m_settings;
  vpUnicycle m_unicycle;
  vpFeaturePoint3D m_point, m_desired;
  vpServo m_task;
  Eigen::Vector2d m_error = Eigen::Vector2d::Zero();
  Eigen::Vector2d m_integral = Eigen::Vector2d::Zero();
};

END_VISP_NAMESPACE

#endif
