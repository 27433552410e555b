/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpBoardServoWorld_h
#define vpBoardServoWorld_h

#include <visp3/vlp_robot/vpRobotTurtleBot3.h>

#include "vpServoWorld.h"

BEGIN_VISP_NAMESPACE

/*!
  A TurtleBot3 on its OpenCR board, on the host's clock. As yet no camera of a real robot can be opened: it
  drives by odometry or by commands alone.
*/
class vpBoardServoWorld : public vpServoWorld
{
public:
  //! \throw vpException where the robot or the camera cannot be opened, or the lamp map not be read.
  explicit vpBoardServoWorld(const vpVlpServoOptions &options);

  vpMobileBase &base() override { return *m_base; }
  vpServoClock &clock() override { return m_clock; }
  vpPictureFeed &pictures() override { return m_pictures; }
  const vpLampMap &map() const override { return m_map; }
  std::function<double()> battery() override
  {
    return [this] { return m_base->status().batteryVoltage; };
  }

private:
  class NoPictures : public vpPictureFeed
  {
  public:
    void addOdometry(const vpOdometry &) override {}
    std::optional<vpLocatedPicture> next(double) override { return std::nullopt; }
  };

  vpSteadyClock m_clock;
  vpLampMap m_map;
  NoPictures m_pictures;
  std::unique_ptr<vpRobotTurtleBot3> m_base; // which asks the clock
};

END_VISP_NAMESPACE

#endif
