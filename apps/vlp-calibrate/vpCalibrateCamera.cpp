/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>
#include <visp3/core/vpException.h>
#include <visp3/vlp_calibration/vpCameraCalibration.h>
#include <visp3/vlp_core/vpAtomicFile.h>
#include <visp3/vlp_core/vpCameraXml.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_sensor/vpWritePicture.h>

#include "common/vpCommandLine.h"
#include "common/vpTextBlock.h"
#include "vpCalibrate.h"
#include "vpCalibrationOutput.h"
#include "vpRunOptions.h"

BEGIN_VISP_NAMESPACE

namespace
{
using Model = vpCameraCalibration::Model;

const char *const cameraDescription =
    "Focal length, principal point and distortion from pictures of a flat board.\n";

const char *const cameraFooter = R"(
Examples:
  vlp-calibrate camera --board chessboard --size 9x6 --spacing 25 --print board.pdf
  vlp-calibrate camera --board chessboard --size 9x6 --spacing 25 --images 'board/%02d.png' --out camera
  vlp-calibrate camera --camera-info ros/camera_info.yaml --out camera

Print the board at 100 %, glue it on something flat, measure it. Take 15 pictures or more, the board tilted by 20 to 40
degrees to all sides and reaching the corners of the picture. A size counts inner corners, or circles.

Models: visp (default), u = u0 + px x (1 + kud r^2); perspective, without distortion; kannala-brandt, for wide
lenses; opencv, five coefficients, for camera_info.yaml alone, since ViSP has no such camera.

The folder --out gets camera.xml (ViSP), camera_info.yaml (ROS), residuals.png, report.txt.

Exit code: 0 done; 2 bad usage or bad input; 3 the pictures do not tell.
)";

struct CameraOptions {
  vpFrameOptions frames;
  std::string kind = "chessboard", size = "9x6", spacing = "25", model = "visp", name = "camera", info, print,
              out;
  vpBoard board;
  vpCameraCalibration calibration;

  bool parse(int argc, char **argv)
  {
    CLI::App app(cameraDescription, "vlp-calibrate camera");
    app.footer(cameraFooter);
    app.get_formatter()->column_width(28);
    vpAddChoice(app, "--board", kind, {"chessboard", "charuco", "circles"},
                "kind of the board (default chessboard)");
    vpAddName(app, "--size", size, "CxR", "inner corners, or circles, along both sides (default 9x6)");
    vpAddName(app, "--spacing", spacing, "MM", "side of a square, or from circle to circle (default 25)");
    vpAddName(app, "--print", print, "FILE", "write the board as a PDF in true size, and nothing else");
    frames.add(app);
    vpAddInput(app, "--camera-info", info, "FILE",
               "take a ROS camera_info YAML in place of pictures, and write camera.xml");
    vpAddChoice(app, "--model", model, {"visp", "perspective", "kannala-brandt", "opencv"},
                "of the camera (default visp)");
    vpAddName(app, "--name", name, "NAME", "of the camera in the files (default camera)");
    vpAddName(app, "--out", out, "DIR", "write camera.xml, camera_info.yaml, residuals.png, report.txt");
    if (!vpParseCommandLine(app, argc, argv)) {
      return false;
    }
    board.kind = kind == "charuco"   ? vpBoard::Kind::charuco
                 : kind == "circles" ? vpBoard::Kind::circles
                                     : vpBoard::Kind::chessboard;
    const size_t cross = size.find('x');
    double columns = 0, rows = 0;
    static const double most = 100;
    if (cross == std::string::npos || !vpParseNumber(size.substr(0, cross), columns) ||
        !vpParseNumber(size.substr(cross + 1), rows) || columns != std::floor(columns) ||
        rows != std::floor(rows) || !(std::min(columns, rows) >= 3 && std::max(columns, rows) <= most)) {
      vpBadInput("--size: " + vpShown(size) + ", expected two whole numbers from 3 to 100, as 9x6");
    }
    board.columns = static_cast<int>(columns);
    board.rows = static_cast<int>(rows);
    board.spacing = 0.001 * vpPositiveOption("--spacing", spacing);
    static const double largest = 1000; // mm
    if (board.spacing > 0.001 * largest) {
      vpBadInput("--spacing: " + spacing + ", expected millimetres, at most " + vpNumberText(largest));
    }
    calibration.model = model == "perspective"      ? Model::perspective
                        : model == "kannala-brandt" ? Model::kannalaBrandt
                        : model == "opencv"         ? Model::opencv
                                                    : Model::visp;
    if (!info.empty() && out.empty()) {
      vpBadInput("--camera-info: no --out, expected the folder for camera.xml");
    }
    if (print.empty() && info.empty()) {
      frames.check();
    }
    return true;
  }
};

