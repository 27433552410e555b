/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Lamps of the real pictures: found, with their outlines where set.yaml says they are.

#include <cstdlib>
#include <iostream>
#include <numeric>

#include <gtest/gtest.h>
#include <visp3/vlp_detection/vpOutlineFitter.h>
#include <visp3/vlp_sensor/vpReadGreyPicture.h>
#include <yaml-cpp/yaml.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{

std::vector<vpLampOutline> outlines(const std::string &file)
{
  vpImage<unsigned char> I;
  vpReadGreyPicture(file, I);
  const vpLinePicture picture(I, false);
  std::vector<double> lines(picture.grey.rows), samples(picture.grey.cols);
  std::iota(lines.begin(), lines.end(), 0.0);
  std::iota(samples.begin(), samples.end(), 0.0);
  std::vector<vpLampOutline> found;
  for (const vpLedRoi &roi : vpLedRoiDetector().detect(picture.grey)) {
    found.push_back(vpOutlineFitter().fit(picture.grey, lines, samples, roi).outline);
  }
  return found;
}

TEST(RealPictures, Ub300CentresWithinOnePixelAndAHalf)
{
  const char *folder = std::getenv("VLP_INPUT_IMAGE_PATH");
  if (folder == nullptr) {
    std::cout << "real pictures used: 0 (VLP_INPUT_IMAGE_PATH is not set)\n";
    return;
  }
  const std::string set = std::string(folder) + "/ub300/";
  int pictures = 0;
  for (const YAML::Node &image : YAML::LoadFile(set + "set.yaml")["images"]) {
    const auto file = image["file"].as<std::string>();
    const auto found = outlines(set + file);
    EXPECT_EQ(found.size(), image["lamps_px"].size()) << file;
    for (const auto &lamp : image["lamps_px"]) {
      const Eigen::Vector2d centre(lamp.second[0].as<double>(), lamp.second[1].as<double>());
      double nearest = 1e9;
      for (const vpLampOutline &outline : found) {
        nearest = std::min(nearest, (outline.centre - centre).norm());
      }
      EXPECT_LT(nearest, 1.5) << file << ", lamp " << lamp.first.as<std::string>();
    }
    ++pictures;
  }
  std::cout << "real pictures used: " << pictures << "\n";
}

} // namespace
