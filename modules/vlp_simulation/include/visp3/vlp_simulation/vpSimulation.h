/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpSimulation_h
#define vpSimulation_h

#include <cstdint>
#include <memory>
#include <vector>

#include <visp3/vlp_sensor/vpFrameSource.h>
#include <visp3/vlp_simulation/vpScenario.h>

BEGIN_VISP_NAMESPACE

/*!
  A scenario with all its random values drawn: a world with ground truth, and the frames that a
  camera in it delivers. The same scenario and seed give the same frames to the last byte on the same machine.

  \code
  vpSimulation simulation(vpScenario::load("paper-a.yaml"), 1);
  vpVlpFrame frame;
  while (simulation.next(frame)) {
    const vpHomogeneousMatrix wMb = simulation.wMb(frame.timestamp); // the truth
  }
  \endcode
*/
class VISP_EXPORT vpSimulation : public vpFrameSource
{
public:
  vpSimulation(const vpScenario &scenario, std::uint64_t seed);
  //! The same world, with \e motion in place of the scenario's own, as of a robot that somebody else drives.
  vpSimulation(const vpScenario &scenario, std::uint64_t seed, std::unique_ptr<vpRobotMotion> motion);
  ~vpSimulation() override;

  bool next(vpVlpFrame &frame) override;
  size_t size() const override { return m_scenario.frames; }
  //! Leaves the next frame out, undrawn, as a camera does whose frames are not fetched.
  void skip() { ++m_next; }

  //! True pose of the base in the map at \e time, s from the start of the run.
  vpHomogeneousMatrix wMb(double time) { return m_motion->wMb(time); }
  //! Wheel odometry up to the newest frame; empty for a robot that is put in places.
  std::vector<vpOdometry> odometry() const { return m_motion->odometry(); }

  //! Camera and lamps as the robot's files state them.
  const vpVlpRig &rig() const { return m_scenario.rig; }
  const vpLampMap &map() const { return m_scenario.map; }
  //! What is true.
  const vpSimulatedCamera &camera() const { return m_camera; }
  const vpSimulatedScene &scene() const { return m_scene; }

private:
  vpScenario m_scenario;
  std::uint64_t m_seed;
  vpSimulatedCamera m_camera;
  vpSimulatedScene m_scene;
  std::unique_ptr<vpRobotMotion> m_motion;
  std::unique_ptr<vpRollingShutterRenderer> m_renderer;
  size_t m_next = 0;
};

END_VISP_NAMESPACE

#endif
