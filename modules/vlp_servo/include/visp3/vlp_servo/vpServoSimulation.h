/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpServoSimulation_h
#define vpServoSimulation_h

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>

#include <visp3/vlp_localization/vpVlpLocalizer.h>
#include <visp3/vlp_servo/vpPictureFeed.h>
#include <visp3/vlp_servo/vpServoClock.h>
#include <visp3/vlp_simulation/vpSimulation.h>

BEGIN_VISP_NAMESPACE

//! Where the simulated robot begins.
struct VISP_EXPORT vpServoStart {
  double x = 0;   // m, in w
  double y = 0;   // m, in w
  double yaw = 0; // rad
};

struct VISP_EXPORT vpServoSimulationSettings {
  double period = 0.02;       // s, of the control loop
  double computeDelay = 0.02; // s, from the end of a picture's readout to its pose
  vpServoStart start;
};

/*!
  A scenario's world with a robot that a control loop drives, on the world's own time: the clock of the loop
  lets the world run on from period to period, and a picture is there once its last line was read and the
  localizer has had its time. The scenario's own motion is not driven. Same scenario, seed and commands: same
  run.

  \code
  vpServoSimulation world(vpScenario::load("data/scenarios/servo.yaml"), 1, settings);
  vpVlpPose poses(world);
  vpServoLoop loop(world.robot(), poses, world, path, vpServoLoopSettings());
  const vpServoRun run = loop.run();
  const vpHomogeneousMatrix wMb = world.wMb(1.5); // the truth
  \endcode
*/
class VISP_EXPORT vpServoSimulation : public vpServoClock, public vpPictureFeed
{
public:
  vpVlpLocalizer localizer; // of the pictures

  //! \param seed Of all that is left to chance. \throw vpException (badValue) where robot or settings are out
  //! of range.
  vpServoSimulation(const vpScenario &scenario, std::uint64_t seed,
                    const vpServoSimulationSettings &settings);
  //! The same with a localizer that has another rig or other lamps than the scenario's.
  vpServoSimulation(const vpScenario &scenario, std::uint64_t seed, const vpServoSimulationSettings &settings,
                    vpVlpLocalizer localizer);
  ~vpServoSimulation() override;

  vpSimulatorTurtleBot3 &robot() { return *m_robot; }
  const vpSimulation &simulation() const { return *m_simulation; }

  //! True pose of the base at \e time, s, up to now().
  vpHomogeneousMatrix wMb(double time) const { return m_robot->wMb(time); }

  double period() const override { return m_settings.period; }
  double next() override;
  double now() override { return m_robot->time(); }

  void addOdometry(const vpOdometry &sample) override { localizer.filter.addOdometry(sample); }
  std::optional<vpLocatedPicture> next(double now) override;

private:
  vpServoSimulationSettings m_settings;
  std::shared_ptr<vpSimulatorTurtleBot3> m_robot;
  std::unique_ptr<vpSimulation> m_simulation;
  double m_frameTime;    // s, from picture to picture
  double m_readout;      // s, from a picture's time stamp to the end of its last line
  size_t m_pictures = 0; // taken
  std::int64_t m_periods = 0;
};

/*!
  The same world in real time, as a real robot and a real camera are: a base and a source of frames that two
  threads use side by side, on the host's clock.

  next() waits for the end of a picture's readout, as a camera does. Of the pictures that were read out
  between two calls only the newest one is given.
*/
class VISP_EXPORT vpLiveSimulation : public vpMobileBase, public vpFrameSource
{
public:
  //! The world begins now. \param now The host's clock, s, see vpSteadyClock; asked from both threads.
  vpLiveSimulation(const vpScenario &scenario, std::uint64_t seed, const vpServoStart &start,
                   std::function<double()> now);
  ~vpLiveSimulation() override;

  vpBaseVelocity setVelocity(double v, double w) override;
  void stop() override;
  vpOdometry odometry() override;
  vpBaseLimits limits() const override;

  bool next(vpVlpFrame &frame) override;

  //! True pose of the base at \e time, s, up to now.
  vpHomogeneousMatrix wMb(double time);
  //! Camera and lamps as the robot's files state them.
  const vpVlpRig &rig() const { return m_simulation->rig(); }
  const vpLampMap &map() const { return m_simulation->map(); }

private:
  vpSimulatorTurtleBot3 &upToDate();

  std::mutex m_mutex; // of the robot
  std::function<double()> m_now;
  double m_begin; // s
  std::shared_ptr<vpSimulatorTurtleBot3> m_robot;
  std::unique_ptr<vpSimulation> m_simulation;
  double m_frameTime; // s, from picture to picture
  double m_readout;   // s, from a picture's time stamp to the end of its last line
  size_t m_pictures = 0;
};

END_VISP_NAMESPACE

#endif
