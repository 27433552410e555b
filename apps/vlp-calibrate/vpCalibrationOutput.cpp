/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpCalibrationOutput.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <system_error>

#include <opencv2/imgproc.hpp>
#include <spdlog/spdlog.h>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpAtomicFile.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_core/vpPoseText.h>

#include "common/vpTextBlock.h"

BEGIN_VISP_NAMESPACE

namespace
{
namespace fs = std::filesystem;

//! Of a group, bright enough on a dark ground.
cv::Scalar colourOf(size_t group)
{
  static const cv::Scalar colours[] = {{90, 230, 60},   {0, 225, 255},  {235, 150, 80},  {100, 165, 255},
                                       {220, 110, 220}, {210, 210, 90}, {140, 140, 255}, {90, 200, 150}};
  return colours[group % (sizeof(colours) / sizeof(colours[0]))];
}

//! 1, 2 or 5 times a power of ten, at most \e value.
double rounded(double value)
{
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double digit : {5.0, 2.0}) {
    if (value >= digit * power) {
      return digit * power;
    }
  }
  return power;
}
} // namespace

cv::Mat vpResidualPicture(cv::Size size, const std::vector<vpDrawnResidual> &residuals,
                          const std::string &title)
{
  const double zoom = std::max(1.0, 800.0 / size.width), unit = size.width * zoom / 800;
  const int head = static_cast<int>(40 * unit);
  cv::Mat picture(static_cast<int>(size.height * zoom) + head, static_cast<int>(size.width * zoom), CV_8UC3,
                  cv::Scalar(30, 26, 24));
  double squares = 0;
  size_t used = 0;
  for (const vpDrawnResidual &drawn : residuals) {
    squares += drawn.used ? drawn.residual.squaredNorm() : 0;
    used += drawn.used ? 1 : 0;
  }
  const double rms = used > 0 ? std::sqrt(squares / static_cast<double>(2 * used)) : 0;
  static const double length = 20; // px of 800, of the RMS residual
  const double times = rounded(length / std::max(rms, 1e-4));
  const auto at = [&](const Eigen::Vector2d &point) {
    static const int shift = 4; // fixed point
    return cv::Point(static_cast<int>(std::lround((point.x() + 0.5) * zoom * (1 << shift))),
                     static_cast<int>(std::lround(((point.y() + 0.5) * zoom + head) * (1 << shift))));
  };
  for (const vpDrawnResidual &drawn : residuals) {
    const cv::Scalar colour = drawn.used ? colourOf(drawn.group) : cv::Scalar(120, 120, 120);
    const double longest = 200 * length; // px: an outlier's line goes over the edge, no farther
    const Eigen::Vector2d way =
        drawn.residual * std::min(times, longest / std::max(drawn.residual.norm(), 1e-9));
    cv::line(picture, at(drawn.point), at(drawn.point + way / zoom * unit), colour, 1, cv::LINE_AA, 4);
    cv::circle(picture, at(drawn.point), static_cast<int>(24 * unit), colour, cv::FILLED, cv::LINE_AA, 4);
  }
  cv::rectangle(picture, cv::Rect(0, 0, picture.cols, head), cv::Scalar(60, 52, 48), cv::FILLED);
  vpDrawText(picture, title + vpFormat(": %zu points, %.3f px rms, drawn %g times as long", used, rms, times),
             cv::Point(static_cast<int>(10 * unit), static_cast<int>(26 * unit)), unit,
             cv::Scalar(240, 240, 240));
  return picture;
}

std::vector<vpDrawnResidual> vpResidualsOf(const vpBundleResult &result)
{
  std::vector<vpDrawnResidual> drawn;
  for (const vpBundleResidual &residual : result.residuals) {
    drawn.push_back({residual.point, residual.residual, residual.lamp, residual.used});
  }
  return drawn;
}

