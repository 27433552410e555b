/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpRunOptions.h"

#include <cmath>
#include <filesystem>

#include <CLI/CLI.hpp>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_identification/vpLedDetector.h>

#include "common/vpCommandLine.h"
#include "vpCalibrationOutput.h"

BEGIN_VISP_NAMESPACE

namespace
{
namespace fs = std::filesystem;

//! Index of a rig parameter that an option names.
int parameter(const std::string &option, const std::string &name)
{
  try {
    return vpRigParameterInfo::index(name);
  } catch (const vpException &error) {
    vpBadInput(option + ": " + error.getStringMessage());
  }
}
} // namespace

double vpPositiveOption(const std::string &option, const std::string &text)
{
  double value = 0;
  if (!vpParseNumber(text, value) || !std::isfinite(value) || !(value > 0)) {
    vpBadInput(option + ": " + vpShown(text) + ", expected a number above 0");
  }
  return value;
}

void vpRunOptions::add(CLI::App &app)
{
  frames.add(app);
  vpAddInput(app, "--rig", rig, "FILE", "first guess of the rig; default with --run: DIR/rig.yaml");
  vpAddInput(app, "--lamps", lamps, "FILE", "the lamp map; default with --run: DIR/lamps.yaml");
  vpAddName(
      app, "--odometry", odometry, "FILE",
      "timestamp_s,v_m_s,w_rad_s on the frames' clock; default with --run: DIR/odometry.csv if there is one");
  vpAddChoice(
      app, "--motion", motion, {"wheels", "spin", "places", "unknown"},
      "wheels (default): rolls without slipping sideways, and as the odometry says; spin: turns on one "
      "spot; places: stood in those of --places; unknown");
  vpAddName(app, "--places", places, "FILE", "TUM poses where the robot was put, at the times of the frames");
  vpAddChoice(app, "--turn-from", turnFrom, {"wheels", "gyro"},
              "what the odometry's turn rate comes from (default wheels)");
  vpAddName(app, "--wheel-separation", separation, "M",
            "distance of the wheels (default 0.16: TurtleBot3 burger)");
  app.add_option("--fix", fixed, "parameters that the rig has right: of x,y,z,roll,pitch,yaw,u0,v0,focal")
      ->delimiter(',')
      ->type_name("NAME");
  app.add_option("--prior", priors,
                 "standard deviation about the rig's value: NAME=SIGMA in m, deg, px, or a share for focal")
      ->delimiter(',')
      ->type_name("NAME=SIGMA");
  vpAddName(app, "--out", out, "DIR",
            "write rig.yaml, camera.xml, residuals.png, report.txt, covariance.csv");
}

void vpRunOptions::finish()
{
  frames.check();
  if (!frames.runs.empty()) {
    const fs::path run(frames.runs.front());
    rig = rig.empty() ? (run / "rig.yaml").string() : rig;
    lamps = lamps.empty() ? (run / "lamps.yaml").string() : lamps;
  }
  for (const auto &[option, name] : {std::pair{"--rig", rig}, std::pair{"--lamps", lamps}}) {
    if (name.empty()) {
      vpBadInput(std::string(option) + ": nothing, expected a file");
    }
  }
  vpCalibrationFolder::check(out, {rig, lamps});
  if ((motion == "places") == places.empty()) {
    vpBadInput("--places: " + (places.empty() ? std::string("nothing") : places) +
               ", expected a file with --motion places, and only then");
  }
  if (!odometry.empty() && frames.runs.size() > 1) {
    vpBadInput("--odometry: " + odometry +
               " for several runs, expected an odometry.csv in each of their folders");
  }
}

std::vector<vpLampRun> vpRunOptions::read(const vpVlpRig &guess, const vpLampMap &map) const
{
  using Motion = vpLampRun::Motion;
  std::vector<vpLampRun> all;
  const std::vector<std::unique_ptr<vpFrameSource>> sources = frames.open(guess);
  for (size_t i = 0; i < sources.size(); ++i) {
    vpLampRun run;
    run.motion = motion == "spin"     ? Motion::spin
                 : motion == "places" ? Motion::known
                 : motion == "wheels" ? Motion::wheels
                                      : Motion::unknown;
    const std::string beside =
        frames.runs.empty() ? std::string() : (fs::path(frames.runs[i]) / "odometry.csv").string();
    if (!odometry.empty()) {
      run.odometry = vpReadOdometry(odometry);
    } else if (!beside.empty() && fs::exists(beside)) {
      run.odometry = vpReadOdometry(beside);
    }
    if (!places.empty()) {
      run.places = vpTrajectory::load(places);
    }
    vpLedDetector detector(guess, map);
    vpForEachFrame(*sources[i], frames.name(), [&](const vpVlpFrame &frame) {
      detector.detect(frame.I);
      if (run.views.empty() || frame.timestamp > run.views.back().timestamp) { // a late one tells nothing new
        run.views.push_back(vpLampView::of(frame.timestamp, frame.name, detector.observations(), map));
      }
    });
    all.push_back(run);
  }
  return all;
}

void vpRunOptions::apply(vpLampBundle &bundle) const
{
  for (const std::string &name : fixed) {
    bundle.rigSigma(parameter("--fix", name)) = 0;
  }
  for (const std::string &prior : priors) {
    const size_t equals = prior.find('=');
    if (equals == std::string::npos) {
      vpBadInput("--prior: " + vpShown(prior) + ", expected NAME=SIGMA, as u0=1");
    }
    const int i = parameter("--prior", prior.substr(0, equals));
    if (bundle.rigSigma(i) == 0) {
      vpBadInput("--prior " + vpShown(prior.substr(0, equals)) +
                 ": beside --fix of the same, expected one of them");
    }
    const double sigma = vpPositiveOption("--prior " + prior.substr(0, equals), prior.substr(equals + 1));
    const bool angle = vpRigParameterInfo::all()[static_cast<size_t>(i)].unit == "deg";
    bundle.rigSigma(i) = angle ? sigma * M_PI / 180 : sigma;
  }
  bundle.wheelSeparation = turnFrom == "gyro"    ? 0
                           : !separation.empty() ? vpPositiveOption("--wheel-separation", separation)
                                                 : bundle.wheelSeparation;
}

END_VISP_NAMESPACE
