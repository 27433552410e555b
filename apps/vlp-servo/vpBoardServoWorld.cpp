/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpBoardServoWorld.h"

#include <visp3/vlp_core/vpHostTime.h>
#include <visp3/vlp_localization/vpVlpLocalizer.h>
#include <visp3/vlp_robot/vpOpenTurtleBot3.h>

BEGIN_VISP_NAMESPACE

vpBoardServoWorld::vpBoardServoWorld(const vpVlpServoOptions &options)
    : m_clock(vpServoSimulationSettings().period)
{
  if (!options.lampsFile.empty()) {
    m_map = vpLampMap::load(options.lampsFile);
  }
  vpRobotTurtleBot3Settings settings;
  settings.clock = vpHostTime;
  m_base = vpOpenTurtleBot3(options.robot, settings);
  if (options.pose != vpVlpServoOptions::Pose::lamps) {
    m_pictures = std::make_unique<vpNoPictures>();
    return;
  }
  const vpVlpRig rig = vpVlpRig::load(options.rigFile);
  m_camera = options.camera.open(rig, [this] { return m_closing.load(); });
  m_pictures = std::make_unique<vpLivePictures>(*m_camera, vpVlpLocalizer(rig, m_map),
                                                [this] { return m_clock.now(); });
}

END_VISP_NAMESPACE