vpReportTable vpRigTable(const vpBundleResult &result, const vpRigVector &priors)
{
  vpReportTable table;
  table.heading = "Rig";
  table.columns = {"", "value", "from the first guess", "standard deviation", ""};
  const Eigen::Vector3d angles = vpRollPitchYaw(result.rig.bMc);
  vpRigVector values;
  values << result.rig.bMc[0][3], result.rig.bMc[1][3], result.rig.bMc[2][3], angles,
      result.rig.camera.get_u0(), result.rig.camera.get_v0(), result.rig.camera.get_px();
  for (int i = 0; i < vpRigParameterCount; ++i) {
    const vpRigParameterInfo &info = vpRigParameterInfo::all()[static_cast<size_t>(i)];
    const bool focal = info.name == "focal";
    const double sigma = std::sqrt(std::max(0.0, result.rigCovariance(i, i)));
    const bool held = !(priors(i) > 0);
    table.rows.push_back({info.name + (focal ? ", px" : ", " + info.unit),
                          vpFormat("%.4f", (focal ? 1 : info.shown) * values(i)),
                          held ? "" : vpFormat("%+.4f %s", info.shown * result.step(i), focal ? "%" : ""),
                          held ? "" : vpFormat("%.4f %s", info.shown * sigma, focal ? "%" : ""),
                          held                       ? "held"
                          : std::isfinite(priors(i)) ? "with a prior"
                                                     : ""});
  }
  table.note =
      "roll, pitch, yaw: the value as in rig.yaml, about the fixed axes; the step about x, y, z of the base.";
  return table;
}

void vpWarnOfInflatedMap(const vpBundleResult &result, const vpLampMap &map)
{
  if (result.inflatedLamps.empty()) {
    return;
  }
  const auto offset = [&](size_t lamp) {
    return (result.map.lamps[lamp].position - map.lamps[lamp].position).norm();
  };
  const size_t farthest = *std::max_element(result.inflatedLamps.begin(), result.inflatedLamps.end(),
                                            [&](size_t a, size_t b) { return offset(a) < offset(b); });
  spdlog::warn(
      "lamps that hang exactly where position_m has them do not explain the pictures: each was taken "
      "for {:.1f} mm uncertain; {} is farthest off, by {:.1f} mm. Measure again, or give a "
      "position_sigma_m",
      1000 * result.inflatedLampSigma, map.lamps[farthest].id, 1000 * offset(farthest));
}

std::string vpCovarianceCsv(const vpBundleResult &result)
{
  std::string text = "parameter";
  for (const vpRigParameterInfo &info : vpRigParameterInfo::all()) {
    text += "," + info.name;
  }
  text += "\n";
  for (int i = 0; i < vpRigParameterCount; ++i) {
    text += vpRigParameterInfo::all()[static_cast<size_t>(i)].name;
    for (int k = 0; k < vpRigParameterCount; ++k) {
      text += "," + vpNumberText(result.rigCovariance(i, k));
    }
    text += "\n";
  }
  return text;
}

vpCalibrationFolder::vpCalibrationFolder(const std::string &folder) : m_folder(folder)
{
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw vpException(vpException::ioError, folder + ": the folder cannot be made: " + error.message());
  }
}

void vpCalibrationFolder::check(const std::string &folder, const std::vector<std::string> &inputs)
{
  for (const std::string &input : inputs) {
    const fs::path written = fs::path(folder) / fs::path(input).filename();
    std::error_code none; // of a file that is not there
    if (!folder.empty() && !input.empty() && fs::equivalent(written, input, none)) {
      throw vpException(vpException::badValue, "--out: " + folder + ", whose " + written.filename().string() +
                                                   " is an input, expected another folder");
    }
  }
}

std::string vpCalibrationFolder::operator/(const std::string &name) const
{
  return (fs::path(m_folder) / name).string();
}

void vpCalibrationFolder::write(const std::string &name, const std::string &text) const
{
  vpAtomicFile file(*this / name);
  file.stream() << text;
  file.commit();
}

void vpCalibrationFolder::writeRig(vpVlpRig rig) const
{
  rig.cameraFile = "camera.xml";
  rig.save(*this / "rig.yaml");
}

END_VISP_NAMESPACE
