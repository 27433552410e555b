/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Drives a path: poses of vlp_location and odom in, cmd_vel out. It ends where the path does.

#include <visp3/core/vpException.h>
#include <visp3/vlp_servo/vpServoLoop.h>

#include "vpRosNode.h"
#include "vpRosRobot.h"

namespace
{
//! Periods on the clock of ROS, which may be simulated.
class RosClock : public vpServoClock
{
public:
  double period() const override { return m_period; }
  double next() override
  {
    m_rate.sleep();
    return now();
  }
  double now() override { return ros::Time::now().toSec(); }

private:
  double m_period = 0.02; // s
  ros::Rate m_rate{1 / m_period};
};

void run()
{
  ros::NodeHandle nh, own("~");
  const vpPath path = vpPath::load(vpRequiredParameter(own, "path", "the name of a path's yaml"));
  vpServoLoopSettings settings;
  settings.follower.reference.speed = own.param("speed", settings.follower.reference.speed); // m/s
  vpRosBase base(nh,
                 {own.param("most_v", 0.22), own.param("most_w", 2.84)}); // m/s, rad/s; a TurtleBot3 Burger's
  vpRosPose poses(nh);
  RosClock clock;
  ros::AsyncSpinner spinner(1);
  spinner.start();
  const double patience = own.param("patience", 10.0); // s, for the first odom
  const ros::Time begin = ros::Time::now();
  while (ros::ok() && ros::Time::now() - begin < ros::Duration(patience)) {
    try {
      base.odometry();
      break;
    } catch (const vpException &) {
      ros::Duration(0.05).sleep();
    }
  }
  vpServoLoop loop(base, poses, clock, path, settings);
  std::string waiting;
  loop.watch = [&](const vpServoStep &step, const std::vector<vpLocatedPicture> &) {
    if (step.waiting != waiting) {
      waiting = step.waiting;
      ROS_INFO("%s", waiting.empty() ? "drives" : ("waits: " + waiting).c_str());
    }
    return ros::ok();
  };
  const vpServoRun done = loop.run();
  if (done.end == vpServoRun::End::failed) {
    throw vpException(vpException::fatalError, done.reason);
  }
  ROS_INFO("%s", done.end == vpServoRun::End::arrived ? "arrived" : "stopped");
}
} // namespace

int main(int argc, char **argv)
{
  return vpRunNode(argc, argv, "vlp_servo", run);
}
