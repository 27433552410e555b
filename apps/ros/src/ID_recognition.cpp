/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// The paper's node ID_recognition: which lamp a region of a picture shows.

#include <algorithm>
#include <optional>

#include <visp3/core/vpException.h>
#include <visp3/vlp_identification/vpLedDetector.h>
#include <visp_vlp/GetImage.h>

#include "vpLampMapSource.h"
#include "vpRosMessages.h"
#include "vpRosNode.h"

namespace
{
class Recognition
{
public:
  Recognition()
      : m_rig(vpRigParameter(m_own)),
        m_map(m_nh, m_own, [this](const vpLampMap &map) { m_detector.emplace(m_rig, map); }),
        m_service(m_nh.advertiseService("get_image", &Recognition::recognise, this))
  {
  }

private:
  //! False, which the caller sees as a call that failed, where the request makes no sense.
  bool recognise(visp_vlp::GetImage::Request &region, visp_vlp::GetImage::Response &answer)
  {
    bool good = false;
    vpHandle([&] {
      if (!m_detector) {
        throw vpException(vpException::notInitialized, "get_image: no lamp map yet");
      }
      const vpVlpFrame part = vpRosMessages::frame(region.image);
      const unsigned int width = part.I.getWidth(), height = part.I.getHeight();
      if (region.width != m_rig.width || region.height != m_rig.height ||
          region.x_offset > m_rig.width - std::min(width, m_rig.width) || width > m_rig.width ||
          region.y_offset > m_rig.height - std::min(height, m_rig.height) || height > m_rig.height) {
        throw vpException(vpException::dimensionError,
                          "get_image: a region of " + std::to_string(width) + " x " + std::to_string(height) +
                              " at (" + std::to_string(region.x_offset) + ", " +
                              std::to_string(region.y_offset) + ") in a picture of " +
                              std::to_string(region.width) + " x " + std::to_string(region.height) +
                              ", expected one within the rig's " + std::to_string(m_rig.width) + " x " +
                              std::to_string(m_rig.height));
      }
      // The region where it belongs in an empty picture, since each line has its own time.
      vpImage<unsigned char> I(m_rig.height, m_rig.width, 0);
      for (unsigned int v = 0; v < height; ++v) {
        std::copy(part.I[v], part.I[v] + width, I[v + region.y_offset] + region.x_offset);
      }
      const vpRect window(region.x_offset, region.y_offset, width, height);
      m_detector->detect(I, {window});
      answerWith(middlemost(window), answer);
      good = true;
    });
    return good;
  }

  //! Of the lamps that were found the one nearest to the window's middle, nullptr where there is none.
  const vpLampObservation *middlemost(const vpRect &window) const
  {
    const std::vector<vpLampObservation> &all = m_detector->observations();
    const vpImagePoint centre = window.getCenter();
    const Eigen::Vector2d middle(centre.get_u(), centre.get_v());
    const auto nearest =
        std::min_element(all.begin(), all.end(), [&](const vpLampObservation &a, const vpLampObservation &b) {
          return (a.point - middle).norm() < (b.point - middle).norm();
        });
    return nearest == all.end() ? nullptr : &*nearest;
  }

  static void answerWith(const vpLampObservation *lamp, visp_vlp::GetImage::Response &answer)
  {
    static const char *const signals[] = {"unmodulated", "pwm", "two_pulse", "coded"};
    answer.found = lamp != nullptr;
    if (lamp != nullptr) {
      answer.lamp = vpRosMessages::lamp(*lamp);
      answer.signal = signals[static_cast<int>(lamp->features.signal)];
      answer.remark = lamp->remark;
    }
  }

  ros::NodeHandle m_nh, m_own{"~"};
  vpVlpRig m_rig;
  std::optional<vpLedDetector> m_detector; // once there is a map
  vpLampMapSource m_map;
  ros::ServiceServer m_service; // last: it uses all of the above
};
} // namespace

int main(int argc, char **argv)
{
  return vpRunNode(argc, argv, "ID_recognition", [] {
    Recognition node;
    ros::spin();
  });
}
