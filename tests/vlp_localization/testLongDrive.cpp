/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// An hour of driving in simulated time: memory stays as it is, and so does the error.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>
#include <visp3/vlp_localization/vpVlpLocalizer.h>

#include "common/vpAllocatedMemory.h"
#include "common/vpSeenLamps.h"

namespace
{
// As sanitizers do.
#if defined(__clang__)
const bool keepsWhatWasFreed = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#elif defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
const bool keepsWhatWasFreed = true;
#else
const bool keepsWhatWasFreed = false;
#endif

constexpr double minute = 60, hour = 3600; // s

//! Round and round on a circle of 0.3 m.
vpPlannedPlace at(double t)
{
  constexpr double radius = 0.3, speed = 0.1; // m, m/s
  const double angle = speed / radius * t;
  return {radius * std::cos(angle), radius * std::sin(angle), angle + M_PI / 2};
}

//! Of four lamps. Each is dark for 2 s in a minute, now and then several, and all of them for a second.
std::vector<bool> litAt(double t)
{
  const double second = std::fmod(t, minute);
  std::vector<bool> lit;
  for (int lamp = 0; lamp < 4; ++lamp) {
    const double from = 10.0 * lamp, with = 1.5 * lamp + 40;
    lit.push_back(!(second >= from && second < from + 2) && !(second >= with && second < 46) &&
                  !(second >= 50 && second < 51));
  }
  return lit;
}

//! MiB of this process that are in memory.
double resident()
{
  std::ifstream file("/proc/self/statm");
  double size = 0, pages = 0;
  file >> size >> pages;
  return pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
}
} // namespace

TEST(LongDrive, MemoryAndErrorStayAsTheyAre)
{
  const vpSeenLamps ceiling(4);
  vpVlpLocalizer localizer(ceiling.rig, ceiling.map);
  std::mt19937_64 generator(1);
  const double frameInterval = 1.0 / 12, sampleInterval = 0.02; // s
  double sampled = 0, residentBefore = 0, allocatedBefore = 0;
  double early = 0, late = 0; // m, the largest error of the first and of the last ten minutes
  size_t poses = 0, frames = 0;
  for (double t = 1; t < hour; t += frameInterval) {
    for (; sampled <= t; sampled += sampleInterval) {
      localizer.filter.addOdometry({sampled, 0.1, 0.1 / 0.3});
    }
    const vpVlpLocation location = localizer.locate(t, ceiling.see(t, at, generator, litAt(t)));
    ++frames;
    if (location.fix.valid) {
      ++poses;
      const vpPlannedPlace truth = at(t);
      const double error = std::hypot(location.fix.wMb[0][3] - truth.x, location.fix.wMb[1][3] - truth.y);
      early = t < 10 * minute ? std::max(early, error) : early;
      late = t > hour - 10 * minute ? std::max(late, error) : late;
    }
    if (residentBefore == 0 && t > 2 * minute) { // all that happens has happened once
      residentBefore = resident();
      allocatedBefore = vpAllocatedMemory();
    }
  }
  EXPECT_GT(static_cast<double>(poses), 0.99 * static_cast<double>(frames));
  EXPECT_LT(early, 0.01);
  EXPECT_LT(late, 0.01);
  EXPECT_LT(vpAllocatedMemory() - allocatedBefore, 0.1);
  if (!keepsWhatWasFreed) {
    EXPECT_LT(resident() - residentBefore, 1);
  }
}
