/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <functional>
#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <visp3/vlp_robot/vpOpenTurtleBot3.h>
#include <visp3/vlp_robot/vpUsbTransport.h>

#include "common/vpExpectError.h"
#include "opencr/vpDrivenLoop.h"
#include "usb/vpEmulatedUsbBoard.h"

namespace
{
using Owner = vpEmulatedUsbBoard::Owner;

constexpr double motorLag = 0.03; // s
const double longest = 0.65 + motorLag * std::log(0.2 / 0.001);

vpSimulatorTurtleBot3Settings world()
{
  vpSimulatorTurtleBot3Settings settings;
  settings.motorLag = motorLag;
  return settings;
}

struct UsbBoard : testing::Test {
  bool kernelHasIt() { return usb.state().owner == std::array<Owner, 2>{Owner::kernel, Owner::kernel}; }

  vpRealTimeBoard board{world()};
  vpEmulatedUsbBoard usb{board, "FF12"};
};
using UsbTransport = UsbBoard;
} // namespace

TEST_F(UsbTransport, ListsTheBoardsAttached)
{
  EXPECT_TRUE(vpAttachedBoards().empty());
  vpExpectError([] { vpOpenTurtleBot3("opencr:usb"); },
                {"opencr:usb: no such device attached, expected one of VID:PID 0483:5740"});
  usb.plug(7);
  const std::vector<vpAttachedBoard> boards = vpAttachedBoards();
  ASSERT_EQ(boards.size(), 1u);
  EXPECT_EQ(boards[0].uri, "opencr:usb:FF12");
  EXPECT_EQ(boards[0].remark, "USB bus 1 device 7");
  vpExpectError([] { vpOpenTurtleBot3("opencr:usb:FF13"); },
                {"opencr:usb:FF13: no such device attached", "and that serial number"});
  EXPECT_TRUE(kernelHasIt()); // asking takes nothing away
}

TEST_F(UsbTransport, OpensTheLineAndGivesItBack)
{
  usb.plug(7);
  {
    const vpUsbTransport line;
    const vpEmulatedUsbBoard::State state = usb.state();
    EXPECT_EQ(line.name(), "opencr:usb:FF12");
    EXPECT_EQ(state.owner, (std::array<Owner, 2>{Owner::program, Owner::program}));
    EXPECT_EQ(state.lineCoding, (std::array<std::uint8_t, 7>{0x40, 0x42, 0x0F, 0, 0, 0, 8})); // 1 000 000 8N1
    EXPECT_TRUE(state.dtr);
  }
  EXPECT_EQ(usb.state().rtsRaised, 0);
  EXPECT_FALSE(usb.state().dtr);
  EXPECT_TRUE(kernelHasIt());
}

TEST_F(UsbTransport, GivesBackAlsoWhatAKilledProcessLeftDetached)
{
  usb.plug(7);
  vpEmulatedUsbBoard::State state = usb.state();
  state.owner = {Owner::nobody, Owner::nobody};
  usb.setState(state);
  {
    const vpUsbTransport line;
  }
  EXPECT_TRUE(kernelHasIt());
}

TEST_F(UsbTransport, ABoardInUseIsRefused)
{
  usb.plug(7);
  const vpUsbTransport line;
  vpExpectError([] { vpUsbTransport second; }, {"opencr:usb", "is in use"});
  EXPECT_EQ(usb.state().owner, (std::array<Owner, 2>{Owner::program, Owner::program}));
  EXPECT_TRUE(usb.state().dtr);
}

TEST_F(UsbTransport, OfTwoBoardsOneHasToBeNamed)
{
  vpRealTimeBoard secondBoard;
  vpEmulatedUsbBoard second(secondBoard, "FF34");
  usb.plug(7);
  second.plug(9);
  EXPECT_EQ(vpAttachedBoards().size(), 2u);
  vpExpectError([] { vpUsbTransport line; },
                {"opencr:usb: 2 devices attached, expected one of:", " opencr:usb:FF12", " opencr:usb:FF34"});
  EXPECT_EQ(vpUsbTransport("FF34").name(), "opencr:usb:FF34");
  EXPECT_EQ(usb.state().claims, 0);
  EXPECT_EQ(second.state().claims, 2);
}

