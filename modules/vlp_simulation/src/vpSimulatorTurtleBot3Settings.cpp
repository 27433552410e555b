/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_simulation/vpSimulatorTurtleBot3.h>

#include <cmath>
#include <string>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

BEGIN_VISP_NAMESPACE

namespace
{
constexpr double infinity = std::numeric_limits<double>::infinity();

//! \e least and \e most included. False for NaN.
void expectWithin(const char *field, double value, double least, double most, const char *unit)
{
  if (value >= least && value <= most) {
    return;
  }
  std::string expected = vpNumberText(least) + " or more";
  if (most < infinity) {
    expected = vpNumberText(least) + " to " + vpNumberText(most);
  }
  throw vpException(vpException::badValue, std::string("simulated TurtleBot3: ") + field + ": " +
                                               vpNumberText(value) + ", expected " + expected + unit);
}
} // namespace

void vpSimulatorTurtleBot3Settings::check() const
{
  expectWithin("startTime", startTime, -4e9, 4e9, " s"); // beyond, doubles do not resolve the steps of 1 ms
  expectWithin("startX", startX, -1e4, 1e4, " m");
  expectWithin("startY", startY, -1e4, 1e4, " m");
  expectWithin("startYaw", startYaw, -100, 100, " rad");
  expectWithin("floorTiltX", floorTiltX, -0.5, 0.5, " rad");
  expectWithin("floorTiltY", floorTiltY, -0.5, 0.5, " rad");
  expectWithin("leftRadiusError", leftRadiusError, -0.5, 0.5, ", a share");
  expectWithin("rightRadiusError", rightRadiusError, -0.5, 0.5, ", a share");
  expectWithin("separationError", separationError, -0.5, 0.5, ", a share");
  expectWithin("slip", slip, 0, 1, ", a share");
  expectWithin("slipSigma", slipSigma, 0, 0.5, ", a share");
  expectWithin("slipLength", slipLength, 1e-6, 1e6, " m");
  expectWithin("commandDelay", commandDelay, 0, 60, " s");
  expectWithin("acceleration", acceleration, 1e-6, infinity, " m/s^2");
  expectWithin("motorLag", motorLag, 0, 60, " s");
  expectWithin("odometryRate", odometryRate, 0.01, 1000, " Hz");
  expectWithin("encoderSigma", encoderSigma, 0, 1, " rad");
  expectWithin("gyroNoiseDensity", gyroNoiseDensity, 0, 10, " rad/s/sqrt(Hz)");
  expectWithin("gyroBias", gyroBias, -10, 10, " rad/s");
}

END_VISP_NAMESPACE
