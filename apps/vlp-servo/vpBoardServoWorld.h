/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpBoardServoWorld_h
#define vpBoardServoWorld_h

#include <atomic>

#include <visp3/vlp_robot/vpRobotTurtleBot3.h>
#include <visp3/vlp_sensor/vpFrameSource.h>

#include "vpServoWorld.h"

BEGIN_VISP_NAMESPACE

/*!
  A TurtleBot3 on its OpenCR board with a camera, on the host's clock. Driven by odometry or by commands alone
  it needs no camera.
*/
class vpBoardServoWorld : public vpServoWorld
{
public:
  //! \throw vpException where the robot or the camera cannot be opened, or the lamp map not be read.
  explicit vpBoardServoWorld(const vpVlpServoOptions &options);
  ~vpBoardServoWorld() override { m_closing = true; } // which ends the wait for a lost camera

  vpMobileBase &base() override { return *m_base; }
  vpServoClock &clock() override { return m_clock; }
  vpPictureFeed &pictures() override { return *m_pictures; }
  const vpLampMap &map() const override { return m_map; }
  std::function<double()> battery() override
  {
    return [this] { return m_base->status().batteryVoltage; };
  }

private:
  vpSteadyClock m_clock;
  vpLampMap m_map;
  std::unique_ptr<vpRobotTurtleBot3> m_base;
  std::atomic<bool> m_closing{false};
  std::unique_ptr<vpFrameSource> m_camera;
  std::unique_ptr<vpPictureFeed> m_pictures; // last: its thread uses camera and clock
};

END_VISP_NAMESPACE

#endif
