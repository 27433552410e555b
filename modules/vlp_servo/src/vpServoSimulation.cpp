/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_servo/vpServoSimulation.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

BEGIN_VISP_NAMESPACE

namespace
{
//! The robot, as what moves the camera.
class DrivenByLoop : public vpRobotMotion
{
public:
  explicit DrivenByLoop(std::shared_ptr<vpSimulatorTurtleBot3> robot)
      : m_robot(std::move(robot)), m_start(m_robot->time())
  {
  }
  vpHomogeneousMatrix wMb(double time) override { return m_robot->wMb(std::max(time, m_start)); }
  double duration() const override { return std::numeric_limits<double>::infinity(); }

private:
  std::shared_ptr<vpSimulatorTurtleBot3> m_robot;
  double m_start; // s
};

//! s, from a frame's time stamp to the end of the exposure of its last line.
double readoutOf(const vpVlpRig &rig)
{
  const vpLineTiming timing = rig.lineTiming();
  return std::max(timing.middle(0), timing.middle(timing.lines() - 1)) + rig.shutter.exposure / 2;
}

vpScenario endless(const vpScenario &scenario)
{
  vpScenario longer = scenario;
  longer.frames = std::numeric_limits<size_t>::max();
  return longer;
}
} // namespace

vpServoSimulation::vpServoSimulation(const vpScenario &scenario, std::uint64_t seed,
                                     const vpServoSimulationSettings &settings)
    : localizer(scenario.rig, scenario.map), m_settings(settings), m_frameTime(1 / scenario.frameRate)
{
  vpSimulatorTurtleBot3Settings robot = scenario.motion.robot;
  robot.seed = seed;
  robot.startX = settings.startX;
  robot.startY = settings.startY;
  robot.startYaw = settings.startYaw;
  m_robot = std::make_shared<vpSimulatorTurtleBot3>(robot);
  m_simulation =
      std::make_unique<vpSimulation>(endless(scenario), seed, std::make_unique<DrivenByLoop>(m_robot));
  constexpr double tail = 0.002; // s, by which the renderer looks beyond its last line
  m_readout = readoutOf(m_simulation->camera().rig) + tail;
}

vpServoSimulation::~vpServoSimulation() = default;

double vpServoSimulation::next()
{
  m_robot->advance(static_cast<double>(++m_periods) * m_settings.period);
  return now();
}

std::optional<vpLocatedPicture> vpServoSimulation::next(double now)
{
  const double known = static_cast<double>(m_pictures) * m_frameTime + m_readout + m_settings.computeDelay;
  if (known > now) {
    return std::nullopt;
  }
  vpVlpFrame frame;
  m_simulation->next(frame);
  ++m_pictures;
  const auto begin = std::chrono::steady_clock::now();
  vpLocatedPicture picture;
  picture.timestamp = frame.timestamp;
  picture.known = known;
  picture.location = localizer.process(frame);
  picture.compute = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  picture.filter = localizer.filter;
  picture.I = std::make_shared<vpImage<unsigned char>>(std::move(frame.I));
  return picture;
}

END_VISP_NAMESPACE
