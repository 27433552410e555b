/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <algorithm>
#include <cmath>
#include <iostream>

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>
#include <visp3/core/vpException.h>
#include <visp3/vlp_calibration/vpLampSurvey.h>
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
using State = vpSurveyedLamp::State;

const char *const lampsDescription =
    "Where lamps hang, from a drive with odometry and two lamps, or one distance, measured by hand.\n";

const char *const lampsFooter = R"(
Examples:
  vlp-calibrate lamps --run drive --measured LED1,LED4 --out surveyed
  vlp-calibrate lamps --run drive --distance LED1,LED4,1.323 --rig calibrated/rig.yaml --out surveyed

The map names the lamps and how they blink. Of --measured lamps its position_m is exact; of all others it is only
held against what is found: those that hang elsewhere are named. With --distance the first lamp stays where the map
has it in x and y, and the second in the direction from there; floor and camera height give z.
Calibrate shutter and mount first: the rig takes part with the standard deviations that it states, all else of it is
held unless a --prior says how well it is known.

Exit code: 0 done; 2 bad usage or bad input; 3 the pictures do not tell.
)";

size_t lampOf(const vpLampMap &map, const std::string &option, const std::string &id)
{
  const vpLamp *lamp = map.find(id);
  if (lamp == nullptr) {
    std::string ids;
    for (const vpLamp &known : map.lamps) {
      ids += (ids.empty() ? "" : ", ") + known.id;
    }
    vpBadInput(option + ": " + vpShown(id) + ", expected a lamp of the map: " + ids);
  }
  return static_cast<size_t>(lamp - map.lamps.data());
}

void setMeasured(vpLampSurvey &survey, const vpLampMap &map, const std::vector<std::string> &ids)
{
  for (const std::string &id : ids) {
    const size_t lamp = lampOf(map, "--measured", id);
    if (std::find(survey.measured.begin(), survey.measured.end(), lamp) != survey.measured.end()) {
      vpBadInput("--measured: " + id + " twice, expected each lamp once");
    }
    survey.measured.push_back(lamp);
  }
}

void setDistance(vpLampSurvey &survey, const vpLampMap &map, const std::vector<std::string> &words)
{
  if (words.empty()) {
    return;
  }
  if (words.size() != 3) {
    vpBadInput("--distance: " + std::to_string(words.size()) + " words, expected LAMP,LAMP,METRES");
  }
  vpLampDistance distance;
  distance.from = lampOf(map, "--distance", words[0]);
  distance.to = lampOf(map, "--distance", words[1]);
  distance.metres = vpPositiveOption("--distance", words[2]);
  if (distance.from == distance.to) {
    vpBadInput("--distance: from " + words[0] + " to itself, expected two lamps");
  }
  survey.distance = distance;
}

vpReportTable tableOf(const vpSurveyResult &found)
{
  static const char *const states[] = {"measured", "as in the map", "DISPLACED", "undetermined", "not seen"};
  vpReportTable table;
  table.heading = "Lamps (mm)";
  table.columns = {"lamp", "x", "y", "z", "sigma x", "sigma y", "sigma z", "from the map", "pictures", ""};
  for (size_t k = 0; k < found.lamps.size(); ++k) {
    const vpSurveyedLamp &lamp = found.lamps[k];
    const vpLamp &placed = found.bundle.map.lamps[k];
    const Eigen::Vector3d mm = 1000 * placed.position, sigma = 1000 * lamp.sigma, off = 1000 * lamp.offset;
    table.rows.push_back({placed.id, vpFormat("%.2f", mm.x()), vpFormat("%.2f", mm.y()),
                          vpFormat("%.2f", mm.z()), vpFormat("%.2f", sigma.x()), vpFormat("%.2f", sigma.y()),
                          vpFormat("%.2f", sigma.z()),
                          vpFormat("%+.1f %+.1f %+.1f", off.x(), off.y(), off.z()),
                          std::to_string(lamp.images), states[static_cast<size_t>(lamp.state)]});
  }
  return table;
}
} // namespace

vpExitCode vpCalibrateLamps(int argc, char **argv)
{
  vpRunOptions options;
  std::vector<std::string> measured, distance;
  CLI::App app(lampsDescription, "vlp-calibrate lamps");
  app.footer(lampsFooter);
  app.get_formatter()->column_width(28);
  options.add(app);
  app.add_option("--measured", measured, "lamps whose position_m is exact, two or more")
      ->delimiter(',')
      ->type_name("LAMP");
  app.add_option("--distance", distance, "in their place: a distance between two lamps")
      ->delimiter(',')
      ->type_name("LAMP,LAMP,M");
  if (!vpParseCommandLine(app, argc, argv)) {
    return vpExitCode::done;
  }
  options.finish();
  const vpVlpRig rig = vpVlpRig::load(options.rig);
  const vpLampMap map = vpLampMap::load(options.lamps);
  vpLampSurvey survey;
  survey.bundle.rigSigma = vpStatedSigma(rig);
  options.apply(survey.bundle);
  setMeasured(survey, map, measured);
  setDistance(survey, map, distance);
  if ((survey.measured.size() < 2) == !survey.distance || (survey.distance && !survey.measured.empty())) {
    vpBadInput("--measured: " + std::to_string(survey.measured.size()) +
               (survey.distance ? " lamps beside --distance" : " lamps") +
               ", expected two or more, or one --distance instead");
  }

  const vpSurveyResult found = survey.solve(options.read(rig, map), rig, map);
  if (!found.bundle.valid) {
    spdlog::error(found.bundle.refusal);
    return vpExitCode::nothingFound;
  }
  std::string text = tableOf(found).text() + "\n" + vpRigTable(found.bundle, survey.bundle.rigSigma).text();
  text += vpFormat("\n%zu image points, %.4f px rms, %.2f times as uncertain as the detector said\n",
                   found.bundle.residuals.size(), found.bundle.rms, found.bundle.imageFactor);
  std::cout << text;
  vpWarnOfInflatedMap(found.bundle, map);
  for (size_t k = 0; k < found.lamps.size(); ++k) {
    if (found.lamps[k].state == State::displaced) {
      spdlog::warn("lamp {} is {:.0f} mm from where the map has it", map.lamps[k].id,
                   1000 * found.lamps[k].offset.norm());
    } else if (found.lamps[k].state == State::undetermined || found.lamps[k].state == State::unseen) {
      spdlog::warn("lamp {} keeps the map's place: seen too little, drive where it is in view from far apart",
                   map.lamps[k].id);
    }
  }
  if (!options.out.empty()) {
    const vpCalibrationFolder folder(options.out);
    vpWritePicture(folder / "residuals.png",
                   vpResidualPicture(cv::Size(static_cast<int>(rig.width), static_cast<int>(rig.height)),
                                     vpResidualsOf(found.bundle), "lamps"));
    folder.write("report.txt", text);
    folder.write("covariance.csv", vpCovarianceCsv(found.bundle));
    found.bundle.map.save(folder / "lamps.yaml", {"surveyed by vlp-calibrate lamps"});
    folder.writeRig(found.bundle.rig);
    spdlog::info(options.out + ": lamps.yaml, rig.yaml, report, covariance, residuals.png");
  }
  return vpExitCode::done;
}

END_VISP_NAMESPACE
