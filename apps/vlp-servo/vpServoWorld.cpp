/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpServoWorld.h"

#include <visp3/vlp_servo/vpServoRobot.h>

#include "vpBoardServoWorld.h"

BEGIN_VISP_NAMESPACE

namespace
{
vpScenario scenarioOf(const vpVlpServoOptions &options)
{
  vpScenario scenario = vpScenario::load(options.scenario);
  if (options.typical) {
    scenario.useTypicalRig();
  }
  if (options.wheelsOnly) {
    scenario.motion.robot.turnSource = vpSimulatorTurtleBot3Settings::TurnSource::wheels;
  }
  return scenario;
}

//! The robot's rig: the file of the command line, else the scenario's.
vpVlpRig rigOf(const vpVlpServoOptions &options, const vpScenario &scenario)
{
  return options.rigFile.empty() ? scenario.rig : vpVlpRig::load(options.rigFile);
}

vpLampMap mapOf(const vpVlpServoOptions &options, const vpScenario &scenario)
{
  return options.lampsFile.empty() ? scenario.map : vpLampMap::load(options.lampsFile);
}

//! A scenario on its own time, as fast as it can be computed.
class Simulated : public vpServoWorld
{
public:
  Simulated(const vpVlpServoOptions &options, const vpServoSimulationSettings &settings)
      : m_scenario(scenarioOf(options)), m_map(mapOf(options, m_scenario)),
        m_world(m_scenario, options.seed, settings,
                vpVlpLocalizer(rigOf(options, m_scenario), mapOf(options, m_scenario)))
  {
  }

  vpMobileBase &base() override { return m_world.robot(); }
  vpServoClock &clock() override { return m_world; }
  vpPictureFeed &pictures() override { return m_world; }
  const vpLampMap &map() const override { return m_map; }
  std::function<vpHomogeneousMatrix(double)> truth() override
  {
    return [this](double time) { return m_world.wMb(time); };
  }

private:
  vpScenario m_scenario;
  vpLampMap m_map;
  vpServoSimulation m_world;
};

//! The same in real time, with the threads that a real robot has.
class SimulatedLive : public vpServoWorld
{
public:
  SimulatedLive(const vpVlpServoOptions &options, const vpServoSimulationSettings &settings)
      : m_scenario(scenarioOf(options)), m_map(mapOf(options, m_scenario)), m_clock(settings.period),
        m_world(m_scenario, options.seed, settings.start, [this] { return m_clock.now(); }),
        m_pictures(m_world, vpVlpLocalizer(rigOf(options, m_scenario), m_map),
                   [this] { return m_clock.now(); })
  {
  }

  vpMobileBase &base() override { return m_world; }
  vpServoClock &clock() override { return m_clock; }
  vpPictureFeed &pictures() override { return m_pictures; }
  const vpLampMap &map() const override { return m_map; }
  std::function<vpHomogeneousMatrix(double)> truth() override
  {
    return [this](double time) { return m_world.wMb(time); };
  }

private:
  vpScenario m_scenario;
  vpLampMap m_map;
  vpSteadyClock m_clock;
  vpLiveSimulation m_world;
  vpLivePictures m_pictures; // last: its thread uses the world
};

//! A robot behind topics of ROS, where other nodes look at its pictures.
class OnRos : public vpServoWorld
{
public:
  explicit OnRos(const std::string &nameSpace) : m_robot(vpServoRobot::openRos(nameSpace)) {}

  vpMobileBase &base() override { return m_robot->base(); }
  vpServoClock &clock() override { return m_robot->clock(); }
  vpPictureFeed &pictures() override { return m_pictures; }
  const vpLampMap &map() const override { return m_map; }
  std::unique_ptr<vpPoseSource> poses() override { return m_robot->poses(); }

private:
  std::unique_ptr<vpServoRobot> m_robot;
  vpNoPictures m_pictures;
  vpLampMap m_map;
};
} // namespace

std::unique_ptr<vpServoWorld> vpOpenServoWorld(const vpVlpServoOptions &options, const vpPath &path)
{
  if (options.onRos()) {
    return std::make_unique<OnRos>(options.robot.substr(options.robot.find(':') + 1));
  }
  if (options.robot != "sim") {
    return std::make_unique<vpBoardServoWorld>(options);
  }
  vpServoSimulationSettings settings;
  settings.start = options.startOn(path);
  settings.computeDelay = options.latency;
  if (options.realTime) {
    return std::make_unique<SimulatedLive>(options, settings);
  }
  return std::make_unique<Simulated>(options, settings);
}

END_VISP_NAMESPACE
