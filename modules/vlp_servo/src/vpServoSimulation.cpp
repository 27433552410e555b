/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_servo/vpServoSimulation.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <thread>
#include <utility>

BEGIN_VISP_NAMESPACE

namespace
{
//! The robot, as what moves the camera.
class DrivenByLoop : public vpRobotMotion
{
public:
  //! \param begin s, on the robot's clock, where the world's is 0. \param mutex Of the robot, or none.
  DrivenByLoop(std::shared_ptr<vpSimulatorTurtleBot3> robot, double begin, std::mutex *mutex)
      : m_robot(std::move(robot)), m_begin(begin), m_mutex(mutex)
  {
  }
  vpHomogeneousMatrix wMb(double time) override
  {
    const auto lock = m_mutex ? std::unique_lock<std::mutex>(*m_mutex) : std::unique_lock<std::mutex>();
    return m_robot->wMb(m_begin + std::max(time, 0.0));
  }
  double duration() const override { return std::numeric_limits<double>::infinity(); }

private:
  std::shared_ptr<vpSimulatorTurtleBot3> m_robot;
  double m_begin; // s
  std::mutex *m_mutex;
};

//! s, from a frame's time stamp to the end of its last line, and a little by which the renderer looks beyond.
double readoutOf(const vpVlpRig &rig)
{
  constexpr double tail = 0.002; // s
  const vpLineTiming timing = rig.lineTiming();
  return std::max(timing.middle(0), timing.middle(timing.lines() - 1)) + rig.shutter.exposure / 2 + tail;
}

std::shared_ptr<vpSimulatorTurtleBot3> robotOf(const vpScenario &scenario, std::uint64_t seed,
                                               const vpServoStart &start, double time)
{
  vpSimulatorTurtleBot3Settings robot = scenario.motion.robot;
  robot.seed = seed;
  robot.startTime = time;
  robot.startX = start.x;
  robot.startY = start.y;
  robot.startYaw = start.yaw;
  return std::make_shared<vpSimulatorTurtleBot3>(robot);
}

std::unique_ptr<vpSimulation> worldOf(const vpScenario &scenario, std::uint64_t seed,
                                      std::unique_ptr<vpRobotMotion> motion)
{
  vpScenario endless = scenario;
  endless.frames = std::numeric_limits<size_t>::max();
  return std::make_unique<vpSimulation>(endless, seed, std::move(motion));
}
} // namespace

vpServoSimulation::vpServoSimulation(const vpScenario &scenario, std::uint64_t seed,
                                     const vpServoSimulationSettings &settings)
    : vpServoSimulation(scenario, seed, settings, vpVlpLocalizer(scenario.rig, scenario.map))
{
}

vpServoSimulation::vpServoSimulation(const vpScenario &scenario, std::uint64_t seed,
                                     const vpServoSimulationSettings &settings, vpVlpLocalizer localized)
    : localizer(std::move(localized)), m_settings(settings),
      m_robot(robotOf(scenario, seed, settings.start, 0)),
      m_simulation(worldOf(scenario, seed, std::make_unique<DrivenByLoop>(m_robot, 0, nullptr))),
      m_frameTime(1 / scenario.frameRate), m_readout(readoutOf(m_simulation->camera().rig))
{
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

vpLiveSimulation::vpLiveSimulation(const vpScenario &scenario, std::uint64_t seed, const vpServoStart &start,
                                   std::function<double()> now)
    : m_now(std::move(now)), m_begin(m_now()), m_robot(robotOf(scenario, seed, start, m_begin)),
      m_simulation(worldOf(scenario, seed, std::make_unique<DrivenByLoop>(m_robot, m_begin, &m_mutex))),
      m_frameTime(1 / scenario.frameRate), m_readout(readoutOf(m_simulation->camera().rig))
{
}

vpLiveSimulation::~vpLiveSimulation() = default;

//! The robot, its world run on to now. To be called with the mutex locked.
vpSimulatorTurtleBot3 &vpLiveSimulation::upToDate()
{
  m_robot->advance(std::max(m_now(), m_robot->time()));
  return *m_robot;
}

vpBaseVelocity vpLiveSimulation::setVelocity(double v, double w)
{
  const std::lock_guard<std::mutex> lock(m_mutex);
  return upToDate().setVelocity(v, w);
}

void vpLiveSimulation::stop()
{
  const std::lock_guard<std::mutex> lock(m_mutex);
  upToDate().stop();
}

vpOdometry vpLiveSimulation::odometry()
{
  const std::lock_guard<std::mutex> lock(m_mutex);
  return upToDate().odometry();
}

vpBaseLimits vpLiveSimulation::limits() const
{
  return m_robot->limits();
}

vpHomogeneousMatrix vpLiveSimulation::wMb(double time)
{
  const std::lock_guard<std::mutex> lock(m_mutex);
  return upToDate().wMb(time);
}

bool vpLiveSimulation::next(vpVlpFrame &frame)
{
  const auto readAt = [this](size_t picture) {
    return m_begin + static_cast<double>(picture) * m_frameTime + m_readout;
  };
  for (; readAt(m_pictures + 1) < m_now(); ++m_pictures) {
    m_simulation->skip();
  }
  const double read = readAt(m_pictures++);
  std::this_thread::sleep_for(std::chrono::duration<double>(std::max(0.0, read - m_now())));
  {
    const std::lock_guard<std::mutex> lock(m_mutex);
    upToDate();
  }
  m_simulation->next(frame);
  frame.timestamp += m_begin;
  return true;
}

END_VISP_NAMESPACE
