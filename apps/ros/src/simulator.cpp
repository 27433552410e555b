/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// A scenario's world as a ROS robot: camera/image, camera/camera_info, odom and ground_truth out, cmd_vel in.

#include <cmath>
#include <thread>

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/Twist.h>
#include <tf2_ros/transform_broadcaster.h>
#include <visp3/core/vpException.h>
#include <visp3/vlp_servo/vpPoseSource.h>
#include <visp3/vlp_servo/vpServoSimulation.h>

#include "vpPictures.h"
#include "vpRosMessages.h"
#include "vpRosNode.h"

namespace
{
double now()
{
  return ros::Time::now().toSec();
}

class Simulator
{
public:
  explicit Simulator(const ros::NodeHandle &own)
      : m_world(vpScenario::load(vpRequiredParameter(own, "scenario", "the name of a scenario's yaml")),
                static_cast<std::uint64_t>(own.param("seed", 1)),
                {own.param("start_x", 0.0), own.param("start_y", 0.0), own.param("start_yaw", 0.0)}, now),
        m_timeout(own.param("command_timeout", 0.5)),
        m_odomFrame(own.param<std::string>("odom_frame", "odom")),
        m_baseFrame(own.param<std::string>("base_frame", "base_link")), m_pictures(m_nh, own, m_world.rig()),
        m_odom(m_nh.advertise<nav_msgs::Odometry>("odom", 100)),
        m_truth(m_nh.advertise<geometry_msgs::PoseStamped>("ground_truth", 100)),
        m_commands(
            m_nh.subscribe("cmd_vel", 1, &Simulator::command, this, ros::TransportHints().tcpNoDelay())),
        m_timer(m_nh.createTimer(ros::Duration(0.02), &Simulator::sense, this)),
        m_camera([this] { takePictures(); })
  {
  }

  ~Simulator() { m_camera.join(); } // ros::ok() is false by now

private:
  void command(const geometry_msgs::TwistConstPtr &twist)
  {
    vpHandle([&] {
      m_world.setVelocity(twist->linear.x, twist->angular.z);
      m_commanded = now();
    });
  }

  void sense(const ros::TimerEvent &)
  {
    vpHandle([&] {
      if (m_commanded > 0 && now() - m_commanded > m_timeout) { // as a TurtleBot's board does
        m_world.stop();
        m_commanded = 0;
      }
      const vpOdometry sample = m_world.odometry();
      if (sample.timestamp <= m_sensed) {
        return;
      }
      if (m_sensed > 0) {
        m_odomMb = vpDrivenOn(m_odomMb, {sample.v, sample.w}, sample.timestamp - m_sensed);
      }
      m_sensed = sample.timestamp;
      nav_msgs::Odometry odom;
      odom.header.stamp = ros::Time().fromSec(sample.timestamp);
      odom.header.frame_id = m_odomFrame;
      odom.child_frame_id = m_baseFrame;
      odom.pose.pose = vpRosMessages::pose(m_odomMb);
      odom.twist.twist.linear.x = sample.v;
      odom.twist.twist.angular.z = sample.w;
      m_odom.publish(odom);
      geometry_msgs::TransformStamped transform;
      transform.header = odom.header;
      transform.child_frame_id = m_baseFrame;
      transform.transform = vpRosMessages::transform(m_odomMb);
      m_transforms.sendTransform(transform);
      geometry_msgs::PoseStamped truth;
      truth.header.stamp = odom.header.stamp;
      truth.header.frame_id = "map";
      truth.pose = vpRosMessages::pose(m_world.wMb(sample.timestamp));
      m_truth.publish(truth);
    });
  }

  void takePictures()
  {
    vpVlpFrame frame;
    while (ros::ok()) {
      vpHandle([&] {
        if (m_world.next(frame)) {
          m_pictures.publish(frame);
        }
      });
    }
  }

  ros::NodeHandle m_nh;
  vpLiveSimulation m_world;
  double m_timeout; // s, after the last command, when the robot stands
  std::string m_odomFrame, m_baseFrame;
  vpPicturePublisher m_pictures;
  ros::Publisher m_odom, m_truth;
  tf2_ros::TransformBroadcaster m_transforms;
  ros::Subscriber m_commands;
  ros::Timer m_timer;
  double m_commanded = 0;       // s, of the last command; 0: it stands
  double m_sensed = 0;          // s, of the last sample
  vpHomogeneousMatrix m_odomMb; // by the samples so far
  std::thread m_camera;         // last: it uses world and publisher
};
} // namespace

int main(int argc, char **argv)
{
  return vpRunNode(argc, argv, "simulator", [] {
    Simulator node(ros::NodeHandle("~"));
    ros::spin();
  });
}
