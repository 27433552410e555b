/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <filesystem>
#include <string>
#include <vector>

#include <visp3/core/vpException.h>

#include "luminaires/vpEmissionPattern.h"
#include "real/realSet.h"

BEGIN_VISP_NAMESPACE
namespace
{
struct Source {
  const char *family, *set;
  int reach;     // px, farther than any of its lamps reaches
  double middle; // px, standard deviation of its hand-measured centres
};

const Source sources[] = {{"ub300", "ub300", 60, 1},
                          {"lumia-room", "lumia-room", 130, 3},
                          {"lumia-floor", "lumia-floor", 105, 1},
                          {"lumia-floor", "lumia-floor-2", 105, 1},
                          {"chandelier", "chandelier", 64, 3}};

void take(const Source &source, RealSet &set, const YAML::Node &image,
          std::vector<vpEmissionPattern> &patterns)
{
  const vpVlpFrame frame = set.frame(image);
  const vpRollingShutter shutter = set.rig(image, frame).shutter;
  const vpLampMap map = set.map();
  vpStripedLamp lamp;
  cv::Mat(static_cast<int>(frame.I.getHeight()), static_cast<int>(frame.I.getWidth()), CV_8U, frame.I.bitmap)
      .convertTo(lamp.grey, CV_32F);
  if (shutter.alongColumns()) {
    lamp.grey = lamp.grey.t();
  }
  lamp.reach = source.reach;
  for (const auto &listed : image["lamps_px"]) {
    const auto id = listed.first.as<std::string>();
    const vpLamp *known = map.find(id) != nullptr ? map.find(id) : map.find("L" + id);
    const std::string name = std::string(source.set) + "/" + frame.name + "/" + id;
    if (known == nullptr) {
      continue; // one that does not blink, or does not work
    }
    lamp.middle = {listed.second[0].as<double>(), listed.second[1].as<double>()};
    if (shutter.alongColumns()) {
      std::swap(lamp.middle.x(), lamp.middle.y());
    }
    lamp.period = 1 / (known->modulation.frequency * shutter.rowTime);
    patterns.push_back(vpTakePattern(lamp));
    patterns.back().name = name;
    patterns.back().middleSigma = source.middle;
  }
}
} // namespace

std::vector<vpLuminaireFamily> vpRealFamilies(const std::string &folder)
{
  std::vector<vpLuminaireFamily> families;
  for (const Source &source : sources) {
    if (!std::filesystem::exists(std::filesystem::path(folder) / source.set / "set.yaml")) {
      continue;
    }
    if (families.empty() || families.back().name != source.family) {
      families.push_back({source.family, {}});
    }
    RealSet set(source.set, folder);
    for (const YAML::Node &image : set.images()) {
      take(source, set, image, families.back().patterns);
    }
  }
  if (families.empty()) {
    throw vpException(vpException::ioError,
                      folder +
                          ": no folder ub300, lumia-room, lumia-floor or chandelier with a set.yaml in it");
  }
  return families;
}

END_VISP_NAMESPACE
