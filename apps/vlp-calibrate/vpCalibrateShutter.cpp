/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpCalibrate.h"

#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>
#include <visp3/core/vpException.h>
#include <visp3/vlp_calibration/vpShutterCalibration.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_evaluation/vpReportTable.h>

#include "common/vpCommandLine.h"
#include "common/vpFrameOptions.h"
#include "common/vpTextBlock.h"
#include "vpCalibrationOutput.h"
#include "vpRunOptions.h"

BEGIN_VISP_NAMESPACE

namespace
{
const char *const shutterDescription =
    "Row time and effective exposure of a rolling shutter from lamps of known frequency.\n";

const char *const shutterFooter = R"(
Examples:
  vlp-calibrate shutter --image lamp.png --frequency 1000
  vlp-calibrate shutter --run recorded --out calibrated
  vlp-calibrate shutter --images 'frames/%04d.png' --rig rig.yaml --lamps lamps.yaml --out calibrated

Lines may be rows or columns: the pictures show which. Which end of the picture is read first they do not show:
the rig's word on it stays. --frequency: all that blinks in the pictures is a lamp of that frequency. --lamps: lamps
are told apart by their frequencies, whatever the row time is. Without a rig the picture is taken as the sensor
delivers it; pictures that software resized need the rig's `resize`, since their lines are not one row time apart.
The exposure is what makes the stripes' edges as soft as they are: that of the sensor, and what lens and tone
curve add.

Exit code: 0 done; 2 bad usage or bad input; 3 the pictures do not show it.
)";

struct ShutterOptions {
  vpFrameOptions frames;
  std::string rig, lamps, out, frequency, ppm;

  bool parse(int argc, char **argv)
  {
    CLI::App app(shutterDescription, "vlp-calibrate shutter");
    app.footer(shutterFooter);
    app.get_formatter()->column_width(28);
    frames.add(app);
    vpAddInput(app, "--rig", rig, "FILE",
               "what is known of the camera; default with --run: DIR/rig.yaml if there is one");
    vpAddInput(app, "--lamps", lamps, "FILE", "lamps of known frequency; default with --run: DIR/lamps.yaml");
    vpAddName(app, "--frequency", frequency, "HZ", "of the only lamp, or of all, in place of --lamps");
    vpAddName(app, "--ppm", ppm, "PPM", "standard deviation of that frequency (default 50: a crystal)");
    vpAddName(app, "--out", out, "DIR",
              "write rig.yaml with the shutter that was found, camera.xml and report.txt; needs --rig");
    if (!vpParseCommandLine(app, argc, argv)) {
      return false;
    }
    frames.check();
    if (!frames.runs.empty()) {
      const std::filesystem::path run(frames.runs.front());
      if (rig.empty() && std::filesystem::exists(run / "rig.yaml")) {
        rig = (run / "rig.yaml").string();
      }
      if (lamps.empty() && frequency.empty()) {
        lamps = (run / "lamps.yaml").string();
      }
    }
    if (lamps.empty() == frequency.empty()) {
      throw vpException(vpException::badValue, std::string("--frequency: ") +
                                                   (lamps.empty() ? "nothing" : "beside --lamps") +
                                                   ", expected one of --frequency and --lamps");
    }
    vpCalibrationFolder::check(out, {rig, lamps});
    if (!out.empty() && rig.empty()) {
      throw vpException(vpException::badValue,
                        "--out: " + out + " without --rig, expected the rig to complete");
    }
    return true;
  }

  vpLampMap map() const
  {
    if (!lamps.empty()) {
      return vpLampMap::load(lamps);
    }
    vpLamp lamp;
    lamp.id = "lamp";
    lamp.modulation.kind = vpModulation::Kind::pwm;
    lamp.modulation.frequency = vpPositiveOption("--frequency", frequency);
    if (!ppm.empty()) {
      lamp.oscillatorPpm = vpPositiveOption("--ppm", ppm);
    }
    return vpLampMap{{lamp}};
  }
};

