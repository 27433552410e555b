/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpFaultyWorld_h
#define vpFaultyWorld_h

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include <visp3/core/vpException.h>
#include <visp3/vlp_servo/vpPictureFeed.h>
#include <visp3/vlp_servo/vpPoseSource.h>
#include <visp3/vlp_servo/vpServoClock.h>
#include <visp3/vlp_simulation/vpSimulatorTurtleBot3.h>

#include "common/vpSeenLamps.h"

//! Something that goes wrong for a while.
struct vpServoFault {
  enum class Kind {
    frameLate,       //!< frames reach the localizer size (s) later
    frameLost,       //!< no frames
    frameRepeated,   //!< each shows what the last one before the fault showed
    frameTorn,       //!< its lower part is that of the last one before the fault
    frameTwice,      //!< each is handed over twice
    frameOutOfOrder, //!< every second one is handed over after the next one
    cameraClock,     //!< the camera's clock goes ahead by size (s), or behind
    clock,           //!< so do all clocks, and do not come back
    odometryFrozen,  //!< the same sample again and again
    odometryLate,    //!< samples are there size (s) later
    odometryAbsent,  //!< the driver has none, and says so
    bus,             //!< the base is out of reach
    pose             //!< the estimate is aside by size (m), at a small covariance as before
  };
  static constexpr std::array<const char *, 13> names = {
      "frames late",         "frames lost",  "frames repeated", "frames torn",     "frames twice",
      "frames out of order", "camera clock", "clock of all",    "odometry frozen", "odometry late",
      "no odometry",         "bus fails",    "pose jumps"};

  Kind kind = Kind::frameLost;
  double from = 0, until = 0; // s, of the world
  double size = 0;            // s or m, see above
};

/*!
  Robot, camera, lamps and clocks of a control loop, all of which may fail. Time is simulated. The localizer
  looks at lamps' image points, not at pictures, so that a drive takes milliseconds.

  The robot is that of data/scenarios/servo.yaml, behind the 0.5 s watchdog of OpenCR's firmware. "World" is
  the true time, "host" that of the clock that loop, camera and odometry share.
*/
class vpFaultyWorld : public vpMobileBase, public vpServoClock, public vpPictureFeed
{
public:
  //! A command as the loop gave it.
  struct Command {
    double time = 0; // s, of the world
    vpBaseVelocity asked, told;
  };
  static constexpr double watchdog = 0.5; // s, of the OpenCR's firmware

  vpFaultyWorld(std::vector<vpServoFault> faults, std::uint64_t seed)
      : m_faults(std::move(faults)), m_random(seed), m_robot(robotOf(seed)), m_ceiling(4),
        m_localizer(m_ceiling.rig, m_ceiling.map)
  {
  }

  double world() const { return m_robot.time(); }
  const vpSimulatorTurtleBot3 &robot() const { return m_robot; }
  const std::vector<Command> &commands() const { return m_commands; }
  //! s, of the world, when pictures came to the loop whose time stamps were of 0 to \e oldest before.
  const std::vector<double> &currentPictures() const { return m_current; }
  bool toldToStop() const { return m_stopped; }

  //! The fault of that kind that is on, or none.
  const vpServoFault *fault(vpServoFault::Kind kind) const
  {
    const auto found = std::find_if(m_faults.begin(), m_faults.end(), [&](const vpServoFault &one) {
      const bool over = world() >= one.until && kind != vpServoFault::Kind::clock;
      return one.kind == kind && world() >= one.from && !over;
    });
    return found == m_faults.end() ? nullptr : &*found;
  }

  //! The clock that loop, odometry and camera share, at a time of the world.
  double host(double time) const
  {
    double shown = time;
    for (const vpServoFault &one : m_faults) {
      shown += one.kind == vpServoFault::Kind::clock && time >= one.from ? one.size : 0;
    }
    return shown;
  }

  // vpServoClock
  double period() const override { return 0.02; }
  double now() override { return host(world()); }
  double next() override
  {
    m_robot.advance(static_cast<double>(++m_periods) * period());
    if (world() - m_fed > watchdog) {
      m_robot.stop();
    }
    return now();
  }

  // vpMobileBase
  vpBaseLimits limits() const override { return m_robot.limits(); }
  vpBaseVelocity setVelocity(double v, double w) override
  {
    expectReachable(vpServoFault::Kind::bus);
    m_fed = world();
    m_commands.push_back({world(), {v, w}, m_robot.setVelocity(v, w)});
    return m_commands.back().told;
  }
  void stop() override
  {
    m_stopped = true;
    expectReachable(vpServoFault::Kind::bus);
    m_robot.stop();
    m_commands.push_back({world(), {}, {}});
  }
  vpOdometry odometry() override
  {
    expectReachable(vpServoFault::Kind::bus);
    expectReachable(vpServoFault::Kind::odometryAbsent);
    const vpServoFault *const late = fault(vpServoFault::Kind::odometryLate);
    if (fault(vpServoFault::Kind::odometryFrozen) == nullptr) {
      m_odometry = sampleAt(world() - (late != nullptr ? late->size : 0));
    }
    return m_odometry;
  }

