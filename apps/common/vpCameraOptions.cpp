/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "common/vpCameraOptions.h"

#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpPrintable.h>
#include <visp3/vlp_sensor/vpCameraSource.h>
#include <visp3/vlp_sensor/vpPictureSequence.h>
#include <visp3/vlp_sensor/vpResizedSource.h>

#include "common/vpCommandLine.h"
#include "common/vpInterrupt.h"

BEGIN_VISP_NAMESPACE

void vpCameraOptions::add(CLI::App &app)
{
  vpAddName(app, "--camera", uri, "URI",
            "frames from a camera, live: aravis://NAME, v4l2:///dev/video0, uvc://VID:PID, mindvision://");
  app.add_option("--camera-exposure", exposure, "of the camera, s; default: the rig's")->type_name("S");
  app.add_option("--camera-gain", gain, "of the camera, in its own unit; default: as it is")->type_name("G");
  app.add_option("--camera-rate", rate, "frames a second of the camera; default: as it is")->type_name("HZ");
}

void vpCameraOptions::check() const
{
  if (uri.empty() && (exposure || gain || rate)) {
    throw vpException(vpException::badValue, std::string(exposure ? "--camera-exposure"
                                                         : gain   ? "--camera-gain"
                                                                  : "--camera-rate") +
                                                 ": of no camera, expected --camera too");
  }
}

std::unique_ptr<vpFrameSource> vpCameraOptions::open(const vpVlpRig &rig,
                                                     const std::function<bool()> &stop) const
{
  std::error_code ignored;
  if (!vpCameraSource::isUri(uri) && std::filesystem::is_directory(uri, ignored)) {
    return std::make_unique<vpPictureSequence>(vpPictureSequence::fromRun(uri));
  }
  const bool resized = rig.resize.method != vpPictureResize::Method::none;
  vpCameraSettings settings;
  settings.exposure = exposure;
  if (!exposure && rig.shutter.exposure > 0) {
    settings.exposure = rig.shutter.exposure;
  }
  settings.gain = gain;
  settings.frameRate = rate;
  if (rig.width > 0) {
    settings.region = vpCameraRegion{0, 0, resized ? rig.resize.sourceWidth : rig.width,
                                     resized ? rig.resize.sourceHeight : rig.height};
  }
  vpCameraPatience patience;
  patience.stop = [stop] { return vpInterrupt::requested() || (stop && stop()); };
  auto camera = std::make_unique<vpCameraSource>(uri, settings, patience);
  const vpCameraSettings now = camera->settings();
  if (now.exposure) {
    spdlog::info("{}: exposed for {:.4g} us{}", uri, 1e6 * *now.exposure,
                 now.gain ? ", gain " + std::to_string(*now.gain) : "");
  }
  return std::make_unique<vpResizedSource>(std::move(camera), rig);
}

vpExitCode vpCameraOptions::list()
{
  std::vector<std::string> missing;
  const std::vector<vpCameraDescription> cameras = vpCameraSource::list(missing);
  for (const vpCameraDescription &camera : cameras) {
    std::printf("%s\n  %s\n  %s\n", vpPrintable(camera.uri).c_str(), vpPrintable(camera.name).c_str(),
                vpPrintable(camera.abilities).c_str());
  }
  for (const std::string &line : missing) {
    spdlog::info(line);
  }
  if (cameras.empty()) {
    spdlog::warn("no camera found");
  }
  return cameras.empty() ? vpExitCode::nothingFound : vpExitCode::done;
}

END_VISP_NAMESPACE
