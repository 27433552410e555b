/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// The paper's node CamKF: follows the lamps from picture to picture. A new one's id it asks ID_recognition
// for.

#include <algorithm>
#include <map>

#include <sensor_msgs/image_encodings.h>
#include <visp3/vlp_tracking/vpLampTracker.h>
#include <visp_vlp/GetImage.h>

#include "vpPictures.h"
#include "vpRosMessages.h"
#include "vpRosNode.h"

namespace
{
//! The id of each lamp that is followed, by the number of its track.
class Names
{
public:
  explicit Names(ros::NodeHandle &nh) : m_nh(nh) {}

  //! Gives each lamp the id that its track has, or asks for it, once for each frame and lamp.
  void give(const vpVlpFrame &frame, std::vector<vpLampObservation> &lamps)
  {
    std::map<unsigned int, Name> kept;
    for (vpLampObservation &lamp : lamps) {
      lamp.id.clear();
      lamp.confidence = 0;
      if (lamp.track == 0) {
        continue;
      }
      const auto known = m_names.find(lamp.track);
      const Name name = known != m_names.end() ? known->second : ask(frame, lamp);
      if (!name.id.empty()) {
        kept[lamp.track] = name;
        lamp.id = name.id;
        lamp.confidence = name.confidence;
      }
    }
    for (const auto &[track, name] : m_names) { // a lamp that a frame misses keeps its name for a second
      if (kept.count(track) == 0 && frame.timestamp - name.seen < 1) {
        kept[track] = name;
      }
    }
    for (const vpLampObservation &lamp : lamps) {
      const auto name = kept.find(lamp.track);
      if (name != kept.end()) {
        name->second.seen = frame.timestamp;
      }
    }
    m_names = std::move(kept);
  }

private:
  struct Name {
    std::string id;
    double confidence = 0;
    double seen = 0; // s
  };

  Name ask(const vpVlpFrame &frame, const vpLampObservation &lamp)
  {
    if (!m_recognition.isValid() || !m_recognition.exists()) {
      m_recognition = m_nh.serviceClient<visp_vlp::GetImage>("get_image");
      if (!m_recognition.exists()) {
        ROS_WARN_THROTTLE(1, "%s: nobody offers this service, so that lamps stay without an id",
                          m_recognition.getService().c_str());
        return {};
      }
    }
    visp_vlp::GetImage call;
    cut(frame, lamp, call.request);
    if (!m_recognition.call(call) || !call.response.found) {
      return {};
    }
    return {call.response.lamp.id, call.response.lamp.confidence, frame.timestamp};
  }

  //! The lamp with a margin of half its size.
  static void cut(const vpVlpFrame &frame, const vpLampObservation &lamp, visp_vlp::GetImage::Request &region)
  {
    const Eigen::Vector4d box = lamp.outline.box();
    const double margin = 8 + 0.5 * std::max(box[2] - box[0], box[3] - box[1]);
    const int width = static_cast<int>(frame.I.getWidth()), height = static_cast<int>(frame.I.getHeight());
    const int left = std::clamp(static_cast<int>(box[0] - margin), 0, width - 1),
              top = std::clamp(static_cast<int>(box[1] - margin), 0, height - 1),
              right = std::clamp(static_cast<int>(box[2] + margin) + 1, left + 1, width),
              bottom = std::clamp(static_cast<int>(box[3] + margin) + 1, top + 1, height);
    region.x_offset = static_cast<std::uint32_t>(left);
    region.y_offset = static_cast<std::uint32_t>(top);
    region.width = frame.I.getWidth();
    region.height = frame.I.getHeight();
    region.image.header.stamp = ros::Time().fromSec(frame.timestamp);
    region.image.encoding = sensor_msgs::image_encodings::MONO8;
    region.image.width = region.image.step = static_cast<std::uint32_t>(right - left);
    region.image.height = static_cast<std::uint32_t>(bottom - top);
    for (int v = top; v < bottom; ++v) {
      const unsigned char *line = frame.I[v];
      region.image.data.insert(region.image.data.end(), line + left, line + right);
    }
  }

  ros::NodeHandle &m_nh;
  ros::ServiceClient m_recognition;
  std::map<unsigned int, Name> m_names;
};

class CamKF
{
public:
  CamKF()
      : m_rig(vpRigParameter(m_own)), m_tracker(m_rig, vpLampMap()), m_names(m_nh),
        m_lamps(m_nh.advertise<visp_vlp::LampObservations>("lamp_observations", 10)),
        m_pictures(m_nh, m_own,
                   [this](const vpVlpFrame &frame, const std_msgs::Header &header) { look(frame, header); })
  {
  }

private:
  void look(const vpVlpFrame &frame, const std_msgs::Header &header)
  {
    if (frame.timestamp <= m_last) {
      static const double setBack = 1; // s
      const bool anew = frame.timestamp <= m_last - setBack;
      ROS_WARN_THROTTLE(1, "camera/image: stamp %.6f s, expected one later than the frame before, %.6f s: %s",
                        frame.timestamp, m_last,
                        anew ? "the clock was set back, all lamps are searched for anew"
                             : "the clock stands still, the frame is dropped");
      if (!anew) {
        return;
      }
      m_tracker.reset();
    }
    m_last = frame.timestamp;
    std::vector<vpLampObservation> lamps = m_tracker.track(frame);
    m_names.give(frame, lamps);
    visp_vlp::LampObservations message;
    message.header = header;
    message.width = frame.I.getWidth();
    message.height = frame.I.getHeight();
    for (const vpLampObservation &lamp : lamps) {
      message.lamps.push_back(vpRosMessages::lamp(lamp));
    }
    m_lamps.publish(message);
  }

  ros::NodeHandle m_nh, m_own{"~"};
  vpVlpRig m_rig;
  vpLampTracker m_tracker;
  Names m_names;
  double m_last = -1; // s, of the last frame
  ros::Publisher m_lamps;
  vpPictureSubscriber m_pictures; // last: it uses all of the above
};
} // namespace

int main(int argc, char **argv)
{
  return vpRunNode(argc, argv, "CamKF", [] {
    CamKF node;
    ros::spin();
  });
}
