/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <visp3/vlp_robot/vpBoardClock.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
//! A board whose counter began at \e first and is fast by \e error.
std::uint32_t millisAt(double time, std::uint32_t first, double error)
{
  return first + static_cast<std::uint32_t>(std::floor(time * (1 + error) * 1e3));
}
} // namespace

TEST(BoardClock, StaysNearTheTruthThroughDriftRolloverAndSlowAnswers)
{
  for (const double error : {0.0, 1.5e-4, -1.5e-4}) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> quick(2e-4, 1.5e-3), slow(0.01, 0.08);
    vpBoardClock clock;
    double last = -1, worst = 0;
    for (double t = 0.1; t < 600; t += 0.02) { // the counter rolls over after 300 s
      const bool late = random() % 10 == 0;
      const double from = t - quick(random), until = t + (late ? slow(random) : quick(random));
      const double time = clock.hostTime(millisAt(t, 0u - 300000u, error), from, until);
      ASSERT_GE(time, from);
      ASSERT_LE(time, until);
      ASSERT_GT(time, last);
      last = time;
      worst = std::max(worst, std::abs(time - t));
      t = std::max(t, until);
    }
    EXPECT_LT(worst, 1.5e-3) << error;
  }
}

TEST(BoardClock, AClockThatWasSetIsFollowed)
{
  vpBoardClock clock;
  for (int i = 0; i < 100; ++i) {
    clock.hostTime(1000 + 20 * i, 50 + 0.02 * i, 50 + 0.02 * i + 0.001);
  }
  const double time = clock.hostTime(90000, 52, 52.002); // 87 s in 0.02 s
  EXPECT_GE(time, 52);
  EXPECT_LE(time, 52.002);
}

TEST(BoardClock, TellsARestart)
{
  vpBoardClock clock;
  EXPECT_EQ(clock.sinceLast(5), 0);
  clock.hostTime(0xFFFFFFF0u, 1, 1.001);
  EXPECT_EQ(clock.sinceLast(0x10), 0x20);
  EXPECT_LT(clock.sinceLast(0x7FFFFF00u - 0x80000000u), 0);
  clock.reset();
  EXPECT_EQ(clock.sinceLast(7), 0);
}