TEST_F(UsbTransport, DrivesTheBase)
{
  usb.plug(7);
  {
    const auto base = vpOpenTurtleBot3("opencr:usb:FF12");
    vpOdometryWay way = vpDriveInRealTime(*base, {0.2, 0}, 1);
    base->stop();
    EXPECT_LT(vpStandstillAfter(board, vpTimeOf(board)), motorLag * std::log(0.2 / 0.001) + 0.021);
    way.add(base->odometry());
    EXPECT_GT(way.metres, 0.1);
    EXPECT_NEAR(way.metres, vpWayOf(board), 0.0002);
    EXPECT_EQ(base->statistics().timeouts, 0u);
  }
  EXPECT_TRUE(kernelHasIt());
}

TEST_F(UsbTransport, LosesNoTickOnABadLine)
{
  usb.plug(7);
  const auto base = vpOpenTurtleBot3("opencr:usb");
  vpExpectNoTickLost(board, *base, motorLag);
}

TEST_F(UsbTransport, PulledWhileDrivingItStandsAndComesBack)
{
  usb.plug(7);
  const auto base = vpOpenTurtleBot3("opencr:usb");
  vpDriveInRealTime(*base, {0.2, 0}, 0.5);
  const double pulled = vpTimeOf(board);
  usb.unplug();
  vpExpectError([&] { vpDriveInRealTime(*base, {0.2, 0}, 1); }, {"opencr:usb:FF12: ", "No such device"});
  EXPECT_FALSE(base->connected());
  EXPECT_LT(vpStandstillAfter(board, pulled), longest);
  vpExpectError([&] { base->reconnect(); }, {"opencr:usb:FF12: no such device attached"});
  vpExpectError([&] { base->stop(); }, {"opencr:usb:FF12: is not open"});

  usb.plug(8); // as a new device
  base->reconnect();
  vpDriveInRealTime(*base, {0.1, 0}, 0.5);
  EXPECT_NEAR(vpSpeedOf(board), 0.1, 0.005);
}

//! Pulled at one request after the other of opening, driving and stopping: each goes on until it is lost,
//! since how many requests a while takes differs from run to run.
TEST_F(UsbTransport, PulledAtAnyRequestIsAnErrorThatNamesIt)
{
  std::unique_ptr<vpRobotTurtleBot3> base;
  const auto open = [&] {
    usb.plug(7);
    base = vpOpenTurtleBot3("opencr:usb");
  };
  const auto drive = [&] { vpDriveInRealTime(*base, {0.2, 0}, 60); };
  const auto expectLost = [&](const std::string &during, int request, const std::function<void()> &work) {
    SCOPED_TRACE(during + ", request " + std::to_string(request));
    usb.loseAt(request);
    vpExpectError(work, {"opencr:usb"});
    const double pulled = vpTimeOf(board);
    usb.unplug();
    EXPECT_LT(vpStandstillAfter(board, pulled), longest);
    base.reset();
  };
  for (int request = 1; request <= 12; ++request) {
    usb.plug(7);
    expectLost("opening", request, [&] {
      base = vpOpenTurtleBot3("opencr:usb");
      drive();
    });
  }
  for (const int request : {1, 2, 3, 30, 100, 300}) {
    open();
    expectLost("driving", request, drive);
  }
  for (int request = 1; request <= 6; ++request) {
    open();
    vpDriveInRealTime(*base, {0.2, 0}, 0.1);
    expectLost("stopping", request, [&] {
      for (;;) {
        base->stop();
      }
    });
  }
  open(); // nothing is held that a later one needs
  vpDriveInRealTime(*base, {0.2, 0}, 0.1);
  base.reset();
  EXPECT_TRUE(kernelHasIt());
}

TEST_F(UsbTransport, ADeviceThatHangsIsAnErrorInTime)
{
  usb.plug(7);
  const auto base = vpOpenTurtleBot3("opencr:usb");
  vpDriveInRealTime(*base, {0.2, 0}, 0.5);
  vpEmulatedUsbBoard::State state = usb.state();
  state.stalled = true;
  usb.setState(state);
  const double hung = vpTimeOf(board);
  vpExpectError([&] { base->setVelocity(0.2, 0); },
                {"opencr:usb:FF12: write of 1 bytes at 19 to device 200"});
  EXPECT_LT(vpStandstillAfter(board, hung), longest);
}