//! All boards, and what the pictures are like.
struct Seen {
  std::vector<vpBoardSight> sights;
  unsigned int width = 0, height = 0;
  std::string otherSize; // of a board in the first picture without ours
};

//! Of a picture just taken: whether it shows the board, and how much of the picture all boards cover by now.
void tellCoverage(const Seen &seen)
{
  static const int across = 8, down = 6; // cells of the picture
  std::vector<bool> covered(static_cast<size_t>(across * down), false);
  for (const vpBoardSight &sight : seen.sights) {
    for (const auto &pixel : sight.pixels) {
      const int u = std::clamp(static_cast<int>(pixel.x * across / seen.width), 0, across - 1),
                v = std::clamp(static_cast<int>(pixel.y * down / seen.height), 0, down - 1);
      covered[static_cast<size_t>(v * across + u)] = true;
    }
  }
  spdlog::info("{}: {}; {:.0f} % of the picture covered so far", seen.sights.back().picture,
               seen.sights.back().pixels.empty() ? "no board" : "board found",
               100. * static_cast<double>(std::count(covered.begin(), covered.end(), true)) /
                   static_cast<double>(covered.size()));
}

Seen look(const CameraOptions &options)
{
  Seen seen;
  for (const std::unique_ptr<vpFrameSource> &source : options.frames.open()) {
    vpForEachFrame(*source, options.frames.name(), [&](const vpVlpFrame &frame) {
      if (seen.width != 0 && (frame.I.getWidth() != seen.width || frame.I.getHeight() != seen.height)) {
        throw vpException(vpException::dimensionError,
                          std::to_string(frame.I.getWidth()) + " x " + std::to_string(frame.I.getHeight()) +
                              ", expected " + std::to_string(seen.width) + " x " +
                              std::to_string(seen.height) + ", the size of the first picture");
      }
      seen.width = frame.I.getWidth();
      seen.height = frame.I.getHeight();
      seen.sights.push_back(options.board.find(frame.I, frame.name));
      if (!options.frames.camera.uri.empty()) {
        tellCoverage(seen);
      }
      if (seen.sights.back().pixels.empty() && seen.otherSize.empty() &&
          options.board.kind == vpBoard::Kind::chessboard) {
        seen.otherSize = options.board.sizeShown(frame.I);
      }
    });
  }
  return seen;
}

std::string shortName(const std::string &picture)
{
  return std::filesystem::path(picture).filename().string();
}

