/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_core/vpVlpRig.h>

#include <cmath>
#include <filesystem>

#include <visp3/core/vpException.h>
#include <visp3/core/vpRotationMatrix.h>
#include <visp3/core/vpRzyxVector.h>
#include <visp3/vlp_core/vpAtomicFile.h>
#include <visp3/vlp_core/vpCameraXml.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_core/vpYamlNode.h>

BEGIN_VISP_NAMESPACE

namespace
{
using Range = vpYamlNode::Range;
using Readout = vpRollingShutter::Readout;
using Method = vpPictureResize::Method;

//! In the order of vpRollingShutter::Readout.
const std::vector<std::string> readoutNames = {"rows", "rows_reversed", "columns", "columns_reversed"};
std::string cameraPath(const std::string &rigFile, const std::string &cameraFile)
{
  return (std::filesystem::path(rigFile).parent_path() / cameraFile).string();
}

void readCamera(const vpYamlNode &node, vpVlpRig &rig)
{
  rig.cameraFile = node.text("file");
  rig.cameraName = node.text("name");
  if (node.has("principal_point_sigma_px")) {
    rig.principalPointSigma = node.number("principal_point_sigma_px", Range::notNegative);
  }
  if (node.has("focal_length_sigma")) {
    rig.focalLengthSigma = node.number("focal_length_sigma", Range::notNegative);
  }
  node.finish();
  vpCameraXml entry;
  try {
    entry = vpCameraXml::load(cameraPath(node.filename(), rig.cameraFile), rig.cameraName);
  } catch (const vpException &error) {
    if (error.getCode() == vpException::ioError) { // say also who asked for that file
      node.fail("file", error.getStringMessage());
    }
    throw;
  }
  rig.camera = entry.camera;
  rig.width = entry.width;
  rig.height = entry.height;
}

void readShutter(const vpYamlNode &node, vpRollingShutter &shutter)
{
  shutter.rowTime = node.number("row_time_s", Range::positive);
  static const double longest = 0.01; // s: a picture of 480 lines would take five seconds
  if (shutter.rowTime > longest) {
    node.fail("row_time_s",
              vpNumberText(shutter.rowTime) + ", expected seconds, up to " + vpNumberText(longest));
  }
  shutter.rowTimeSigma =
      node.number("row_time_sigma_s", Range::notNegative, vpVlpRig::uncalibratedRowTime * shutter.rowTime);
  shutter.exposure = node.number("exposure_s", Range::positive);
  shutter.exposureSigma =
      node.number("exposure_sigma_s", Range::notNegative, vpVlpRig::uncalibratedExposure * shutter.exposure);
  shutter.readout = static_cast<Readout>(node.choice("readout", readoutNames));
  node.finish();
}

void readResize(const vpYamlNode &node, vpVlpRig &rig)
{
  rig.resize.method = node.choice("method", {"nearest", "area"}) == 0 ? Method::nearest : Method::area;
  const std::vector<double> size = node.numbers("source_size", 2, Range::positive);
  const std::string came = "[" + vpNumberText(size[0]) + ", " + vpNumberText(size[1]) + "]";
  constexpr double most = 100000;
  if (size[0] != std::floor(size[0]) || size[1] != std::floor(size[1]) || size[0] > most || size[1] > most) {
    node.fail("source_size", came + ", expected two whole numbers up to " + vpNumberText(most));
  }
  rig.resize.sourceWidth = static_cast<unsigned int>(size[0]);
  rig.resize.sourceHeight = static_cast<unsigned int>(size[1]);
  if (rig.resize.sourceWidth < rig.width || rig.resize.sourceHeight < rig.height) {
    node.fail("source_size", came + ", expected at least the size of the picture as delivered, [" +
                                 std::to_string(rig.width) + ", " + std::to_string(rig.height) + "]");
  }
  node.finish();
}

//! Rotations about the fixed axes x, y, z, in this order: R = Rz(yaw) Ry(pitch) Rx(roll).
void readMount(const vpYamlNode &node, vpVlpRig &rig)
{
  const std::vector<double> translation = node.numbers("translation_m", 3);
  const std::vector<double> rotation = node.numbers("rotation_rpy_deg", 3);
  rig.bMc =
      vpHomogeneousMatrix(vpTranslationVector(translation[0], translation[1], translation[2]),
                          vpRotationMatrix(vpRzyxVector(rotation[2] * M_PI / 180, rotation[1] * M_PI / 180,
                                                        rotation[0] * M_PI / 180)));
  if (node.has("translation_sigma_m")) {
    const std::vector<double> sigma = node.numbers("translation_sigma_m", 3, Range::notNegative);
    rig.translationSigma = Eigen::Vector3d(sigma[0], sigma[1], sigma[2]);
  }
  if (node.has("rotation_sigma_deg")) {
    const std::vector<double> sigma = node.numbers("rotation_sigma_deg", 3, Range::notNegative);
    rig.rotationSigma = Eigen::Vector3d(sigma[0], sigma[1], sigma[2]) * M_PI / 180;
  }
  node.finish();
}

std::string triple(const std::string &x, const std::string &y, const std::string &z)
{
  return "[" + x + ", " + y + ", " + z + "]";
}

std::string mountText(const vpVlpRig &rig)
{
  vpRotationMatrix R;
  rig.bMc.extract(R);
  const vpRzyxVector zyx(R);
  const Eigen::Vector3d &t = rig.translationSigma, &r = rig.rotationSigma;
  std::string text =
      "translation_m: " +
      triple(vpNumberText(rig.bMc[0][3]), vpNumberText(rig.bMc[1][3]), vpNumberText(rig.bMc[2][3])) +
      ", rotation_rpy_deg: " + triple(vpDegreesText(zyx[2]), vpDegreesText(zyx[1]), vpDegreesText(zyx[0]));
  if (!t.isZero(0)) {
    text += ", translation_sigma_m: " + triple(vpNumberText(t.x()), vpNumberText(t.y()), vpNumberText(t.z()));
  }
  if (!r.isZero(0)) {
    text +=
        ", rotation_sigma_deg: " + triple(vpDegreesText(r.x()), vpDegreesText(r.y()), vpDegreesText(r.z()));
  }
  return text;
}

std::string rigText(const vpVlpRig &rig)
{
  const vpRollingShutter &shutter = rig.shutter;
  std::string text = "camera: {file: " + vpYamlNode::quoted(rig.cameraFile) +
                     ", name: " + vpYamlNode::quoted(rig.cameraName);
  if (rig.principalPointSigma) {
    text += ", principal_point_sigma_px: " + vpNumberText(*rig.principalPointSigma);
  }
  if (rig.focalLengthSigma) {
    text += ", focal_length_sigma: " + vpNumberText(*rig.focalLengthSigma);
  }
  text += "}\n";
  text += "shutter: {row_time_s: " + vpNumberText(shutter.rowTime) +
          ", row_time_sigma_s: " + vpNumberText(shutter.rowTimeSigma) +
          ", exposure_s: " + vpNumberText(shutter.exposure) +
          ", exposure_sigma_s: " + vpNumberText(shutter.exposureSigma) +
          ", readout: " + readoutNames[static_cast<size_t>(shutter.readout)] + "}\n";
  if (rig.resize.method != Method::none) {
    text += std::string("resize: {method: ") + (rig.resize.method == Method::nearest ? "nearest" : "area") +
            ", source_size: [" + std::to_string(rig.resize.sourceWidth) + ", " +
            std::to_string(rig.resize.sourceHeight) + "]}\n";
  }
  return text + "mount: {" + mountText(rig) + "}\n";
}
} // namespace

vpVlpRig vpVlpRig::load(const std::string &filename)
{
  const vpYamlNode top = vpYamlNode::load(filename);
  vpVlpRig rig;
  readCamera(top.mapping("camera"), rig);
  readShutter(top.mapping("shutter"), rig.shutter);
  if (top.has("resize")) {
    readResize(top.mapping("resize"), rig);
  }
  if (top.has("mount")) {
    readMount(top.mapping("mount"), rig);
  }
  top.finish();
  return rig;
}

void vpVlpRig::save(const std::string &filename) const
{
  vpAtomicFile file(filename);
  file.stream() << rigText(*this);
  vpCameraXml{cameraName, camera, width, height}.save(cameraPath(filename, cameraFile));
  file.commit();
}

END_VISP_NAMESPACE
