/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <gtest/gtest.h>
#include <visp3/vlp_robot/vpDynamixelBus.h>

#include "common/vpExpectError.h"
#include "opencr/vpEmulatedTurtleBot3.h"

using Table = vpOpenCrTable;

namespace
{
struct BusOverBoard : testing::Test {
  std::uint8_t heartbeat() { return emulated.board.table().get(Table::heartbeat); }
  double soon() { return bus.now() + 0.2; }

  vpEmulatedTurtleBot3 emulated;
  vpDynamixelBus bus{emulated.takeLine()};
};
using DynamixelBus = BusOverBoard;
} // namespace

TEST_F(DynamixelBus, PingsReadsAndWrites)
{
  EXPECT_EQ(bus.ping(200, soon()).model, 0x5000);
  EXPECT_EQ(bus.ping(200, soon()).firmware, 5);
  EXPECT_EQ(bus.read(200, 2, 4, soon()), (std::vector<std::uint8_t>{1, 0, 0, 0}));
  bus.write(200, 19, {7}, soon());
  EXPECT_EQ(heartbeat(), 7);
  EXPECT_EQ(bus.read(200, 10, 172, soon()).size(), 172u);
  EXPECT_FALSE(bus.answerMayBeStale());
  const vpDynamixelStatistics statistics = bus.statistics();
  EXPECT_EQ(statistics.transactions, 5u);
  EXPECT_EQ(statistics.attempts, 5u);
  EXPECT_EQ(statistics.timeouts + statistics.crcErrors + statistics.foreign + statistics.failures, 0u);
}

TEST_F(DynamixelBus, ErrorsSayWhatTheyMean)
{
  emulated.board.failNext(vpDynamixelPacket::dataLimit);
  vpExpectError([&] { bus.write(200, 19, {7}, soon()); },
                {"emulated board: write of 1 bytes at 19 to device 200: answered with data limit error"});
  EXPECT_EQ(heartbeat(), 0);
  emulated.board.failNext(vpDynamixelPacket::access);
  vpExpectError([&] { bus.read(200, 10, 172, soon()); },
                {"read of 172 bytes at 10 of device 200", "access error"});
  vpExpectError([&] { bus.read(200, 100, 172, soon()); }, {"data range error"});
  emulated.board.failNext(0x80); // an alert alone is no error
  bus.ping(200, soon());
  EXPECT_TRUE(bus.statistics().alert);
}

TEST_F(DynamixelBus, AnotherDeviceDoesNotAnswer)
{
  const double begin = bus.now();
  vpExpectError(
      [&] { bus.ping(1, begin + 0.2); },
      {"emulated board: ping of device 1: ", " attempts within 200 ms, ", " unanswered and 0 corrupted"});
  EXPECT_NEAR(bus.now(), begin + 0.2, 0.001);
  EXPECT_EQ(bus.statistics().failures, 1u);
  EXPECT_GE(bus.statistics().attempts, 5u); // one in 34 ms
}

TEST_F(DynamixelBus, ARequestThatTheDeviceSawCorruptedIsRepeatedAtOnce)
{
  emulated.board.failNext(vpDynamixelPacket::crcError);
  const double begin = bus.now();
  bus.write(200, 19, {7}, soon());
  EXPECT_EQ(heartbeat(), 7);
  EXPECT_LT(bus.now() - begin, 0.01);
  EXPECT_EQ(bus.statistics().crcErrors, 1u);
}

//! The protocol numbers no answer: what comes late must not pass for the answer to a later request.
TEST_F(DynamixelBus, LateAnswersMayBeStale)
{
  vpFaultyLine::Faults late;
  late.delayed = 1;
  late.delay = 0.05;
  emulated.line->setFaults(late);
  bus.write(200, 19, {1}, soon()); // its second attempt takes the answer to its first
  EXPECT_TRUE(bus.answerMayBeStale());
  EXPECT_EQ(bus.statistics().timeouts, 1u);
  emulated.line->setFaults({});
  EXPECT_EQ(bus.read(200, 19, 1, soon()).size(), 1u); // an answer of another length is passed over
  EXPECT_GE(bus.statistics().foreign, 1u);
  const double begin = bus.now();
  bus.settle();
  EXPECT_FALSE(bus.answerMayBeStale());
  EXPECT_LE(bus.now(), begin + bus.lateAnswerTime);
}

TEST_F(DynamixelBus, WhatMustNotBeDoneTwiceIsSentOnce)
{
  vpFaultyLine::Faults late;
  late.delayed = 1;
  late.delay = 0.15;
  emulated.line->setFaults(late);
  emulated.board.clearRequests();
  bus.writeOnce(200, 19, {3}, soon());
  EXPECT_EQ(emulated.board.requests().size(), 1u);
  late.lost = 1;
  emulated.line->setFaults(late);
  vpExpectError([&] { bus.writeOnce(200, 19, {4}, soon()); }, {": 1 attempts within 200 ms"});
}

TEST_F(DynamixelBus, GivesRightAnswersOnABadLineOrNone)
{
  for (const double share : {0.0002, 0.002, 0.02}) {
    vpFaultyLine::Faults faults;
    faults.corrupted = share;
    faults.lost = share / 4;
    faults.delayed = share;
    emulated.line->setFaults(faults);
    int right = 0, failed = 0;
    for (int i = 0; i < 1000; ++i) {
      emulated.board.clearRequests();
      try {
        const std::vector<std::uint8_t> got = bus.read(200, 10, 172, soon());
        bool sent = false;
        for (const vpOpenCrEmulator::Request &request : emulated.board.requests()) {
          sent |= request.answer == got;
        }
        right += sent || bus.answerMayBeStale(); // then it may be an answer from before
      } catch (const vpException &) {
        ++failed;
      }
    }
    EXPECT_EQ(right + failed, 1000) << share;
    EXPECT_GT(right, share < 0.01 ? 980 : 0) << share; // at 2 % one attempt in 70 gets through whole
  }
}
