/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// All in one process: from pictures and odometry to the robot's pose.

#include <image_transport/image_transport.h>
#include <visp3/vlp_localization/vpVlpLocalizer.h>

#include "vpLocationOutputs.h"
#include "vpRosMessages.h"
#include "vpRosNode.h"

namespace
{
class Vlp
{
public:
  explicit Vlp(const ros::NodeHandle &own)
      : m_map(vpLampsParameter(own)), m_localizer(vpRigParameter(own), m_map), m_outputs(m_nh, own, m_map),
        m_transport(m_nh),
        m_odometry(m_nh.subscribe("odom", 100, &Vlp::move, this, ros::TransportHints().tcpNoDelay())),
        m_pictures(
            m_transport.subscribe("camera/image", 1, &Vlp::locate, this,
                                  image_transport::TransportHints("raw", ros::TransportHints().tcpNoDelay())))
  {
  }

private:
  void move(const nav_msgs::OdometryConstPtr &odom)
  {
    vpHandle([&] {
      m_localizer.filter.addOdometry(vpRosMessages::odometry(*odom));
      m_outputs.addOdometry(*odom);
    });
  }

  void locate(const sensor_msgs::ImageConstPtr &image)
  {
    vpHandle([&] { m_outputs.publish(m_localizer.process(vpRosMessages::frame(*image))); });
  }

  ros::NodeHandle m_nh;
  vpLampMap m_map;
  vpVlpLocalizer m_localizer;
  vpLocationOutputs m_outputs;
  image_transport::ImageTransport m_transport;
  ros::Subscriber m_odometry;
  image_transport::Subscriber m_pictures; // last: it uses all of the above
};
} // namespace

int main(int argc, char **argv)
{
  return vpRunNode(argc, argv, "vlp", [] {
    Vlp node(ros::NodeHandle("~"));
    ros::spin();
  });
}
