/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef simulatedDrive_h
#define simulatedDrive_h

#include <cmath>

#include <visp3/vlp_simulation/vpSimulatorTurtleBot3.h>

BEGIN_VISP_NAMESPACE

//! Heading of a base on a level floor, rad, -pi to pi.
inline double yawOf(const vpHomogeneousMatrix &wMb)
{
  return std::atan2(wMb[1][0], wMb[0][0]);
}

//! Distance in the map between the poses at two times, m.
inline double distance(const vpSimulatorTurtleBot3 &robot, double from, double to)
{
  const vpHomogeneousMatrix a = robot.wMb(from), b = robot.wMb(to);
  return std::hypot(b[0][3] - a[0][3], std::hypot(b[1][3] - a[1][3], b[2][3] - a[2][3]));
}

//! A robot with a bit of everything.
inline vpSimulatorTurtleBot3Settings roughSettings()
{
  vpSimulatorTurtleBot3Settings settings;
  settings.seed = 5;
  settings.startTime = 12.5;
  settings.startX = 0.3;
  settings.startY = -0.2;
  settings.startYaw = 1;
  settings.floorTiltX = 0.005;
  settings.floorTiltY = -0.003;
  settings.leftRadiusError = -0.015;
  settings.rightRadiusError = 0.015;
  settings.separationError = 0.01;
  settings.slip = 0.01;
  settings.slipSigma = 0.02;
  settings.commandDelay = 0.0123;
  settings.acceleration = 1;
  settings.motorLag = 0.03;
  settings.velocityQuantum = true;
  settings.motorUnit = true;
  settings.odometryRate = 60;
  settings.encoderTicks = true;
  settings.encoderSigma = 0.001;
  settings.turnSource = vpSimulatorTurtleBot3Settings::TurnSource::gyro;
  settings.gyroNoiseDensity = 1e-3;
  settings.gyroBias = 0.01;
  return settings;
}

END_VISP_NAMESPACE

#endif
