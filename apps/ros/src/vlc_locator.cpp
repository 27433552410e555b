/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// The paper's node vlc_locator: from lamps and odometry to the robot's pose.

#include <optional>

#include <visp3/core/vpException.h>
#include <visp3/vlp_localization/vpVlpLocalizer.h>
#include <visp_vlp/LedInfo.h>

#include "vpLampMapSource.h"
#include "vpLocationOutputs.h"
#include "vpRosMessages.h"
#include "vpRosNode.h"

namespace
{
class Locator
{
public:
  Locator()
      : m_rig(vpRigParameter(m_own)), m_outputs(m_nh, m_own),
        m_mapSource(m_nh, m_own, [this](const vpLampMap &map) { use(map); }),
        m_odometry(m_nh.subscribe("odom", 100, &Locator::move, this, ros::TransportHints().tcpNoDelay())),
        m_lamps(m_nh.subscribe("lamp_observations", 10, &Locator::locate, this,
                               ros::TransportHints().tcpNoDelay())),
        m_service(m_nh.advertiseService("LED_info_srv", &Locator::locateAlone, this))
  {
  }

private:
  void use(const vpLampMap &map)
  {
    m_map = map;
    m_localizer.emplace(m_rig, map);
    m_outputs.setMap(map);
  }

  void move(const nav_msgs::OdometryConstPtr &odom)
  {
    vpHandle([&] {
      if (m_localizer) {
        m_localizer->filter.addOdometry(vpRosMessages::odometry(*odom));
      }
      m_outputs.addOdometry(*odom);
    });
  }

  void locate(const visp_vlp::LampObservationsConstPtr &lamps)
  {
    vpHandle([&] {
      check(*lamps);
      m_outputs.publish(
          m_localizer->locate(lamps->header.stamp.toSec(), vpRosMessages::observations(*lamps)));
    });
  }

  //! Of one frame, whatever came before.
  bool locateAlone(visp_vlp::LedInfo::Request &request, visp_vlp::LedInfo::Response &answer)
  {
    bool good = false;
    vpHandle([&] {
      check(request.lamps);
      vpVlpLocalizer localizer(m_rig, m_map);
      localizer.tracking = false;
      const double time = request.lamps.header.stamp.toSec();
      const vpVlpLocation location = localizer.locate(time, vpRosMessages::observations(request.lamps));
      answer.valid = location.fix.valid;
      answer.refusal = location.fix.refusal;
      answer.location =
          vpRosMessages::location(location.fix, time, m_own.param<std::string>("map_frame", "map"));
      good = true;
    });
    return good;
  }

  void check(const visp_vlp::LampObservations &lamps) const
  {
    if (!m_localizer) {
      throw vpException(vpException::notInitialized, "no lamp map yet");
    }
    if (lamps.width != m_rig.width || lamps.height != m_rig.height) {
      throw vpException(vpException::dimensionError,
                        "lamp_observations: of pictures of " + std::to_string(lamps.width) + " x " +
                            std::to_string(lamps.height) + ", expected the rig's " +
                            std::to_string(m_rig.width) + " x " + std::to_string(m_rig.height));
    }
  }

  ros::NodeHandle m_nh, m_own{"~"};
  vpVlpRig m_rig;
  vpLampMap m_map;
  std::optional<vpVlpLocalizer> m_localizer; // once there is a map
  vpLocationOutputs m_outputs;
  vpLampMapSource m_mapSource;
  ros::Subscriber m_odometry, m_lamps; // last: they use all of the above
  ros::ServiceServer m_service;
};
} // namespace

int main(int argc, char **argv)
{
  return vpRunNode(argc, argv, "vlc_locator", [] {
    Locator node;
    ros::spin();
  });
}
