/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// The simulated TurtleBot on its paths, its pose from the lamps, from odometry, or from commands alone.
// bench_servo [fast|slow|shapes|start|faults|loop|all] [SEEDS]: rows of Markdown tables; from the top of the
// repository. VLP_SERVO_SCENARIO: another world than data/scenarios/servo.yaml.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <visp3/core/vpException.h>
#include <visp3/vlp_servo/vpServoLoop.h>
#include <visp3/vlp_servo/vpServoSimulation.h>

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
  double seen = NAN;               // m, RMS across the path of the poses that the loop believed in
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

double at(std::vector<double> values, double share)
{
  std::sort(values.begin(), values.end());
  return values.empty() ? NAN
                        : values[std::min(values.size() - 1,
                                          static_cast<size_t>(share * static_cast<double>(values.size())))];
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
  std::vector<double> across, believed, apart, last;
  result.worst = result.within = 0;
  for (size_t i = 0; i < truth.size(); ++i) {
    across.push_back(truth[i].across);
    result.worst = std::max(result.worst, std::abs(truth[i].across));
    if (i < seen.size()) {
      believed.push_back(seen[i].across);
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
  result.seen = rms(believed);
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
  return at(values, share);
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
    row(name + "lamps, realistic rigs", asked, seeds);
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
    row(std::string(name) + ", lamps, realistic rigs", asked, seeds);
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

//! The simulated TurtleBot behind a cable, with the watchdog of its firmware.
class CabledBase : public vpMobileBase
{
public:
  enum class Cable { fine, refuses, pulled, silent }; // silent: the host is dead, and nobody is told

  explicit CabledBase(vpSimulatorTurtleBot3 &robot) : m_robot(robot) {}

  void set(Cable cable) { m_cable = cable; }

  vpBaseVelocity setVelocity(double v, double w) override
  {
    expect(m_cable == Cable::refuses);
    if (m_cable == Cable::silent) {
      return {v, w};
    }
    m_fed = m_robot.time();
    return m_robot.setVelocity(v, w);
  }
  void stop() override
  {
    expect(false);
    if (m_cable != Cable::silent) {
      m_robot.stop();
    }
  }
  vpOdometry odometry() override
  {
    expect(false);
    return m_robot.odometry();
  }
  vpBaseLimits limits() const override { return m_robot.limits(); }

  //! Once a period.
  void watchdog()
  {
    constexpr double patience = 0.5; // s, of the OpenCR's firmware
    if (m_robot.time() - m_fed > patience) {
      m_robot.stop();
    }
  }

  static constexpr double standing = 1e-3; // m/s

private:
  void expect(bool refused) const
  {
    if (m_cable == Cable::pulled || refused) {
      throw vpException(vpException::ioError, "base: no answer");
    }
  }

  vpSimulatorTurtleBot3 &m_robot;
  Cable m_cable = Cable::fine;
  double m_fed = 0; // s
};

//! What goes wrong at some time of a drive at 0.2 m/s.
struct Fault {
  std::string name;
  double limit = 0;                        // s, from what is counted on, that the issue states
  std::function<void(CabledBase &)> cable; // at that time
  bool throws = false, ends = false, battery = false, stalls = false, dark = false, fence = false;
};

//! The feed and the wheels, until something happens to them.
class FaultyPose : public vpVlpPose
{
public:
  FaultyPose(vpPictureFeed &feed, const Fault &fault, double from)
      : vpVlpPose(feed), m_fault(fault), m_from(from)
  {
  }
  void addOdometry(const vpOdometry &sample) override
  {
    if (!(m_fault.dark && sample.timestamp > m_from)) {
      vpVlpPose::addOdometry(sample);
    }
  }
  std::vector<vpLocatedPicture> look(double now) override
  {
    return m_fault.stalls && now > m_from ? std::vector<vpLocatedPicture>() : vpVlpPose::look(now);
  }

private:
  const Fault &m_fault;
  double m_from; // s
};

//! s from the fault, or from where the safety noticed it, until the base stands for good.
struct Stand {
  double fromFault = NAN, fromNotice = NAN;
};

Stand standAfter(const Fault &fault, std::uint64_t seed)
{
  const double when = 2 + 0.0137 * static_cast<double>(seed); // s, anywhere within a period and a frame
  vpScenario scenario = world();
  for (vpScenario::Lamp &lamp : scenario.lamps) {
    if (fault.dark) {
      lamp.dark.emplace_back(when, 1e9);
    }
  }
  const vpPath path = vpPath::polyline({{-0.4, 0}, {0.8, 0}});
  vpServoSimulationSettings start;
  start.start.x = -0.4;
  vpServoSimulation simulation(scenario, seed, start);
  CabledBase base(simulation.robot());
  class Clock : public vpServoClock
  {
  public:
    Clock(vpServoSimulation &world, CabledBase &base, std::function<void(double)> each)
        : m_world(world), m_base(base), m_each(std::move(each))
    {
    }
    double period() const override { return m_world.period(); }
    double now() override { return m_world.now(); }
    double next() override
    {
      const double now = m_world.vpServoSimulation::next();
      m_base.watchdog();
      m_each(now);
      return now;
    }

  private:
    vpServoSimulation &m_world;
    CabledBase &m_base;
    std::function<void(double)> m_each;
  };
  Clock clock(simulation, base, [&](double now) {
    if (now > when && fault.cable) {
      fault.cable(base);
    }
  });
  FaultyPose poses(simulation, fault, when);
  vpServoLoopSettings settings;
  settings.follower.reference.speed = 0.2;
  settings.safety.giveUp = 3;
  if (fault.fence) {
    settings.safety.fence = Eigen::AlignedBox2d(Eigen::Vector2d(-0.6, -0.2), Eigen::Vector2d(-0.1, 0.2));
  }
  vpServoLoop loop(base, poses, clock, path, settings);
  double noticed = NAN;
  loop.battery = [&] { return fault.battery && simulation.now() > when ? 10.5 : 12.0; };
  loop.watch = [&](const vpServoStep &step, const auto &) {
    noticed = std::isnan(noticed) && step.time > 1 && step.share == 0 ? step.time : noticed;
    if (fault.throws && step.time > when) {
      throw std::runtime_error("a bug");
    }
    return !(fault.ends && step.time > when);
  };
  try {
    loop.run();
  } catch (const std::runtime_error &) { // the one above
  }
  const double from = fault.fence ? noticed : when;
  while (simulation.now() < from + 5) {
    clock.next();
  }
  double last = from; // s, that it moved
  for (double time = from; time < simulation.now() - 0.001; time += 0.001) {
    last = std::abs(simulation.robot().twist(time).v) > CabledBase::standing ? time : last;
  }
  return {last - from, last - (std::isnan(noticed) ? from : noticed)};
}

void faults(int seeds)
{
  using Cable = CabledBase::Cable;
  const auto cable = [](Cable state) { return [state](CabledBase &base) { base.set(state); }; };
  std::vector<Fault> all(9);
  all[0] = {"lamps dark and odometry silent; from the covariance's limit on", 0.3, {}};
  all[0].dark = true;
  all[1] = {"the camera stalls; from 0.5 s without a picture on", 0.3, {}};
  all[1].stalls = true;
  all[2] = {"the base refuses a command", 0.3, cable(Cable::refuses)};
  all[3] = {"the cable is pulled: the base's watchdog", 0.65, cable(Cable::pulled)};
  all[4] = {"the program is killed: the base's watchdog", 0.65, cable(Cable::silent)};
  all[4].ends = true;
  all[5] = {"an exception in the loop", 0.3, {}};
  all[5].throws = true;
  all[6] = {"SIGINT, SIGTERM, key or click, as the loop sees them", 0.3, {}};
  all[6].ends = true;
  all[7] = {"the battery gets low, which is asked for once a second", 1.3, {}};
  all[7].battery = true;
  all[8] = {"the fence; from where it brakes on", 0.3, {}};
  all[8].fence = true;
  std::printf(
      "\n| fault at 0.2 m/s | from the fault to standstill: median, longest, s | from its limit or notice "
      "on: median, longest, s | bar, s, and the motors' lag |\n|---|---|---|---|\n");
  for (const Fault &fault : all) {
    std::vector<double> fromFault, fromNotice;
    for (int seed = 1; seed <= seeds; ++seed) {
      const Stand stand = standAfter(fault, static_cast<std::uint64_t>(seed));
      fromFault.push_back(stand.fromFault);
      fromNotice.push_back(stand.fromNotice);
    }
    std::printf("| %s | %.3f, %.3f | %.3f, %.3f | %.2f |\n", fault.name.c_str(), at(fromFault, 0.5),
                at(fromFault, 1), at(fromNotice, 0.5), at(fromNotice, 1), fault.limit);
    std::fflush(stdout);
  }
}

//! The loop in real time, with the threads of a real robot.
void loop(int)
{
  const vpPath path = vpPath::circle({0, 0}, 0.3);
  vpServoLoopSettings settings;
  settings.follower.reference.laps = 3;
  vpSteadyClock clock(0.02);
  vpLiveSimulation live(world(), 1, {0.3, 0, M_PI / 2}, [&clock] { return clock.now(); });
  vpLivePictures pictures(live, vpVlpLocalizer(live.rig(), live.map()), [&clock] { return clock.now(); });
  vpVlpPose poses(pictures);
  const vpServoRun run = vpServoLoop(live, poses, clock, path, settings).run();
  std::vector<double> delays, computes;
  for (const vpPictureDelay &picture : run.pictures) {
    delays.push_back(1000 * (picture.command - picture.timestamp));
    computes.push_back(1000 * picture.compute);
  }
  std::printf(
      "\n| real time, circle | |\n|---|---|\n| periods of 20 ms, begun more than 2 ms late | %zu, %zu |\n"
      "| pictures, with a pose, per second | %zu, %td, %.2f |\n"
      "| picture to command: median, 99 %%, longest, ms | %.1f, %.1f, %.1f |\n"
      "| of it the localizer: median, 99 %%, longest, ms | %.1f, %.1f, %.1f |\n",
      run.steps.size(), run.missed, run.pictures.size(),
      std::count_if(run.pictures.begin(), run.pictures.end(), [](auto &one) { return one.fix; }),
      static_cast<double>(run.pictures.size()) / (0.02 * static_cast<double>(run.steps.size())),
      at(delays, 0.5), at(delays, 0.99), at(delays, 1), at(computes, 0.5), at(computes, 0.99),
      at(computes, 1));
}
} // namespace

int main(int argc, char **argv)
{
  const std::string part = argc > 1 ? argv[1] : "all";
  const int seeds = argc > 2 ? std::max(1, std::atoi(argv[2])) : 20;
  const std::vector<std::pair<std::string, std::function<void(int)>>> parts = {
      {"fast", fast},   {"slow", slow},     {"shapes", shapes},
      {"start", start}, {"faults", faults}, {"loop", loop}};
  for (const auto &[name, print] : parts) {
    if (part == "all" || part == name) {
      print(seeds);
    }
  }
  return 0;
}
