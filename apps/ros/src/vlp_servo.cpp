/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Drives a path: poses of vlp_location and odom in, cmd_vel out. It ends where the path does.

#include <visp3/core/vpException.h>
#include <visp3/vlp_servo/vpServoLoop.h>

#include "vpRosNode.h"
#include "vpRosServoRobot.h"

namespace
{
void run()
{
  const ros::NodeHandle nh, own("~");
  const vpPath path = vpPath::load(vpRequiredParameter(own, "path", "the name of a path's yaml"));
  vpServoLoopSettings settings;
  settings.follower.reference.speed = own.param("speed", settings.follower.reference.speed); // m/s
  vpRosServoRobot robot(
      nh, {own.param("most_v", vpRosServoRobot::mostV), own.param("most_w", vpRosServoRobot::mostW)});
  const std::unique_ptr<vpPoseSource> poses = robot.poses();
  vpServoLoop loop(robot.base(), *poses, robot.clock(), path, settings);
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
