/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// All in one process: from pictures and odometry to the robot's pose.

#include <visp3/vlp_localization/vpVlpLocalizer.h>

#include "vpLocationOutputs.h"
#include "vpPictures.h"
#include "vpRosMessages.h"
#include "vpRosNode.h"

namespace
{
class Vlp
{
public:
  explicit Vlp(const ros::NodeHandle &own)
      : m_map(vpLampsParameter(own)), m_localizer(vpRigParameter(own), m_map), m_outputs(m_nh, own, m_map),
        m_odometry(m_nh.subscribe("odom", 100, &Vlp::move, this, ros::TransportHints().tcpNoDelay())),
        m_pictures(m_nh, own, [this](const vpVlpFrame &frame, const std_msgs::Header &) {
          m_outputs.publish(m_localizer.process(frame));
        })
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

  ros::NodeHandle m_nh;
  vpLampMap m_map;
  vpVlpLocalizer m_localizer;
  vpLocationOutputs m_outputs;
  ros::Subscriber m_odometry;
  vpPictureSubscriber m_pictures; // last: it uses all of the above
};
} // namespace

int main(int argc, char **argv)
{
  return vpRunNode(argc, argv, "vlp", [] {
    Vlp node(ros::NodeHandle("~"));
    ros::spin();
  });
}
