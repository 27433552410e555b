/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// How much longer than usual a single frame may take, from picture to pose: 10 000 frames of simulated
// drives. bench_slowest [FRAMES [SCENARIO...]]; default 10000 of all that drive for long; from the top of the
// repository

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include <opencv2/core/utility.hpp>
#include <visp3/core/vpException.h>
#include <visp3/vlp_localization/vpVlpLocalizer.h>
#include <visp3/vlp_simulation/vpSimulation.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
//! Of this thread alone: what other programs take of the processor is no matter.
double processorTime() // s
{
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

struct Frame {
  double duration; // s
  std::uint64_t seed;
  double timestamp; // s, of its drive
  bool fix;
};

//! Of one drive after the other, each with another seed.
std::vector<Frame> drive(const std::string &name, size_t most)
{
  std::vector<Frame> frames;
  for (std::uint64_t seed = 1; frames.size() < most; ++seed) {
    vpSimulation simulation(vpScenario::load("data/scenarios/" + name + ".yaml"), seed);
    vpVlpLocalizer localizer(simulation.rig(), simulation.map());
    size_t odometry = 0;
    for (vpVlpFrame frame; frames.size() < most && simulation.next(frame);) {
      const std::vector<vpOdometry> samples = simulation.odometry();
      const double before = processorTime();
      for (; odometry < samples.size(); ++odometry) {
        localizer.filter.addOdometry(samples[odometry]);
      }
      const bool fix = localizer.process(frame).fix.valid;
      frames.push_back({processorTime() - before, seed, frame.timestamp, fix});
    }
  }
  return frames;
}

void print(const std::string &name, std::vector<Frame> frames)
{
  std::sort(frames.begin(), frames.end(),
            [](const Frame &a, const Frame &b) { return a.duration < b.duration; });
  const auto at = [&frames](double share) {
    return frames[static_cast<size_t>(share * static_cast<double>(frames.size() - 1))].duration;
  };
  const Frame &slowest = frames.back();
  std::printf("| %s | %zu | %.2f | %.2f | %.2f | %.2f | %.1f | seed %llu, %.2f s%s |\n", name.c_str(),
              frames.size(), 1e3 * at(0.5), 1e3 * at(0.99), 1e3 * at(0.999), 1e3 * slowest.duration,
              slowest.duration / at(0.5), static_cast<unsigned long long>(slowest.seed), slowest.timestamp,
              slowest.fix ? "" : ", no position");
  std::fflush(stdout);
}
} // namespace

int main(int argc, char **argv)
{
  const long frames = argc > 1 ? std::atol(argv[1]) : 10000;
  std::vector<std::string> names(argv + std::min(argc, 2), argv + argc);
  if (frames < 1) {
    std::fprintf(stderr, "usage: bench_slowest [FRAMES [SCENARIO...]], FRAMES 1 or more of each scenario\n");
    return 2;
  }
  if (names.empty()) {
    names = {"straight", "curve", "spin", "hall", "people", "hidden-lamps", "one-lamp"};
  }
  cv::setNumThreads(1);
  std::printf("| drive | frames | median, ms | 99 %% | 99.9 %% | largest | largest / median | when |\n"
              "|---|---|---|---|---|---|---|---|\n");
  try {
    for (const std::string &name : names) {
      print(name, drive(name, static_cast<size_t>(frames)));
    }
  } catch (const vpException &e) {
    std::fprintf(stderr, "bench_slowest: %s\n", e.getMessage());
    return 1;
  }
  return 0;
}
