/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <chrono>
#include <numeric>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <visp3/vlp_robot/vpOpenTurtleBot3.h>
#include <visp3/vlp_robot/vpSerialTransport.h>

#include "common/vpExpectError.h"
#include "common/vpPseudoTerminal.h"
#include "common/vpTemporaryFolder.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

TEST(SerialTransport, CarriesEveryByteBothWays)
{
  vpPseudoTerminal terminal;
  vpSerialTransport line(terminal.device());
  std::vector<std::uint8_t> all(256);
  std::iota(all.begin(), all.end(), std::uint8_t(0)); // those that terminals take for commands among them
  ASSERT_TRUE(line.write(all.data(), all.size(), line.now() + 1));
  EXPECT_EQ(terminal.read(256), all);

  terminal.write(all);
  std::vector<std::uint8_t> got;
  while (got.size() < all.size()) {
    std::uint8_t bytes[100];
    const size_t size = line.read(bytes, sizeof(bytes), line.now() + 1);
    ASSERT_GT(size, 0u);
    got.insert(got.end(), bytes, bytes + size);
  }
  EXPECT_EQ(got, all);
}

TEST(SerialTransport, ReadingEndsAtItsDeadline)
{
  vpPseudoTerminal terminal;
  vpSerialTransport line(terminal.device());
  std::uint8_t byte = 0;
  const double begin = line.now();
  EXPECT_EQ(line.read(&byte, 1, begin + 0.02), 0u);
  EXPECT_GE(line.now(), begin + 0.02);
  EXPECT_EQ(line.read(&byte, 1, begin), 0u); // one in the past

  terminal.write({1, 2, 3});
  ASSERT_EQ(line.read(&byte, 1, line.now() + 1), 1u);
  EXPECT_EQ(byte, 1);
  line.discard();
  EXPECT_EQ(line.read(&byte, 1, line.now() + 0.005), 0u);
}

TEST(SerialTransport, WritingEndsAtItsDeadlineWhereNobodyReads)
{
  vpPseudoTerminal terminal;
  vpSerialTransport line(terminal.device());
  const std::vector<std::uint8_t> much(1 << 20, 7);
  EXPECT_FALSE(line.write(much.data(), much.size(), line.now() + 0.05));
}

TEST(SerialTransport, AHungUpLineIsGoneAndComesBack)
{
  vpTemporaryFolder folder;
  const std::string device = folder / "board"; // a name that stays, as those of udev
  auto terminal = std::make_unique<vpPseudoTerminal>();
  ASSERT_EQ(symlink(terminal->device().c_str(), device.c_str()), 0);
  vpSerialTransport line(device);
  std::uint8_t byte = 0;
  terminal.reset();
  vpExpectError([&] { line.read(&byte, 1, line.now() + 1); },
                {device + ": is gone", "expected a serial device"});
  vpExpectError([&] { line.write(&byte, 1, line.now() + 1); }, {device + ": "});
  unlink(device.c_str());
  vpExpectError([&] { line.reopen(); }, {device + ": cannot be opened (No such file or directory)"});
  vpExpectError([&] { line.discard(); }, {device + ": is gone"});

  terminal = std::make_unique<vpPseudoTerminal>();
  ASSERT_EQ(symlink(terminal->device().c_str(), device.c_str()), 0);
  line.reopen();
  terminal->write({42});
  ASSERT_EQ(line.read(&byte, 1, line.now() + 1), 1u);
  EXPECT_EQ(byte, 42);
}

TEST(SerialTransport, IsForOneAlone)
{
  vpPseudoTerminal terminal;
  {
    vpSerialTransport line(terminal.device());
    vpExpectError([&] { vpSerialTransport second(terminal.device()); },
                  {terminal.device() + ": is in use by another program"});
  }
  vpSerialTransport third(terminal.device()); // given back
}

TEST(OpenTurtleBot3, WrongNamesAreRefused)
{
  for (const std::string uri :
       {"", "opencr:", "opencr:usb:", "opencr:ttyACM0", "opencr:usb2", "sim", "/dev/ttyACM0"}) {
    vpExpectError([&] { vpOpenTurtleBot3(uri); },
                  {"robot: " + uri + ", expected opencr:usb, opencr:usb:SERIAL or a serial device"});
  }
  const vpTemporaryFolder folder;
  const std::string file = folder.write("board", "no device");
  vpExpectError([&] { vpOpenTurtleBot3("opencr:" + file); }, {file + ": is no serial device"});
  vpExpectError([] { vpOpenTurtleBot3("opencr:/dev/none"); },
                {"/dev/none: cannot be opened (No such file or directory), expected a serial device"});
}

TEST(OpenTurtleBot3, BadSettingsAreRefusedBeforeAnythingIsOpened)
{
  vpRobotTurtleBot3Settings settings;
  settings.acceleration = -1;
  vpExpectError([&] { vpOpenTurtleBot3("opencr:/dev/none", settings); },
                {"TurtleBot3: acceleration: -1, expected 0 to 100 m/s^2"});
  settings.acceleration = 0;
  settings.odometryAge = 0;
  vpExpectError([&] { vpOpenTurtleBot3("opencr:/dev/none", settings); },
                {"TurtleBot3: odometryAge: 0, expected 0.001 to 10 s"});
}

TEST(OpenTurtleBot3, ASilentLineIsNoBoard)
{
  vpPseudoTerminal terminal;
  vpExpectError(
      [&] { vpOpenTurtleBot3("opencr:" + terminal.device()); },
      {terminal.device() + ": ping of device 200: ", " attempts within 1", "expected a valid answer"});
}
