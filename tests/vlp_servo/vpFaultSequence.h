/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpFaultSequence_h
#define vpFaultSequence_h

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <visp3/vlp_servo/vpServoLoop.h>

#include "vlp_servo/vpFaultyWorld.h"

/*!
  A drive of one line with one to four random faults, and what must hold whatever they are.

  - No command is beyond the limits of speed and acceleration, and the base is never faster than commanded.
  - Without a current picture for 0.8 s it stands: 0.5 s of patience, 0.3 s to brake.
  - An estimate that jumps by 0.1 m or more, and a clock that is set back, bring it to a stand within 0.3 s;
  the latter ends the run.
  - Once the run has ended it stands: within 0.3 s, or, where the base is out of reach, by its watchdog.
*/
class vpFaultSequence
{
public:
  static constexpr double standing = 0.002; // m/s
  static constexpr double toStand = 0.3;    // s, from a command of 0 or its cause
  static constexpr double speed = 0.2;      // m/s, along the path
  static constexpr double longest = 30;     // s, of a run; then somebody ends it

  const Eigen::AlignedBox2d fence{Eigen::Vector2d(-0.3, -0.3), Eigen::Vector2d(0.9, 0.3)}; // m

  explicit vpFaultSequence(std::uint64_t seed) : vpFaultSequence(drawn(seed), seed) {}
  vpFaultSequence(std::vector<vpServoFault> faults, std::uint64_t seed)
      : faults(std::move(faults)), m_world(this->faults, seed), m_poses(m_world)
  {
    vpServoLoopSettings settings;
    settings.follower.reference.speed = speed;
    settings.safety.giveUp = 2;
    settings.safety.fence = fence;
    vpServoLoop loop(m_world, m_poses, m_world, vpPath::polyline({{0, 0}, {0.6, 0}}), settings);
    loop.watch = [this](const vpServoStep &, const auto &) { return m_world.world() < longest; };
    run = loop.run();
    ended = m_world.world();
    while (m_world.world() < ended + 1.5) {
      m_world.next();
    }
    broken = firstBroken(settings);
  }

  std::vector<vpServoFault> faults;
  vpServoRun run;
  double ended = 0;   // s, of the world
  std::string broken; // what does not hold, in one line, or empty

  //! m, from the end of the path, in truth.
  double missedBy() const
  {
    const vpHomogeneousMatrix wMb = m_world.robot().wMb(m_world.world());
    return std::hypot(wMb[0][3] - 0.6, wMb[1][3]);
  }

  //! s, from \e time until it stood for the first time; infinite where it never did.
  double standsAfter(double time) const
  {
    for (double later = time; later < m_world.world(); later += 0.01) {
      if (speedAt(later) < standing) {
        return later - time;
      }
    }
    return std::numeric_limits<double>::infinity();
  }

  //! One of that kind, of random size and time.
  static vpServoFault drawn(vpServoFault::Kind kind, std::mt19937_64 &random)
  {
    using Kind = vpServoFault::Kind;
    const auto within = [&random](double from, double to) {
      return from + (to - from) * static_cast<double>(random() >> 11) * 0x1p-53;
    };
    vpServoFault one;
    one.kind = kind;
    one.from = within(0.1, 4);
    one.until = one.from + std::pow(10, within(-1.5, 0.7)); // 0.03 to 5 s
    if (kind == Kind::cameraClock || kind == Kind::clock) {
      one.size = (random() % 2 == 0 ? -1 : 1) * std::pow(10, within(-2, 1)); // 0.01 to 10 s either way
    } else {
      one.size = within(kind == Kind::pose ? -1 : 0, 1);
    }
    return one;
  }

  //! Pictures are lost, and then torn: a part of each is what the robot saw before.
  static std::vector<vpServoFault> lostThenTorn(std::mt19937_64 &random)
  {
    std::vector<vpServoFault> faults = {drawn(vpServoFault::Kind::frameLost, random),
                                        drawn(vpServoFault::Kind::frameTorn, random)};
    std::uniform_real_distribution<double> lost(0.5, 1.8), torn(1, 2.5), whole(0.3, 0.7);
    faults[0].from = 0.4 + 0.25 * faults[0].from; // under way
    faults[0].until = faults[0].from + lost(random);
    faults[1].from = faults[0].until - 0.1;
    faults[1].until = faults[1].from + torn(random);
    faults[1].size = whole(random);
    return faults;
  }

private:
  static std::vector<vpServoFault> drawn(std::uint64_t seed)
  {
    std::mt19937_64 random(seed);
    std::vector<vpServoFault> faults(1 + random() % 4);
    for (vpServoFault &one : faults) {
      one = drawn(static_cast<vpServoFault::Kind>(random() % vpServoFault::names.size()), random);
    }
    return faults;
  }

  double speedAt(double time) const { return std::abs(m_world.robot().twist(time).v); }

