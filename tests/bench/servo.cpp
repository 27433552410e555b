/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// The simulated TurtleBot on its paths, its pose from the lamps, from odometry, or from commands alone.
// bench_servo [fast|slow|shapes|start|spoofed|all] [SEEDS]: rows of Markdown tables; from the top of the
// repository. VLP_SERVO_SCENARIO: another world than data/scenarios/servo.yaml.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <visp3/vlp_evaluation/vpErrorStatistics.h>
#include <visp3/vlp_servo/vpServoLoop.h>
#include <visp3/vlp_servo/vpServoSimulation.h>

#include "vlp_servo/spoofedPair.h"
#include "vpSimulatedStripes.h"

namespace
{
enum class Pose { lamps, rawOdometry, calibratedOdometry, commands };

struct Drive {
  vpPath path = vpPath::polyline({{-0.35, 0}, {0.35, -0.005}});
  double speed = 0.2; // m/s
  unsigned int laps = 1;
  Pose pose = Pose::lamps;
  bool typical = false;          // rig
  double offset = 0, turned = 0; // m to the left of the path, rad off its heading, at the start
};

//! Of one drive.
struct Result {
  double seen = NAN;               // m, RMS across the path of the poses that the loop estimated
  double truth = NAN, worst = NAN; // m, likewise of the base, and its largest
  double rig = NAN;                // m, RMS of the difference of both
  double lastLap = NAN;            // m, RMS of the base in the last lap
  double within = NAN;             // m of the path until it stays below 10 mm and 3 degrees
  double seconds = NAN;            // of computing
  bool arrived = false;
};

const vpScenario &world()
{
  static const char *const other = std::getenv("VLP_SERVO_SCENARIO");
  static const vpScenario scenario = vpScenario::load(other ? other : "data/scenarios/servo.yaml");
  return scenario;
}

double rms(const std::vector<double> &values)
{
  double sum = 0;
  for (const double value : values) {
    sum += value * value;
  }
  return values.empty() ? NAN : std::sqrt(sum / static_cast<double>(values.size()));
}

std::unique_ptr<vpPoseSource> posesOf(const Drive &drive, vpServoSimulation &simulation,
                                      const vpSimulatorTurtleBot3Settings &robot)
{
  const vpHomogeneousMatrix start = simulation.wMb(0);
  switch (drive.pose) {
  case Pose::lamps:
    return std::make_unique<vpVlpPose>(simulation);
  case Pose::commands:
    return std::make_unique<vpCommandedPose>(start, 0);
  case Pose::rawOdometry:
    return std::make_unique<vpOdometryPose>(start, 0);
  case Pose::calibratedOdometry:
    break;
  }
  vpOdometryCalibration calibration;
  calibration.speedScale = (1 + 0.5 * (robot.leftRadiusError + robot.rightRadiusError)) * (1 - robot.slip);
  calibration.turnBias = robot.gyroBias;
  return std::make_unique<vpOdometryPose>(start, 0, calibration);
}

Result drive(const Drive &asked, std::uint64_t seed)
{
  vpScenario scenario = world();
  if (asked.typical) {
    scenario.useTypicalRig();
  }
  if (asked.pose == Pose::rawOdometry) {
    scenario.motion.robot.turnSource = vpSimulatorTurtleBot3Settings::TurnSource::wheels;
  }
  const vpPathPoint begin = asked.path.at(0);
  vpServoSimulationSettings settings;
  settings.start.x = begin.place.x() - asked.offset * std::sin(begin.heading);
  settings.start.y = begin.place.y() + asked.offset * std::cos(begin.heading);
  settings.start.yaw = begin.heading + asked.turned;
  vpServoSimulation simulation(scenario, seed, settings);
  const std::unique_ptr<vpPoseSource> poses = posesOf(asked, simulation, scenario.motion.robot);
  vpServoLoopSettings servo;
  servo.follower.reference.speed = asked.speed;
  servo.follower.reference.laps = asked.laps;
  vpServoLoop loop(simulation.robot(), *poses, simulation, asked.path, servo);

  const auto clock = std::chrono::steady_clock::now();
  const vpServoRun run = loop.run();
  Result result;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  result.arrived = run.end == vpServoRun::End::arrived;
  if (!result.arrived) {
    std::fprintf(stderr, "seed %d: %s\n", static_cast<int>(seed), run.reason.c_str());
  }
  const auto truth = vpTrackErrorsOf(asked.path, run, [&](double time) { return simulation.wMb(time); });
  const auto seen = vpTrackErrorsOf(asked.path, run);
  std::vector<double> across, estimated, apart, last;
  result.worst = result.within = 0;
  for (size_t i = 0; i < truth.size(); ++i) {
    across.push_back(truth[i].across);
    result.worst = std::max(result.worst, std::abs(truth[i].across));
    if (i < seen.size()) {
      estimated.push_back(seen[i].across);
      apart.push_back(truth[i].across - seen[i].across);
    }
    if (truth[i].s > (asked.laps - 1) * asked.path.length()) {
      last.push_back(truth[i].across);
    }
    constexpr double near = 0.01, straight = 3 * M_PI / 180;
    if (std::abs(truth[i].across) > near || std::abs(truth[i].heading) > straight) {
      result.within = truth[i].s - truth[0].s;
    }
  }
  result.truth = rms(across);
  result.seen = rms(estimated);
  result.rig = rms(apart);
  result.lastLap = rms(last);
  return result;
}

std::vector<Result> drives(const Drive &asked, int seeds)
{
  std::vector<Result> results(static_cast<size_t>(seeds));
  vpRunTrials(seeds, [&](int seed, std::mt19937_64 &) {
    results[static_cast<size_t>(seed)] = drive(asked, static_cast<std::uint64_t>(seed + 1));
  });
  return results;
}

double quantile(const std::vector<Result> &results, double Result::*member, double share)
{
  std::vector<double> values;
  for (const Result &result : results) {
    values.push_back(result.*member);
  }
  return vpPercentile(values, share);
}

void header()
{
  std::printf(
      "\n| drive | seeds | arrived | RMS across the path, true: median, worst, mm | as seen by the loop, "
      "mm | apart, the rig's, mm | largest of all, mm | RMS of the last lap, median, mm | s of computing |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
}

void row(const std::string &name, const Drive &asked, int seeds)
{
  const std::vector<Result> results = drives(asked, seeds);
  const auto arrived = std::count_if(results.begin(), results.end(), [](auto &one) { return one.arrived; });
  const auto mm = [&results](double Result::*member, double share) {
    return 1000 * quantile(results, member, share);
  };
  std::printf("| %s | %d | %d | %.2f, %.2f | %.2f | %.2f | %.1f | %.2f | %.1f |\n", name.c_str(), seeds,
              static_cast<int>(arrived), mm(&Result::truth, 0.5), mm(&Result::truth, 1),
              mm(&Result::seen, 0.5), mm(&Result::rig, 0.5), mm(&Result::worst, 1), mm(&Result::lastLap, 0.5),
              quantile(results, &Result::seconds, 0.5));
  std::fflush(stdout);
}

//! Lines A and B of the paper.
void lines(double speed, int seeds)
{
  header();
  for (const bool b : {false, true}) {
    Drive asked;
    asked.speed = speed;
    asked.path = b ? vpPath::polyline({{0, -0.35}, {-0.01, 0.35}}) : asked.path;
    const std::string name = std::string("line ") + (b ? "B" : "A") + " at " +
                             std::to_string(std::lround(1000 * speed)) + " mm/s, ";
    row(name + "lamps, ideal rig", asked, seeds);
    asked.typical = true;
    row(name + "lamps, typical rigs", asked, seeds);
    asked.typical = false;
    asked.pose = Pose::rawOdometry;
    row(name + "wheels alone, raw", asked, seeds);
    asked.pose = Pose::calibratedOdometry;
    row(name + "wheels and gyro, calibrated", asked, seeds);
    asked.pose = Pose::commands;
    row(name + "open loop", asked, seeds);
  }
}

void fast(int seeds)
{
  lines(0.2, seeds);
}

void slow(int seeds)
{
  lines(0.004, seeds);
}

void shapes(int seeds)
{
  header();
  const std::pair<const char *, vpPath> paths[] = {
      {"square 0.7 m", vpPath::polyline({{-0.35, -0.35}, {0.35, -0.35}, {0.35, 0.35}, {-0.35, 0.35}}, true)},
      {"circle, radius 0.3 m", vpPath::circle({0, 0}, 0.3)},
      {"lemniscate 0.7 m", vpPath::lemniscate({0, 0}, 0.7)}};
  for (const auto &[name, path] : paths) {
    Drive asked;
    asked.path = path;
    asked.speed = 0.15;
    asked.laps = 10;
    row(std::string(name) + ", 10 laps, lamps, ideal rig", asked, std::max(2, seeds / 5));
    asked.laps = 1;
    asked.typical = true;
    row(std::string(name) + ", lamps, typical rigs", asked, seeds);
    asked.typical = false;
    asked.laps = 10;
    asked.pose = Pose::rawOdometry;
    row(std::string(name) + ", 10 laps, wheels alone, raw", asked, seeds);
    asked.pose = Pose::calibratedOdometry;
    row(std::string(name) + ", 10 laps, wheels and gyro, calibrated", asked, seeds);
  }
}

//! From beside the line: how far along it until the base stays near.
void start(int seeds)
{
  std::printf(
      "\n| start at 0.1 m/s | seeds | along the path until it stays within 10 mm and 3 degrees: median, "
      "worst, m |\n|---|---|---|\n");
  for (const double side : {-1.0, 1.0}) {
    for (const double turned : {-30.0, 30.0}) {
      Drive asked;
      asked.speed = 0.1;
      asked.path = vpPath::polyline({{-0.4, 0}, {0.5, 0}});
      asked.offset = 0.1 * side;
      asked.turned = turned * M_PI / 180;
      const std::vector<Result> results = drives(asked, seeds);
      std::printf("| %+.1f m and %+.0f degrees | %d | %.3f, %.3f |\n", asked.offset, turned, seeds,
                  quantile(results, &Result::within, 0.5), quantile(results, &Result::within, 1));
      std::fflush(stdout);
    }
  }
}

//! Of a drive under two lamps that give way to two with their frequencies, 36 cm beside.
struct Spoofed {
  double stood = 0;    // s, from then until it stands for good; NaN: it drove on
  double farthest = 0; // m, error of the poses on which it drove
  std::string reason;  // of its end
};

Spoofed spoofedDrive(bool odometry, double speed, double from, std::uint64_t seed)
{
  const vpScenario scenario = spoofedPair::spoofed(world(), from);
  const Drive line;
  const vpPathPoint begin = line.path.at(0);
  vpServoSimulationSettings settings;
  settings.start = {begin.place.x(), begin.place.y(), begin.heading};
  vpServoSimulation simulation(scenario, seed, settings);
  spoofedPair::NoOdometry none(simulation);
  vpVlpPose poses(odometry ? static_cast<vpPictureFeed &>(simulation) : none);
  vpServoLoopSettings servo;
  servo.follower.reference.speed = speed;
  servo.safety.giveUp = 4; // s
  vpServoLoop loop(simulation.robot(), poses, simulation, line.path, servo);
  Spoofed result;
  loop.watch = [&](const vpServoStep &step, const std::vector<vpLocatedPicture> &pictures) {
    for (const vpLocatedPicture &picture : pictures) {
      const vpHomogeneousMatrix &wMb = picture.location.fix.wMb, truth = simulation.wMb(picture.timestamp);
      const double error = std::hypot(wMb[0][3] - truth[0][3], wMb[1][3] - truth[1][3]);
      result.farthest = step.share > 0 ? std::max(result.farthest, error) : result.farthest;
    }
    return true;
  };
  const vpServoRun run = loop.run();
  result.reason = run.reason;
  constexpr double standing = 0.002, step = 0.01; // m/s, s
  for (double time = from; time < simulation.now(); time += step) {
    result.stood = std::abs(simulation.robot().twist(time).v) < standing ? result.stood : time + step - from;
  }
  result.stood = run.end == vpServoRun::End::arrived ? NAN : result.stood;
  return result;
}

void spoofed(int seeds)
{
  std::printf(
      "\n| two lamps give way to copies 36 cm beside | drives | arrived | stands after: median, longest, s "
      "| largest error while it drives, mm | reason (drives) |\n|---|---|---|---|---|---|\n");
  for (const bool odometry : {true, false}) {
    for (const double speed : {0.1, 0.2}) {
      std::vector<Spoofed> all(static_cast<size_t>(seeds));
      vpRunTrials(seeds, [&](int seed, std::mt19937_64 &) {
        const double from = 1.5 + seed / (world().frameRate * seeds); // s, all through a picture
        all[static_cast<size_t>(seed)] =
            spoofedDrive(odometry, speed, from, static_cast<std::uint64_t>(seed + 1));
      });
      std::vector<double> stood;
      double farthest = 0;
      std::map<std::string, int> reasons; // and drives
      for (const Spoofed &one : all) {
        farthest = std::max(farthest, one.farthest);
        if (!std::isnan(one.stood)) {
          stood.push_back(one.stood);
          ++reasons[one.reason];
        }
      }
      std::printf("| %s odometry, %g m/s | %d | %zu |", odometry ? "with" : "without", speed, seeds,
                  all.size() - stood.size());
      if (stood.empty()) {
        std::printf(" - |");
      } else {
        std::printf(" %.2f, %.2f |", vpPercentile(stood, 0.5), vpPercentile(stood, 1));
      }
      std::printf(" %.2f |", 1000 * farthest);
      for (const auto &[reason, drives] : reasons) {
        std::printf(" %s (%d)", reason.c_str(), drives);
      }
      std::printf(" |\n");
      std::fflush(stdout);
    }
  }
}
} // namespace

int main(int argc, char **argv)
{
  const std::string part = argc > 1 ? argv[1] : "all";
  const int seeds = argc > 2 ? std::max(1, std::atoi(argv[2])) : 20;
  const std::vector<std::pair<std::string, std::function<void(int)>>> parts = {
      {"fast", fast}, {"slow", slow}, {"shapes", shapes}, {"start", start}, {"spoofed", spoofed}};
  for (const auto &[name, print] : parts) {
    if (part == "all" || part == name) {
      print(seeds);
    }
  }
  return 0;
}