std::string shutterText(const vpShutterEstimate &found)
{
  vpReportTable table;
  table.heading = "Shutter";
  table.columns = {"", "value", "standard deviation"};
  table.rows = {
      {"readout along", found.alongColumns ? "columns" : "rows", ""},
      {"row time, us", vpFormat("%.5f", 1e6 * found.rowTime), vpFormat("%.5f", 1e6 * found.rowTimeSigma)},
      {"the same, %", "", vpFormat("%.4f", 100 * found.rowTimeSigma / found.rowTime)}};
  if (std::isfinite(found.exposure)) {
    table.rows.push_back({"effective exposure, us", vpFormat("%.2f", 1e6 * found.exposure),
                          vpFormat("%.2f", 1e6 * found.exposureSigma)});
  }
  vpReportTable lamps;
  lamps.heading = "Lamps";
  lamps.columns = {"lamp", "pictures", "left out", "row time, us", "standard deviation"};
  std::map<std::string, std::vector<const vpShutterSight *>> ofLamp;
  for (const vpShutterSight &sight : found.sights) {
    ofLamp[sight.lamp].push_back(&sight);
  }
  for (const auto &[lamp, sights] : ofLamp) {
    size_t used = 0;
    double weights = 0, sum = 0; // weighted mean of those that count
    for (const vpShutterSight *sight : sights) {
      if (sight->used) {
        ++used;
        weights += 1 / (sight->sigma * sight->sigma);
        sum += sight->rowTime / (sight->sigma * sight->sigma);
      }
    }
    lamps.rows.push_back({lamp, std::to_string(sights.size()), std::to_string(sights.size() - used),
                          used > 0 ? vpFormat("%.5f", 1e6 * sum / weights) : "",
                          used > 0 ? vpFormat("%.5f", 1e6 / std::sqrt(weights)) : ""});
  }
  return table.text() + "\n" + lamps.text();
}

//! What each lamp in each picture says.
std::string sightsOf(const vpShutterEstimate &found)
{
  vpReportTable each;
  each.heading = "Pictures";
  each.columns = {"picture", "lamp", "row time, us", "standard deviation", "exposure, us", ""};
  for (const vpShutterSight &sight : found.sights) {
    each.rows.push_back({std::filesystem::path(sight.picture).filename().string(), sight.lamp,
                         vpFormat("%.5f", 1e6 * sight.rowTime), vpFormat("%.5f", 1e6 * sight.sigma),
                         vpFormat("%.2f", 1e6 * sight.exposure), sight.used ? "" : "left out"});
  }
  return each.text();
}
} // namespace

vpExitCode vpCalibrateShutter(int argc, char **argv)
{
  ShutterOptions options;
  if (!options.parse(argc, argv)) {
    return vpExitCode::done;
  }
  vpVlpRig rig;
  if (!options.rig.empty()) {
    rig = vpVlpRig::load(options.rig);
  }
  vpShutterCalibration calibration(rig, options.map());
  for (const std::unique_ptr<vpFrameSource> &source : options.frames.open(rig)) {
    vpForEachFrame(*source, options.frames.name(), [&](const vpVlpFrame &frame) { calibration.add(frame); });
  }
  const vpShutterEstimate found = calibration.solve();
  if (!found.valid) {
    spdlog::error(found.refusal);
    return vpExitCode::nothingFound;
  }
  const std::string text = shutterText(found);
  std::cout << text;
  if (!options.out.empty()) {
    rig.shutter.rowTime = found.rowTime;
    rig.shutter.rowTimeSigma = found.rowTimeSigma;
    if (std::isfinite(found.exposure)) {
      rig.shutter.exposure = found.exposure;
      rig.shutter.exposureSigma = found.exposureSigma;
    }
    using Readout = vpRollingShutter::Readout;
    if (rig.shutter.alongColumns() != found.alongColumns) {
      rig.shutter.readout = found.alongColumns ? Readout::columns : Readout::rows;
      spdlog::warn("the rig had the readout along {}; which end is first is unknown, {} is written",
                   found.alongColumns ? "rows" : "columns", found.alongColumns ? "columns" : "rows");
    }
    const vpCalibrationFolder folder(options.out);
    folder.write("report.txt", text + "\n" + sightsOf(found));
    folder.writeRig(rig);
    spdlog::info(options.out + ": rig.yaml with this shutter, camera.xml, report");
  }
  return vpExitCode::done;
}

END_VISP_NAMESPACE