  //! Whether it is faster than that somewhere between.
  bool moves(double from, double to) const
  {
    for (double time = from; time < std::min(to, m_world.world()); time += 0.01) {
      if (speedAt(time) > standing) {
        return true;
      }
    }
    return false;
  }

  std::string firstBroken(const vpServoLoopSettings &settings) const
  {
    for (const std::string &one : {commands(settings.safety), motion(), pictures(), jumps(), clocks(),
                                   places(settings.safety), end()}) {
      if (!one.empty()) {
        return one;
      }
    }
    return "";
  }

  std::string commands(const vpServoSafetySettings &safety) const
  {
    const vpBaseLimits limits = m_world.limits();
    double before = 0;
    for (const vpFaultyWorld::Command &one : m_world.commands()) {
      const double v = one.asked.v, change = std::abs(v) - std::abs(before);
      if (!(limits.share(one.asked) <= 1 + 1e-9 && limits.share(one.told) <= 1 + 1e-9)) {
        return "a command beyond the base's limits";
      }
      if (change > safety.acceleration * m_world.period() + 1e-9) {
        return "a command that speeds up too fast";
      }
      before = v;
    }
    return "";
  }

  std::string motion() const
  {
    constexpr double lag = 0.3;     // s
    constexpr double wheels = 0.02; // they are 1.5 % too large and too small, so that a turn moves it as well
    constexpr double arm = 0.08;    // m, from the base's middle to a wheel
    const std::vector<vpFaultyWorld::Command> &told = m_world.commands();
    size_t first = 0, next = 0;
    for (double time = 0; time < m_world.world(); time += 0.01) {
      for (; next < told.size() && told[next].time <= time; ++next) {
      }
      for (; first + 1 < next && told[first + 1].time < time - lag; ++first) {
      }
      double most = 0;
      for (size_t i = first; i < next; ++i) {
        most =
            std::max(most, (1 + wheels) * std::abs(told[i].told.v) + wheels * arm * std::abs(told[i].told.w));
      }
      if (speedAt(time) > most + 1e-4) {
        return "faster than commanded";
      }
    }
    return "";
  }

  std::string pictures() const
  {
    std::vector<double> times = m_world.currentPictures();
    times.push_back(ended); // from there on end() looks at it
    double last = 0;
    for (const double time : times) {
      if (moves(last + vpFaultyWorld::oldest + toStand, time)) {
        return "moves without a current picture";
      }
      last = time;
    }
    return "";
  }

  //! Of those that nothing else disturbs.
  std::string jumps() const
  {
    for (const vpServoFault &one : faults) {
      const bool alone = std::all_of(faults.begin(), faults.end(), [&](const vpServoFault &other) {
        return &other == &one || other.from > one.from + toStand || other.until + 1 < one.from;
      });
      if (one.kind == vpServoFault::Kind::pose && alone && std::abs(one.size) >= 0.1 &&
          one.from + toStand < ended && !commandedToStand(one.from)) {
        return "follows an estimate that jumps";
      }
    }
    return "";
  }

  //! Whether it was within toStand.
  bool commandedToStand(double from) const
  {
    return std::any_of(m_world.commands().begin(), m_world.commands().end(), [&](const auto &one) {
      return one.time >= from && one.time <= from + toStand && one.told.v == 0 && one.told.w == 0;
    });
  }

  //! As the loop reads it: two steps within a period may undo each other.
  std::string clocks() const
  {
    const double period = m_world.period();
    for (int k = 1; k * period + toStand < ended; ++k) {
      if (m_world.host(k * period) < m_world.host((k - 1) * period)) {
        return "goes on after its clock was set back";
      }
    }
    return "";
  }

  std::string places(const vpServoSafetySettings &safety) const
  {
    if (std::any_of(faults.begin(), faults.end(),
                    [](const vpServoFault &one) { return one.kind == vpServoFault::Kind::pose; })) {
      return "";
    }
    for (double time = 0; time < m_world.world(); time += 0.01) {
      const vpHomogeneousMatrix wMb = m_world.robot().wMb(time);
      if (!fence.contains(Eigen::Vector2d(wMb[0][3], wMb[1][3]))) {
        return "leaves the fence";
      }
    }
    const bool arrived = run.end == vpServoRun::End::arrived;
    return arrived && missedBy() > safety.sigmaStop ? "says that it arrived, and has not" : "";
  }

  std::string end() const
  {
    const bool reached =
        m_world.fault(vpServoFault::Kind::bus) == nullptr &&
        std::none_of(faults.begin(), faults.end(), [this](const vpServoFault &one) {
          return one.kind == vpServoFault::Kind::bus && one.from <= ended && one.until > ended;
        });
    const double within = reached ? toStand : vpFaultyWorld::watchdog + toStand;
    if (!m_world.toldToStop()) {
      return "was not told to stop";
    }
    return moves(ended + within, m_world.world()) ? "moves after the run has ended" : "";
  }

  vpFaultyWorld m_world;
  vpFaultyPose m_poses;
};

#endif
