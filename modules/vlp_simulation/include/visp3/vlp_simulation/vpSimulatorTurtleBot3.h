/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpSimulatorTurtleBot3_h
#define vpSimulatorTurtleBot3_h

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include <visp3/core/vpHomogeneousMatrix.h>
#include <visp3/vlp_robot/vpTurtleBot3.h>

BEGIN_VISP_NAMESPACE

//! The true robot and its floor. As it comes it is ideal and stands level at the map's origin.
struct VISP_EXPORT vpSimulatorTurtleBot3Settings {
  enum class TurnSource { wheels, gyro };

  vpTurtleBot3::Model model = vpTurtleBot3::Model::burger;
  std::uint64_t seed = 1;

  // Start and floor. The floor is the plane through the map's origin that comes of turning the map's plane
  // z = 0 by the rotation vector (floorTiltX, floorTiltY, 0).
  double startTime = 0;  // s
  double startX = 0;     // m, in w; z is the floor's there
  double startY = 0;     // m, in w
  double startYaw = 0;   // rad about the floor's normal, from the turned x axis of the map
  double floorTiltX = 0; // rad
  double floorTiltY = 0; // rad

  // Geometry: deviations from the kinematics of the model.
  double leftRadiusError = 0;  // share: the true radius is (1 + error) times the model's
  double rightRadiusError = 0; // share
  double separationError = 0;  // share

  // Slip: a wheel that rolls d moves the base by d (1 - slip - deviation), of which its encoder knows
  // nothing. The deviation of each wheel is random, normal, its correlation exp(-d / slipLength): after a
  // distance D >> slipLength it adds up to a standard deviation of slipSigma sqrt(2 slipLength D).
  double slip = 0;          // share, common to both wheels
  double slipSigma = 0;     // share, standard deviation of each wheel's deviation
  double slipLength = 0.05; // m rolled

  // Motors: the command arrives late, each wheel's goal is ramped, the wheel follows it with a lag.
  double commandDelay = 0;                                       // s
  double acceleration = std::numeric_limits<double>::infinity(); // m/s^2 at each wheel's rim
  double motorLag = 0;                                           // s, time constant

  // Commands: whole hundredths, see vpVelocityRounding, and in the firmware the wheels' goals.
  bool velocityQuantum = false;
  bool dither = true;     // with velocityQuantum: the host carries the remainder over
  bool motorUnit = false; // wheel goals truncated to units of 0.229 rpm: 0.01 m/s becomes 0.0095 m/s

  // Odometry.
  double odometryRate = 50;                   // Hz
  bool encoderTicks = false;                  // readings are whole ticks, vpTurtleBot3::tick
  double encoderSigma = 0;                    // rad, of each reading of a wheel's angle
  TurnSource turnSource = TurnSource::wheels; // of vpOdometry::w
  double gyroNoiseDensity = 0;                // rad/s/sqrt(Hz): a mean over T is off by density / sqrt(T)
  double gyroBias = 0;                        // rad/s, constant

  //! \throw vpException (badValue) with one line: the field, what came and what was expected.
  void check() const;
};

/*!
  A TurtleBot3 that drives on a floor in simulation and knows its true pose at every past moment.

  Model: a unicycle (no sideways slip) of two wheels. In steps of 1 ms the wheels' angles follow from ramp and
  lag in closed form, and the base moves along the arc of constant v and w that belongs to them: with wheel
  angles dL, dR the true lengths l, r = R_true d (1 - slip), the arc's length (l + r) / 2 and its turn
  (r - l) / s_true. Between steps the pose is on that very arc. Commands take effect at the first full step at
  or after their arrival.

  The same settings and the same commands at the same times give the same bytes, however advance() is cut into
  pieces. Random numbers are of std::mt19937_64, whose output the C++ standard fixes, seeded from `seed` for
  slip, encoders and gyro apart: changing one setting leaves the noise of the others as it was.

  It has no watchdog: a command stays in force for ever. The host's part (saturation, rounding) is in
  setVelocity(); a command of whole hundredths passes it unchanged, so an emulated OpenCR can drive it too.

  Const methods may run in several threads as long as no other method does. Memory: 40 bytes per step, 144 MB
  per hour of driving.

  \code
  vpSimulatorTurtleBot3Settings settings;
  settings.motorLag = 0.03;
  vpSimulatorTurtleBot3 robot(settings);
  robot.setVelocity(0.1, 0.5);
  robot.advance(2.0);
  const vpHomogeneousMatrix wMb = robot.wMb(1.2345);
  \endcode
*/
class VISP_EXPORT vpSimulatorTurtleBot3 : public vpMobileBase
{
public:
  //! \throw vpException (badValue) where the settings are out of range, see vpSimulatorTurtleBot3Settings.
  explicit vpSimulatorTurtleBot3(const vpSimulatorTurtleBot3Settings &settings);
  ~vpSimulatorTurtleBot3() override;

  //! Given at time(), in force commandDelay later.
  vpBaseVelocity setVelocity(double v, double w) override;
  void stop() override;
  //! The newest sample at or before time().
  vpOdometry odometry() override { return odometrySamples().back(); }
  vpBaseLimits limits() const override;

  /*!
    Lets the world run up to \e untilTime, s. \throw vpException (badValue) where that is before time(), or
    more than 6 hours after the start.
  */
  void advance(double untilTime);

  //! s, up to which the world has run.
  double time() const;

  /*!
    True pose of the base in the map at \e time, s, from startTime to time(): its origin on the floor, its z
    axis the floor's normal. Takes well below a microsecond. \throw vpException (badValue) for other times.
  */
  vpHomogeneousMatrix wMb(double time) const;

  //! True velocity at \e time: along x and about z of b. \throw vpException (badValue) as wMb().
  vpBaseVelocity twist(double time) const;

  //! Samples up to time(), at startTime + n / odometryRate. The first is that of the start, v = w = 0.
  const std::vector<vpOdometry> &odometrySamples() const;

  //! What the motors do at time(): angles rolled since the start, rad, and speeds, rad/s, without noise.
  vpWheels wheelAngles() const;
  vpWheels wheelSpeeds() const;

private:
  class Impl;
  std::unique_ptr<Impl> m_impl;
};

END_VISP_NAMESPACE

#endif
