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

TEST(BoardClock, StaysNearTheTruthThroughDriftRolloverAndLateAnswers)
{
  for (const double error : {0.0, 5e-5, -5e-5}) {
    for (const double notes : {0.001, 0.02}) { // s, from one note of the counter to the next
      std::mt19937_64 random(1);
      std::uniform_real_distribution<double> quick(4e-4, 3e-3), slow(0.01, 0.18);
      vpBoardClock clock;
      double worst = 0, sum = 0;
      int count = 0;
      for (double t = 0.1; t < 600; t += 0.0201) { // the counter rolls over after 300 s
        const double noted = notes * std::floor(t / notes);
        const double millis = std::floor(noted * (1 + error) * 1e3);
        const double arrival = t + (random() % 10 == 0 ? slow(random) : quick(random));
        const double time = clock.hostTime(0u - 300000u + static_cast<std::uint32_t>(millis), arrival);
        ASSERT_LE(time, arrival);
        if (t > 5) { // by then one was read soon after it was noted
          worst = std::max(worst, std::abs(time - noted));
          sum += time - noted;
          ++count;
        }
        t = std::max(t, arrival);
      }
      EXPECT_LT(worst, 0.005) << error << ' ' << notes;
      EXPECT_LT(std::abs(sum / count), 0.002) << error << ' ' << notes;
    }
  }
}

TEST(BoardClock, AClockThatWasSetIsFollowed)
{
  vpBoardClock clock;
  for (std::uint32_t i = 0; i < 100; ++i) {
    EXPECT_NEAR(clock.hostTime(1000 + 20 * i, 50.001 + 0.02 * i), 50.001 + 0.02 * i, 1e-9);
  }
  EXPECT_NEAR(clock.hostTime(90000, 52.001), 52.001, 1e-9); // 87 s in 0.02 s
  EXPECT_NEAR(clock.hostTime(90020, 152.001), 152.001, 1e-9);
}

TEST(BoardClock, TellsARestart)
{
  vpBoardClock clock;
  EXPECT_EQ(clock.sinceLast(5), 0);
  clock.hostTime(0xFFFFFFF0u, 1);
  EXPECT_EQ(clock.sinceLast(0x10), 0x20);
  EXPECT_LT(clock.sinceLast(0xFFFFFF00u), 0);
  clock.reset();
  EXPECT_EQ(clock.sinceLast(7), 0);
}
