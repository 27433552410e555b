/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef realSet_h
#define realSet_h

#include <cstdlib>
#include <functional>
#include <iostream>
#include <map>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <visp3/vlp_core/vpVlpFrame.h>
#include <visp3/vlp_localization/vpVlpLocalizer.h>
#include <visp3/vlp_sensor/vpReadGreyPicture.h>
#include <yaml-cpp/yaml.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

/*!
  One folder of VLP_INPUT_IMAGE_PATH: its set.yaml, and rig and lamp map as a user would write them from it.
  What a set.yaml leaves out (exposure, row-time sigma, principal point) is what a user without a calibration
  would state.
*/
class RealSet
{
public:
  explicit RealSet(const std::string &name) : RealSet(name, environment()) {}

  //! \param root Folder of the sets; empty: none.
  RealSet(const std::string &name, const std::string &root)
  {
    if (!root.empty()) {
      m_folder = root + "/" + name + "/";
      m_set = YAML::LoadFile(m_folder + "set.yaml");
    }
  }

  bool present() const { return !m_folder.empty(); }
  YAML::Node images() const { return m_set["images"]; }
  //! How many of the map's are in a picture.
  size_t lampsIn(const YAML::Node &image) const
  {
    const YAML::Node lamps = image["lamps_px"];
    return lamps.size() - (lamps[doesNotBlink] ? 1 : 0);
  }

  vpVlpFrame frame(const YAML::Node &image)
  {
    vpVlpFrame frame;
    frame.name = image["file"].as<std::string>();
    vpReadGreyPicture(m_folder + frame.name, frame.I);
    if (m_used.insert(frame.name).second) {
      std::cout << "real pictures used: 1 (" << frame.name << ")\n";
    }
    return frame;
  }

  //! \param exposure s; 0: one row time, a guess for sets that do not tell.
  vpVlpRig rig(const YAML::Node &image, const vpVlpFrame &frame, double exposure = 0) const
  {
    vpVlpRig rig;
    rig.width = frame.I.getWidth();
    rig.height = frame.I.getHeight();
    const YAML::Node camera = m_set["camera"];
    const double px = number(camera, "px", 1000);
    rig.camera.initPersProjWithoutDistortion(px, number(camera, "py", px),
                                             number(camera, "u0", 0.5 * (rig.width - 1)),
                                             number(camera, "v0", 0.5 * (rig.height - 1)));
    const YAML::Node shutter = m_set["shutter"];
    rig.shutter.rowTime = 1e-6 * number(image["row_time_us"] ? image : shutter, "row_time_us", 40);
    rig.shutter.rowTimeSigma = vpVlpRig::uncalibratedRowTime * rig.shutter.rowTime;
    rig.shutter.exposure = exposure > 0 ? exposure : rig.shutter.rowTime;
    rig.shutter.exposureSigma = vpVlpRig::uncalibratedExposure * rig.shutter.exposure;
    const YAML::Node readout = image["readout"] ? image["readout"]
                               : shutter        ? shutter["readout"]
                                                : YAML::Node();
    if (readout && readout.as<std::string>() == "columns") {
      rig.shutter.readout = vpRollingShutter::Readout::columns;
    }
    return rig;
  }

  vpLampMap map() const
  {
    vpLampMap map;
    for (const YAML::Node &node : m_set["lamps"]) {
      vpLamp lamp;
      lamp.id = node["id"].as<std::string>();
      const YAML::Node position = node["position_m"] ? node["position_m"] : node["position"];
      for (size_t i = 0; i < position.size(); ++i) {
        lamp.position(static_cast<Eigen::Index>(i)) = position[i].as<double>();
      }
      lamp.modulation.kind = vpModulation::Kind::pwm;
      lamp.modulation.frequency = node["frequency_hz"].as<double>();
      lamp.oscillatorPpm = number(node, "oscillator_ppm", lamp.oscillatorPpm);
      map.lamps.push_back(lamp);
    }
    return map;
  }

  //! Regions that have an id, and those of them that are the lamp of that id.
  struct Ids {
    size_t named = 0, right = 0;
  };

  //! \param within px, of the middle that is listed. \param altered Where this lies in an altered picture.
  Ids idsOf(const YAML::Node &image, const std::vector<vpLampObservation> &seen, double within,
            const std::function<Eigen::Vector2d(const Eigen::Vector2d &)> &altered) const
  {
    Ids ids;
    for (const vpLampObservation &lamp : seen) {
      ids.named += lamp.id.empty() ? 0 : 1;
    }
    for (const auto &listed : image["lamps_px"]) {
      const auto id = listed.first.as<std::string>();
      if (id == doesNotBlink) {
        continue;
      }
      const Eigen::Vector2d centre =
          altered(Eigen::Vector2d(listed.second[0].as<double>(), listed.second[1].as<double>()));
      for (const vpLampObservation &lamp : seen) {
        const bool same = lamp.id == id || lamp.id == "L" + id; // lumia-room lists lamps without their L
        ids.right += same && (lamp.outline.centre - centre).norm() < within ? 1 : 0;
      }
    }
    return ids;
  }

  //! Every lamp of the picture has its right id, and no region has another one.
  void expectIds(
      const YAML::Node &image, const std::vector<vpLampObservation> &seen, double within,
      const std::function<Eigen::Vector2d(const Eigen::Vector2d &)> &altered =
          [](const Eigen::Vector2d &centre) { return centre; }) const
  {
    const Ids ids = idsOf(image, seen, within, altered);
    EXPECT_EQ(ids.right, lampsIn(image)) << image["file"];
    EXPECT_EQ(ids.named, ids.right) << image["file"] << ": a region has an id that is not its own";
  }

private:
  static constexpr const char *doesNotBlink = "NONE"; // id of a listed lamp that is none of the map's

  static std::string environment()
  {
    const char *root = std::getenv("VLP_INPUT_IMAGE_PATH");
    return root != nullptr ? root : "";
  }

  static double number(const YAML::Node &node, const char *key, double otherwise)
  {
    return node && node[key] ? node[key].as<double>() : otherwise;
  }

  std::string m_folder;
  YAML::Node m_set;
  std::set<std::string> m_used;
};

//! Skips a test where the real pictures are not there.
#define VLP_REAL_SET(set, name)                                                                              \
  RealSet set(name);                                                                                         \
  if (!set.present()) {                                                                                      \
    GTEST_SKIP() << "real pictures used: 0 (VLP_INPUT_IMAGE_PATH is not set)";                               \
  }

#endif
