/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpBoardServoWorld.h"

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_robot/vpOpenTurtleBot3.h>

BEGIN_VISP_NAMESPACE

vpBoardServoWorld::vpBoardServoWorld(const vpVlpServoOptions &options)
    : m_clock(vpServoSimulationSettings().period)
{
  if (options.pose == vpVlpServoOptions::Pose::lamps) {
    throw vpException(vpException::notImplementedError,
                      "--camera: " + vpShown(options.camera) +
                          ", for which this build has no driver, expected --odometry-only or --open-loop");
  }
  if (!options.lampsFile.empty()) {
    m_map = vpLampMap::load(options.lampsFile);
  }
  vpRobotTurtleBot3Settings settings;
  settings.clock = [this] { return m_clock.now(); };
  m_base = vpOpenTurtleBot3(options.robot, settings);
}

END_VISP_NAMESPACE
