/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// A robot that is put elsewhere between two frames: the lamps' middles are simulated, no picture is
// (vpSeenLamps). "2, then 1": after the jump one lamp shines. bench_jumps [JUMPS of each row] (500)

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "common/vpSeenLamps.h"
#include "vpSimulatedStripes.h"

namespace
{
struct Outcome {
  int jumps = 0, frames = 0, fixes = 0;
  int beyond = 0;      // poses beyond five of their standard deviations
  int late = 0;        // jumps after which the third frame has no pose within a centimetre
  double worst = 0;    // standard deviations
  double farthest = 0; // m, error of such a pose
};

struct Robot {
  const char *text;
  bool drives, tells; // what its wheels do
};

//! \param left How many lamps shine after the jump.
Outcome jump(size_t lamps, size_t left, double framesPerSecond, const Robot &robot,
             std::mt19937_64 &generator)
{
  std::uniform_real_distribution<double> uniform;
  const double far = 0.01 + 0.34 * uniform(generator), where = 2 * M_PI * uniform(generator),
               turn = (uniform(generator) - 0.5) * M_PI;
  const vpPlannedPlace start{0.2 * (uniform(generator) - 0.5), 0.2 * (uniform(generator) - 0.5),
                             2 * M_PI * uniform(generator)};
  const vpPlannedDrive path(start, {{4, robot.drives ? 0.1 : 0, robot.drives ? 0.3 : 0}});
  const int before = 12, after = 8;                   // frames
  const double at = (before - 0.2) / framesPerSecond; // s, when it is put elsewhere
  const vpPlannedPlace from = path.at(at);
  const auto place = [&](double t) {
    vpPlannedPlace p = path.at(t);
    if (t >= at) {
      const Eigen::Vector2d turned = Eigen::Rotation2Dd(turn) * Eigen::Vector2d(p.x - from.x, p.y - from.y);
      p.x = from.x + turned.x() + far * std::cos(where);
      p.y = from.y + turned.y() + far * std::sin(where);
      p.yaw += turn;
    }
    return p;
  };
  const vpSeenLamps world(lamps);
  vpVlpLocalizer localizer(world.rig, world.map);
  const std::vector<vpOdometry> samples = path.odometry(0.02);
  size_t given = 0;
  Outcome outcome;
  outcome.jumps = 1;
  for (int k = 0; k < before + after; ++k) {
    const double t = k / framesPerSecond;
    static const double read = 0.08; // s after the time stamp: by then the frame is there
    for (; robot.tells && samples[given].timestamp <= t + read; ++given) {
      localizer.filter.addOdometry(samples[given]);
    }
    std::vector<bool> lit(lamps, true);
    std::fill(lit.begin() + (k < before ? static_cast<long>(lamps) : static_cast<long>(left)), lit.end(),
              false);
    const vpVlpLocation location = localizer.locate(t, world.see(t, place, generator, lit));
    const double error = location.fix.valid ? vpErrorOf(location.fix, place(t)) : 1,
                 off = location.fix.valid ? vpSigmasOff(location.fix, place(t)) : 0;
    ++outcome.frames;
    outcome.fixes += location.fix.valid;
    outcome.worst = std::max(outcome.worst, off);
    static const double most = 5; // standard deviations
    if (off > most) {
      ++outcome.beyond;
      outcome.farthest = std::max(outcome.farthest, error);
    }
    static const double right = 0.01; // m
    outcome.late += k == before + 2 && !(error < right);
  }
  return outcome;
}
} // namespace

int main(int argc, char **argv)
{
  const int jumps = argc > 1 ? std::max(1, std::atoi(argv[1])) : 500;
  std::printf("Jumps of 1 to 35 cm and up to 90 degrees; rig and map exact; poses of all frames, 12 before "
              "the jump and 8 "
              "after it.\n\n| lamps | frames a second | robot | jumps | frames with a pose, %% | beyond 5 "
              "sigma | worst, "
              "sigma | farthest of these, mm | not right in the third frame "
              "|\n|---|---|---|---|---|---|---|---|---|\n");
  const std::pair<size_t, size_t> ceilings[] = {{2, 2}, {2, 1}, {3, 3}, {4, 4}}; // lamps, left
  const Robot robots[] = {{"stands", false, false},
                          {"stands, wheels say so", false, true},
                          {"drives", true, false},
                          {"drives, wheels roll on", true, true}};
  for (const auto &[lamps, left] : ceilings) {
    for (const double rate : {10., 12.}) {
      for (const Robot &robot : robots) {
        Outcome all;
        std::mutex mutex;
        vpRunTrials(jumps, [&, count = lamps, shine = left](int, std::mt19937_64 &generator) {
          const Outcome one = jump(count, shine, rate, robot, generator);
          const std::lock_guard<std::mutex> lock(mutex);
          all.jumps += one.jumps;
          all.frames += one.frames;
          all.fixes += one.fixes;
          all.beyond += one.beyond;
          all.late += one.late;
          all.worst = std::max(all.worst, one.worst);
          all.farthest = std::max(all.farthest, one.farthest);
        });
        const bool told = left == lamps; // by one lamp nobody can be right
        std::printf("| %zu%s | %g | %s | %d | %.1f | %d | %.1f | %.1f | %s |\n", lamps,
                    told ? "" : ", then 1", rate, robot.text, all.jumps, 100. * all.fixes / all.frames,
                    all.beyond, all.worst, 1000 * all.farthest,
                    told ? std::to_string(all.late).c_str() : "-");
        std::fflush(stdout);
      }
    }
  }
  return 0;
}
