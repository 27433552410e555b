/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// What goes wrong on a drive, and how long until the robot stands; and the loop in real time.
// bench_faults [faults|loop|all] [SEEDS]: rows of Markdown tables; from the top of the repository.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <visp3/core/vpException.h>
#include <visp3/vlp_evaluation/vpErrorStatistics.h>
#include <visp3/vlp_servo/vpServoLoop.h>
#include <visp3/vlp_servo/vpServoSimulation.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
const vpScenario &world()
{
  static const vpScenario scenario = vpScenario::load("data/scenarios/servo.yaml");
  return scenario;
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

//! The world's clock, which the watchdog and the fault hang on.
class FaultyClock : public vpServoClock
{
public:
  FaultyClock(vpServoSimulation &world, CabledBase &base, std::function<void(double)> each)
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
  FaultyClock clock(simulation, base, [&](double now) {
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
    std::printf("| %s | %.3f, %.3f | %.3f, %.3f | %.2f |\n", fault.name.c_str(), vpPercentile(fromFault, 0.5),
                vpPercentile(fromFault, 1), vpPercentile(fromNotice, 0.5), vpPercentile(fromNotice, 1),
                fault.limit);
    std::fflush(stdout);
  }
}

//! The loop in real time, with the threads of a real robot.
void loop()
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
      vpPercentile(delays, 0.5), vpPercentile(delays, 0.99), vpPercentile(delays, 1),
      vpPercentile(computes, 0.5), vpPercentile(computes, 0.99), vpPercentile(computes, 1));
}
} // namespace

int main(int argc, char **argv)
{
  const std::string part = argc > 1 ? argv[1] : "all";
  const int seeds = argc > 2 ? std::max(1, std::atoi(argv[2])) : 10;
  if (part == "all" || part == "faults") {
    faults(seeds);
  }
  if (part == "all" || part == "loop") {
    loop();
  }
  return 0;
}
