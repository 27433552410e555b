/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLocateOutputs.h"

#include <cmath>
#include <filesystem>
#include <iostream>
#include <system_error>
#include <vector>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpCsvTable.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_core/vpPoseText.h>
#include <visp3/vlp_evaluation/vpFixLog.h>
#include <visp3/vlp_sensor/vpWritePicture.h>

#include "common/vpVlpColours.h"

BEGIN_VISP_NAMESPACE

namespace
{
namespace fs = std::filesystem;

constexpr const char *seenHeader =
    "timestamp_s,file,lamp_id,u,v,diameter_px,frequency_hz,duty,confidence,accepted,symbols";

std::unique_ptr<vpAtomicFile> open(const std::string &name, const std::string &header)
{
  if (name.empty()) {
    return nullptr;
  }
  auto file = std::make_unique<vpAtomicFile>(name);
  file->stream() << header << "\n";
  return file;
}

//! Makes the folder where there is none, and tries whether a file can be written there.
void openFolder(const std::string &folder)
{
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw vpException(vpException::ioError, folder + ": the folder cannot be made: " + error.message());
  }
  const vpAtomicFile probe((fs::path(folder) / "overlay").string()); // gone again, since it is not committed
}

//! A number, or nothing where there is none.
std::string field(double value)
{
  return std::isfinite(value) ? vpNumberText(value) : std::string();
}

std::string listed(const std::vector<std::string> &fields)
{
  std::string text;
  for (size_t i = 0; i < fields.size(); ++i) {
    text += (i == 0 ? "" : ",") + vpCsvTable::field(fields[i]);
  }
  return text;
}

//! Frames of one name in two folders, or of a video, differ by their index.
std::string overlayName(const vpLocatedFrame &located)
{
  constexpr size_t digits = 6, longest = 100;
  const std::string index = std::to_string(located.index);
  return std::string(index.size() < digits ? digits - index.size() : 0, '0') + index + "-" +
         fs::path(located.frame.name).stem().string().substr(0, longest) + ".png";
}

//! TUM has no place for a second pose: where one explains the frame as well, the reader gets none.
bool isSure(const vpVlpFix &fix)
{
  return fix.valid && !fix.ambiguous;
}
} // namespace

vpLocateOutputs::vpLocateOutputs(const vpLocateOptions &options, const vpLampMap &map,
                                 std::function<int()> closed)
    : m_posesToStdout(options.posesToStdout()), m_overlay(options.overlay),
      m_poses(open(options.poses, vpTumHeader)), m_fixes(open(options.fixes, listed(vpFixLog::columns()))),
      m_seen(open(options.seen, seenHeader)), m_dashboard(map)
{
  if (options.display) {
    m_window = std::make_unique<vpVlpWindow>(std::move(closed));
  }
  if (!m_overlay.empty()) {
    openFolder(m_overlay);
  }
  if (m_posesToStdout) {
    std::cout << vpTumHeader << std::endl;
  }
}

void vpLocateOutputs::write(const vpLocatedFrame &located, const vpLedDetector &detector)
{
  writePose(located.location);
  if (m_posesToStdout) {
    std::cout.flush(); // whoever reads along has each pose at once
  }
  if (m_fixes) {
    writeFix(located);
  }
  if (m_seen) {
    writeSeen(located);
  }
  if (!m_overlay.empty() || m_window) {
    draw(located, detector);
  }
}

void vpLocateOutputs::commit()
{
  for (const auto &file : {&m_poses, &m_fixes, &m_seen}) {
    if (*file) {
      (*file)->commit();
    }
  }
}

std::ostream *vpLocateOutputs::poses()
{
  if (m_posesToStdout) {
    return &std::cout;
  }
  return m_poses ? &m_poses->stream() : nullptr;
}

//! Readers of TUM files take their times to rise, ours among them.
void vpLocateOutputs::writePose(const vpVlpLocation &location)
{
  std::ostream *stream = poses();
  if (stream == nullptr || !isSure(location.fix)) {
    return;
  }
  if (m_lastPose && location.timestamp <= *m_lastPose) {
    ++m_posesLeftOut;
    return;
  }
  *stream << vpTumRow(location.timestamp, location.fix.wMb) << "\n";
  m_lastPose = location.timestamp;
}

void vpLocateOutputs::writeFix(const vpLocatedFrame &located)
{
  const vpVlpFix &fix = located.location.fix;
  std::vector<std::string> fields(15);
  fields.front() = vpNumberText(located.location.timestamp);
  if (fix.valid) {
    const Eigen::Vector3d angles = vpRollPitchYaw(fix.wMb);
    const auto sigma = [&fix](int i) { return field(std::sqrt(fix.covariance(i, i))); };
    for (unsigned int i = 0; i < 3; ++i) {
      fields[1 + i] = field(fix.wMb[i][3]);
      fields[4 + i] = field(angles[i]);
      fields[7 + i] = sigma(static_cast<int>(i));
    }
    fields[10] = sigma(5);
    fields[11] = field(fix.covariance(0, 1));
    for (const std::string &id : fix.lamps) {
      fields[12] += (fields[12].empty() ? "" : ";") + id;
    }
  }
  fields[13] = vpStateOf(located.location);
  fields[14] = vpNumberText(located.compute);
  m_fixes->stream() << listed(fields) << "\n";
}

void vpLocateOutputs::writeSeen(const vpLocatedFrame &located)
{
  for (const vpLampObservation &lamp : located.location.observations) {
    m_seen->stream() << listed({vpNumberText(located.location.timestamp), located.frame.name, lamp.id,
                                field(lamp.point.x()), field(lamp.point.y()), field(lamp.outline.diameter()),
                                field(lamp.features.frequency), field(lamp.features.duty),
                                field(lamp.confidence), lamp.accepted ? "1" : "0", lamp.features.chips})
                     << "\n";
  }
}

void vpLocateOutputs::draw(const vpLocatedFrame &located, const vpLedDetector &detector)
{
  const cv::Mat picture =
      m_dashboard.draw(located.frame.I, located.location, located.compute,
                       vpLampChartsOf(located.frame.I, located.location.observations, detector));
  if (!m_overlay.empty()) {
    vpWritePicture((fs::path(m_overlay) / overlayName(located)).string(), picture);
  }
  if (m_window) {
    m_window->show(picture, "vlp-locate: " + located.frame.name);
  }
}

END_VISP_NAMESPACE