std::string cameraText(const vpCameraEstimate &found, const Seen &seen)
{
  vpReportTable table;
  table.heading = "Camera";
  table.columns = {"", "value", "standard deviation"};
  for (size_t i = 0; i < found.names.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    table.rows.push_back({found.names[i], vpFormat(i < 4 ? "%.3f" : "%.5f", found.values(k)),
                          vpFormat(i < 4 ? "%.3f" : "%.5f", std::sqrt(found.covariance(k, k)))});
  }
  vpReportTable views;
  views.heading = "Pictures";
  views.columns = {"picture", "error, px rms", "tilt, deg", ""};
  for (const vpCalibratedView &view : found.views) {
    views.rows.push_back({shortName(view.picture), vpFormat("%.3f", view.rms),
                          vpFormat("%.0f", view.tilt * 180 / M_PI),
                          view.used ? "" : "left out: far off the others"});
  }
  for (const vpBoardSight &sight : seen.sights) {
    if (sight.pixels.empty()) {
      views.rows.push_back({shortName(sight.picture), "", "", "no board"});
    }
  }
  return table.text() + "\n" + views.text() +
         vpFormat("\n%.3f px rms; points in %.0f %% of the picture\n", found.rms, 100 * found.coverage);
}

void write(const CameraOptions &options, const vpCameraEstimate &found, const Seen &seen,
           const std::string &text)
{
  const vpCalibrationFolder folder(options.out);
  // What may be refused comes first.
  if (options.calibration.model == Model::opencv) {
    if (std::ifstream(folder / "camera.xml")) {
      throw vpException(vpException::ioError,
                        (folder / "camera.xml") +
                            ": of another calibration, which would stay beside this one; "
                            "expected another folder as --out");
    }
    spdlog::warn("no camera.xml: ViSP has no camera of OpenCV's model; --model visp has one");
  } else {
    vpCameraXml{options.name, found.camera, seen.width, seen.height}.save(folder / "camera.xml");
  }
  std::vector<vpDrawnResidual> drawn;
  for (size_t i = 0; i < found.views.size(); ++i) {
    for (size_t k = 0; k < found.views[i].points.size(); ++k) {
      drawn.push_back({found.views[i].points[k], found.views[i].residuals[k], i, found.views[i].used});
    }
  }
  vpWritePicture(folder / "residuals.png",
                 vpResidualPicture(cv::Size(static_cast<int>(seen.width), static_cast<int>(seen.height)),
                                   drawn, "camera"));
  folder.write("report.txt", text);
  folder.write("camera_info.yaml",
               vpCameraInfoYaml(found, options.calibration.model, options.name, seen.width, seen.height));
}
} // namespace

vpExitCode vpCalibrateCamera(int argc, char **argv)
{
  CameraOptions options;
  if (!options.parse(argc, argv)) {
    return vpExitCode::done;
  }
  if (!options.print.empty()) {
    vpAtomicFile file(options.print);
    file.stream() << options.board.pdf();
    file.commit();
    spdlog::info(options.print + ": print it at 100 %, then measure the line below the board");
    return vpExitCode::done;
  }
  if (!options.info.empty()) {
    const vpCameraXml camera = vpCameraFromInfo(options.info);
    const vpCalibrationFolder folder(options.out);
    camera.save(folder / "camera.xml");
    spdlog::info("{}: camera.xml of {}", options.out, camera.name);
    return vpExitCode::done;
  }
  const Seen seen = look(options);
  const vpCameraEstimate found = options.calibration.solve(seen.sights, seen.width, seen.height);
  if (!found.valid) {
    const bool other = !seen.otherSize.empty() && seen.otherSize != options.board.size() &&
                       std::all_of(seen.sights.begin(), seen.sights.end(),
                                   [](const vpBoardSight &sight) { return sight.pixels.empty(); });
    spdlog::error(other
                      ? "no picture shows a chessboard of " + options.board.size() +
                            " inner corners; one of " + seen.otherSize + " is there: --size " + seen.otherSize
                      : found.refusal);
    return vpExitCode::nothingFound;
  }
  const std::string text = cameraText(found, seen);
  std::cout << text;
  static const double littleCoverage = 0.6;
  if (found.coverage < littleCoverage) {
    spdlog::warn("the board covers {:.0f} % of the picture: distortion beyond is a guess; fill the corners",
                 100 * found.coverage);
  }
  if (!options.out.empty()) {
    write(options, found, seen, text);
  }
  return vpExitCode::done;
}

END_VISP_NAMESPACE
