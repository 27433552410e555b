/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <cmath>
#include <iostream>

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>
#include <visp3/vlp_calibration/vpMountCalibration.h>
#include <visp3/vlp_sensor/vpWritePicture.h>

#include "common/vpTextBlock.h"
#include "vpCalibrate.h"
#include "vpCalibrationOutput.h"
#include "vpRunOptions.h"

BEGIN_VISP_NAMESPACE

namespace
{
const char *const mountDescription =
    "How the camera sits on the robot, its principal point and its focal length, "
    "from a drive under known lamps.\n";

const char *const mountFooter = R"(
Examples:
  vlp-calibrate mount --run spin --run square --out calibrated
  vlp-calibrate mount --run drive --fix u0,v0,focal --out calibrated
  vlp-calibrate mount --run points --motion places --places measured.tum --prior z=0.002 --out calibrated

Record the robot as it spins once round on the spot and then drives a square of half a metre, with odometry, under
lamps whose places the map has right (their position_sigma_m counts). All nine parameters are looked for:
  x, y, z           place of the camera on the base, m
  roll, pitch, yaw  its attitude there, degrees about x, y, z of the base
  u0, v0, focal     principal point (px) and focal length (a share)
Under lamps of one height the principal point trades with x and y, and the focal length with z: then give those of
`vlp-calibrate camera` with --fix u0,v0,focal, or say how well they are known with --prior. Parameters that the
pictures do not tell apart are refused by name.

Exit code: 0 done; 2 bad usage or bad input; 3 the pictures do not tell.
)";
} // namespace

vpExitCode vpCalibrateMount(int argc, char **argv)
{
  vpRunOptions options;
  CLI::App app(mountDescription, "vlp-calibrate mount");
  app.footer(mountFooter);
  app.get_formatter()->column_width(28);
  options.add(app);
  if (!vpParseCommandLine(app, argc, argv)) {
    return vpExitCode::done;
  }
  options.finish();
  vpMountCalibration calibration;
  options.apply(calibration.bundle);
  const vpVlpRig rig = vpVlpRig::load(options.rig);
  const vpLampMap map = vpLampMap::load(options.lamps);

  const vpBundleResult found = calibration.solve(options.read(rig, map), rig, map);
  if (!found.valid) {
    spdlog::error(found.refusal);
    return vpExitCode::nothingFound;
  }
  vpReportTable table = vpRigTable(found, calibration.bundle.rigSigma);
  std::string text = table.text();
  text += vpFormat("\n%zu image points, %.4f px rms, %.2f times as uncertain as the detector said\n",
                   found.residuals.size(), found.rms, found.imageFactor);
  for (const std::string &names : found.unseparated) {
    text += "told apart by the prior alone: " + names + "\n";
  }
  std::cout << text;
  vpWarnOfInflatedMap(found, map);
  if (!options.out.empty()) {
    const vpCalibrationFolder folder(options.out);
    vpWritePicture(folder / "residuals.png",
                   vpResidualPicture(cv::Size(static_cast<int>(rig.width), static_cast<int>(rig.height)),
                                     vpResidualsOf(found), "mount"));
    folder.write("report.txt", text);
    folder.write("covariance.csv", vpCovarianceCsv(found));
    folder.writeRig(found.rig);
    spdlog::info(options.out + ": rig.yaml with its camera.xml, report, covariance, residuals.png");
  }
  return vpExitCode::done;
}

END_VISP_NAMESPACE
