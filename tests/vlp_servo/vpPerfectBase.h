/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPerfectBase_h
#define vpPerfectBase_h

#include <cmath>
#include <functional>
#include <vector>

#include <visp3/core/vpException.h>
#include <visp3/vlp_robot/vpTurtleBot3.h>
#include <visp3/vlp_servo/vpPoseSource.h>
#include <visp3/vlp_servo/vpServoClock.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

/*!
  A base on its own time that does at once what it is told, but for a disturbance, and whose pose is known
  exactly: what is left is the control law. It notes every command.
*/
class vpPerfectBase : public vpMobileBase, public vpServoClock, public vpPoseSource
{
public:
  double scale = 1;     // of the speed
  double curvature = 0; // 1/m, that its wheels add
  double sigma = 1e-3;  // m, that its pose claims of x and y
  bool known = true;    // the pose
  bool reachable = true;
  vpHomogeneousMatrix wMb;
  std::vector<vpBaseVelocity> told;
  size_t stops = 0;
  std::function<void(double)> each; // called with the time of each period

  vpBaseVelocity setVelocity(double v, double w) override
  {
    expectReachable();
    m_velocity = {v, w};
    told.push_back(m_velocity);
    return m_velocity;
  }
  void stop() override
  {
    ++stops;
    expectReachable();
    m_velocity = {};
  }
  vpOdometry odometry() override
  {
    expectReachable();
    return {m_time, m_velocity.v, m_velocity.w};
  }
  vpBaseLimits limits() const override { return vpTurtleBot3().limits(); }

  double period() const override { return 0.02; }
  double next() override
  {
    const double v = scale * m_velocity.v;
    wMb = vpDrivenOn(wMb, {v, m_velocity.w + curvature * v}, period());
    m_time += period();
    if (each) {
      each(m_time);
    }
    return m_time;
  }
  double now() override { return m_time; }

  vpVlpFix at(double) const override
  {
    vpVlpFix fix;
    fix.valid = known;
    fix.refusal = known ? "" : "nothing to see";
    fix.wMb = wMb;
    fix.covariance.diagonal() << sigma * sigma, sigma * sigma, 0, 0, 0, 1e-6;
    return fix;
  }

  double x() const { return wMb[0][3]; }
  double y() const { return wMb[1][3]; }
  double yaw() const { return std::atan2(wMb[1][0], wMb[0][0]); }
  const vpBaseVelocity &velocity() const { return m_velocity; }

private:
  void expectReachable() const
  {
    if (!reachable) {
      throw vpException(vpException::ioError, "base: the cable is out");
    }
  }

  double m_time = 0; // s
  vpBaseVelocity m_velocity;
};

inline vpHomogeneousMatrix vpStanding(double x, double y, double yaw)
{
  return vpHomogeneousMatrix(x, y, 0, 0, 0, yaw);
}

#endif
