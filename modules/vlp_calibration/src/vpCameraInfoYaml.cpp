/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_calibration/vpCameraCalibration.h>

#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_core/vpYamlNode.h>

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

END_VISP_NAMESPACE
