/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// All in one process: from pictures and odometry to the robot's pose.

#include <optional>

#include <visp3/core/vpException.h>
#include <visp3/vlp_localization/vpVlpLocalizer.h>

#include "vpLampMapSource.h"
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
      : m_rig(vpRigParameter(own)), m_outputs(m_nh, own), m_mapSource(m_nh, own,
                                                                      [this](const vpLampMap &map) {
                                                                        m_localizer.emplace(m_rig, map);
                                                                        m_outputs.setMap(map);
                                                                      }),
        m_odometry(m_nh.subscribe("odom", 100, &Vlp::move, this, ros::TransportHints().tcpNoDelay())),
        m_pictures(m_nh, own, [this](const vpVlpFrame &frame, const std_msgs::Header &) {
          if (!m_localizer) {
            throw vpException(vpException::notInitialized, "no lamp map yet");
          }
          m_outputs.publish(m_localizer->process(frame));
        })
  {
  }

private:
  void move(const nav_msgs::OdometryConstPtr &odom)
  {
    vpHandle([&] {
      if (m_localizer) {
        m_localizer->filter.addOdometry(vpRosMessages::odometry(*odom));
      }
      m_outputs.addOdometry(*odom);
    });
  }

  ros::NodeHandle m_nh;
  vpVlpRig m_rig;
  std::optional<vpVlpLocalizer> m_localizer; // once there is a map
  vpLocationOutputs m_outputs;
  vpLampMapSource m_mapSource;
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
