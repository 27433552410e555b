/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpRobotMotion_h
#define vpRobotMotion_h

#include <vector>

#include <visp3/core/vpHomogeneousMatrix.h>
#include <visp3/vlp_robot/vpOdometry.h>
#include <visp3/vlp_simulation/vpSimulatorTurtleBot3.h>

BEGIN_VISP_NAMESPACE

//! Where a robot goes: its true pose over the time of a run, from 0 on.
class VISP_EXPORT vpRobotMotion
{
public:
  virtual ~vpRobotMotion() = default;

  //! Pose wMb of the base in the map at \e time, s. Before the start it stands there; it may let the world
  //! run on.
  virtual vpHomogeneousMatrix wMb(double time) = 0;

  //! s, after which it stands still.
  virtual double duration() const = 0;

  //! Wheel odometry up to the latest time asked for; nothing of a robot that is put in places.
  virtual std::vector<vpOdometry> odometry() const { return {}; }
};

//! A robot that somebody puts in one place after the other.
class VISP_EXPORT vpStationMotion : public vpRobotMotion
{
public:
  //! \e hold: s in each place. \throw vpException (badValue) where there is no place, or hold is not above 0.
  vpStationMotion(const std::vector<vpHomogeneousMatrix> &places, double hold);

  vpHomogeneousMatrix wMb(double time) override;
  double duration() const override { return m_hold * static_cast<double>(m_places.size()); }

private:
  std::vector<vpHomogeneousMatrix> m_places;
  double m_hold; // s
};

//! A command and how long it holds.
struct VISP_EXPORT vpTimedVelocity {
  vpBaseVelocity velocity;
  double duration = 0; // s
};

//! A TurtleBot that is given commands, one after the other.
class VISP_EXPORT vpDrivenMotion : public vpRobotMotion
{
public:
  //! \throw vpException (badValue) where there is no command, or a duration is not above 0.
  vpDrivenMotion(const vpSimulatorTurtleBot3Settings &robot, const std::vector<vpTimedVelocity> &commands);

  vpHomogeneousMatrix wMb(double time) override;
  double duration() const override { return m_duration; }
  std::vector<vpOdometry> odometry() const override;

private:
  void advance(double time);

  vpSimulatorTurtleBot3 m_robot;
  std::vector<vpTimedVelocity> m_commands;
  double m_start;        // s
  double m_latest;       // s, asked for
  size_t m_next = 0;     // command to be given
  double m_nextTime;     // s, when
  double m_duration = 0; // s
};

END_VISP_NAMESPACE

#endif