  // vpPictureFeed
  void addOdometry(const vpOdometry &sample) override { m_localizer.filter.addOdometry(sample); }
  std::optional<vpLocatedPicture> next(double now) override
  {
    takeFrames();
    const auto first = std::min_element(m_coming.begin(), m_coming.end(),
                                        [](const Frame &a, const Frame &b) { return a.due < b.due; });
    if (first == m_coming.end() || first->due > world()) {
      return std::nullopt;
    }
    vpLocatedPicture picture;
    picture.timestamp = first->timestamp;
    picture.known = now;
    picture.location = m_localizer.locate(first->timestamp, std::move(first->seen));
    picture.filter = m_localizer.filter;
    m_coming.erase(first);
    if (const double age = now - picture.timestamp; age >= 0 && age <= oldest) {
      m_current.push_back(world());
    }
    return picture;
  }

  static constexpr double oldest = 0.5; // s, that a picture may be to be one of now

private:
  struct Frame {
    double timestamp = 0, due = 0; // s, of the host; of the world
    std::vector<vpLampObservation> seen;
  };

  static vpSimulatorTurtleBot3 robotOf(std::uint64_t seed)
  {
    vpSimulatorTurtleBot3Settings settings;
    settings.seed = seed;
    settings.leftRadiusError = 0.015;
    settings.rightRadiusError = -0.015;
    settings.slip = 0.01;
    settings.slipSigma = 0.002;
    settings.motorLag = 0.03;
    settings.velocityQuantum = settings.motorUnit = settings.encoderTicks = true;
    settings.turnSource = vpSimulatorTurtleBot3Settings::TurnSource::gyro;
    return vpSimulatorTurtleBot3(settings);
  }

  void expectReachable(vpServoFault::Kind unless) const
  {
    if (fault(unless) != nullptr) {
      throw vpException(vpException::ioError, "base: no answer");
    }
  }

  vpOdometry sampleAt(double time) const
  {
    const std::vector<vpOdometry> &samples = m_robot.odometrySamples();
    const auto after = std::upper_bound(samples.begin(), samples.end(), time,
                                        [](double t, const vpOdometry &one) { return t < one.timestamp; });
    vpOdometry sample = after == samples.begin() ? samples.front() : *std::prev(after);
    sample.timestamp = host(sample.timestamp);
    return sample;
  }

  //! The frames that were read out since the last call.
  void takeFrames()
  {
    using Kind = vpServoFault::Kind;
    constexpr double rate = 12, readout = 0.068, compute = 0.02; // Hz, s, s
    for (; m_taken / rate + readout <= world(); ++m_taken) {
      const double time = m_taken / rate;
      std::vector<vpLampObservation> seen = m_ceiling.see(
          time,
          [this](double when) {
            const vpHomogeneousMatrix wMb = m_robot.wMb(std::max(when, 0.0));
            return vpPlannedPlace{wMb[0][3], wMb[1][3], std::atan2(wMb[1][0], wMb[0][0])};
          },
          m_random);
      const vpServoFault *const torn = fault(Kind::frameTorn), *const late = fault(Kind::frameLate),
                                *const ahead = fault(Kind::cameraClock);
      if (fault(Kind::frameRepeated) != nullptr) {
        seen = m_kept;
      } else if (torn != nullptr) {
        seen = tornOf(seen, torn->size);
      } else {
        m_kept = seen;
      }
      Frame frame{host(time) + (ahead != nullptr ? ahead->size : 0), time + readout + compute,
                  std::move(seen)};
      frame.due += late != nullptr ? late->size : 0;
      frame.due += fault(Kind::frameOutOfOrder) != nullptr && m_taken % 2 == 0 ? 1.5 / rate : 0;
      if (fault(Kind::frameLost) != nullptr) {
        continue;
      }
      if (fault(Kind::frameTwice) != nullptr) {
        m_coming.push_back(frame);
      }
      m_coming.push_back(std::move(frame));
    }
  }

  //! The upper \e share of a picture, and the rest of the one that was kept.
  std::vector<vpLampObservation> tornOf(const std::vector<vpLampObservation> &seen, double share) const
  {
    const double line = share * m_ceiling.rig.height;
    std::vector<vpLampObservation> both;
    std::copy_if(seen.begin(), seen.end(), std::back_inserter(both),
                 [line](const vpLampObservation &one) { return one.point.y() < line; });
    std::copy_if(m_kept.begin(), m_kept.end(), std::back_inserter(both),
                 [line](const vpLampObservation &one) { return one.point.y() >= line; });
    return both;
  }

  std::vector<vpServoFault> m_faults;
  std::mt19937_64 m_random;
  vpSimulatorTurtleBot3 m_robot;
  vpSeenLamps m_ceiling;
  vpVlpLocalizer m_localizer;
  std::int64_t m_periods = 0;
  int m_taken = 0;  // frames
  double m_fed = 0; // s, of the world
  bool m_stopped = false;
  vpOdometry m_odometry;
  std::vector<Command> m_commands;
  std::vector<double> m_current;
  std::vector<vpLampObservation> m_kept; // of the last frame without a fault
  std::deque<Frame> m_coming;
};

//! The pose by the lamps of such a world, aside while vpServoFault::Kind::pose is on.
class vpFaultyPose : public vpVlpPose
{
public:
  explicit vpFaultyPose(vpFaultyWorld &world) : vpVlpPose(world), m_world(world) {}
  vpVlpFix at(double time) const override
  {
    vpVlpFix fix = vpVlpPose::at(time);
    if (const vpServoFault *const aside = m_world.fault(vpServoFault::Kind::pose)) {
      fix.wMb[1][3] += aside->size;
    }
    return fix;
  }

private:
  vpFaultyWorld &m_world;
};

#endif
