/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_calibration/vpCameraCalibration.h>

#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_core/vpYamlNode.h>

#include "vpCameraOf.h"

BEGIN_VISP_NAMESPACE

std::string vpCameraInfoYaml(const vpCameraEstimate &estimate, vpCameraCalibration::Model model,
                             const std::string &name, unsigned int width, unsigned int height)
{
  using Model = vpCameraCalibration::Model;
  const Eigen::VectorXd &p = estimate.values;
  const auto row = [](const std::vector<double> &values) {
    std::string text;
    for (const double value : values) {
      text += (text.empty() ? "" : ", ") + vpNumberText(value);
    }
    return text;
  };
  std::vector<double> distortion(5, 0.0);
  if (model == Model::kannalaBrandt) {
    distortion = {p(4), p(5), p(6), p(7)};
  } else {
    for (Eigen::Index i = 4; i < p.size(); ++i) {
      distortion[static_cast<size_t>(i - 4)] = p(i);
    }
  }
  const auto matrix = [&](const std::string &key, int rows, int columns, const std::vector<double> &values) {
    return key + ":\n  rows: " + std::to_string(rows) + "\n  cols: " + std::to_string(columns) +
           "\n  data: [" + row(values) + "]\n";
  };
  return "image_width: " + std::to_string(width) + "\nimage_height: " + std::to_string(height) +
         "\ncamera_name: " + vpYamlNode::quoted(name) + "\n" +
         matrix("camera_matrix", 3, 3, {p(0), 0, p(2), 0, p(1), p(3), 0, 0, 1}) +
         "distortion_model: " + (model == Model::kannalaBrandt ? "equidistant" : "plumb_bob") + "\n" +
         matrix("distortion_coefficients", 1, static_cast<int>(distortion.size()), distortion) +
         matrix("rectification_matrix", 3, 3, {1, 0, 0, 0, 1, 0, 0, 0, 1}) +
         matrix("projection_matrix", 3, 4, {p(0), 0, p(2), 0, 0, p(1), p(3), 0, 0, 0, 1, 0});
}

vpCameraXml vpCameraFromInfo(const std::string &filename)
{
  using Model = vpCameraCalibration::Model;
  const vpYamlNode info = vpYamlNode::load(filename);
  vpCameraXml entry;
  entry.name = info.text("camera_name");
  entry.width = info.wholeNumber("image_width", 1);
  entry.height = info.wholeNumber("image_height", 1);
  const vpYamlNode matrix = info.mapping("camera_matrix");
  const std::vector<double> K = matrix.numbers("data", 9);
  if (!(K[0] > 0 && K[4] > 0) || K[1] != 0 || K[3] != 0 || K[6] != 0 || K[7] != 0 || K[8] != 1) {
    matrix.fail("data", "no camera matrix, expected fx, 0, cx, 0, fy, cy, 0, 0, 1 with fx and fy above 0");
  }
  const bool equidistant = info.choice("distortion_model", {"plumb_bob", "equidistant"}) == 1;
  const vpYamlNode distortion = info.mapping("distortion_coefficients");
  const std::vector<double> d = distortion.numbers("data", equidistant ? 4 : 5);
  if (equidistant) {
    Eigen::VectorXd p(8);
    p << K[0], K[4], K[2], K[5], d[0], d[1], d[2], d[3];
    entry.camera = vpCameraOf(Model::kannalaBrandt, p, entry.width, entry.height);
    return entry;
  }
  if (d[1] != 0 || d[2] != 0 || d[3] != 0 || d[4] != 0) {
    distortion.fail("data",
                    "k2, p1, p2 or k3 is not 0, expected k1 alone: ViSP has no such camera; calibrate it "
                    "by vlp-calibrate camera, a wide lens with --model kannala-brandt");
  }
  Eigen::VectorXd p(5);
  p << K[0], K[4], K[2], K[5], d[0];
  entry.camera = vpCameraOf(d[0] == 0 ? Model::perspective : Model::visp, p, entry.width, entry.height);
  return entry;
}

END_VISP_NAMESPACE
