/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// vlp-lamp, run as a user runs it, and the firmware at the other end of a pseudo-terminal.

#include <atomic>
#include <fstream>
#include <functional>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <unistd.h>

#include <gtest/gtest.h>

#ifdef VLP_FAULTS
#include "common/vpFaultyProcess.h"
#endif
#include "common/vpProcess.h"
#include "vpSimulatedArduino.h"

namespace
{
//! A serial port, and what is plugged in there: \e answer takes what has come and gives what goes back.
class Port
{
public:
  explicit Port(std::function<std::string(const std::string &)> answer) : m_answer(std::move(answer))
  {
    m_file = posix_openpt(O_RDWR | O_NOCTTY);
    if (m_file < 0 || grantpt(m_file) != 0 || unlockpt(m_file) != 0) {
      throw std::runtime_error("no pseudo-terminal");
    }
    m_name = ptsname(m_file);
    m_held = open(m_name.c_str(), O_RDWR | O_NOCTTY); // else it hangs up where nobody has it open
    m_thread = std::thread([this] { serve(); });
  }
  ~Port() { unplug(); }
  Port(const Port &) = delete;
  Port &operator=(const Port &) = delete;

  const std::string &name() const { return m_name; }
  void unplug()
  {
    m_ended = true;
    if (m_thread.joinable()) {
      m_thread.join();
    }
  }

private:
  void serve()
  {
    while (!m_ended) {
      pollfd waited = {m_file, POLLIN, 0};
      char bytes[256];
      const ssize_t size = poll(&waited, 1, 5) > 0 ? read(m_file, bytes, sizeof bytes) : 0;
      const std::string back = m_answer(std::string(bytes, static_cast<size_t>(std::max<ssize_t>(size, 0))));
      if (!back.empty() && write(m_file, back.data(), back.size()) < 0) {
        break;
      }
    }
    close(m_held);
    close(m_file);
  }

  std::function<std::string(const std::string &)> m_answer;
  std::string m_name;
  int m_file = -1, m_held = -1;
  std::atomic<bool> m_ended{false};
  std::thread m_thread;
};

//! A lamp with the firmware, plugged in. It has four times as long as in truth.
std::function<std::string(const std::string &)> firmware(vpSimulatedArduino &lamp)
{
  return [&lamp](const std::string &came) {
    static const double slice = 0.02; // s
    const size_t before = lamp.heard().size();
    lamp.say(came);
    lamp.run(slice);
    return lamp.heard().substr(before);
  };
}

std::string mapFile(const vpTemporaryFolder &folder)
{
  const std::string file = folder / "lamps.yaml";
  std::ofstream(file) << R"(lamps:
  - {id: one, position_m: [0, 0, 2], diameter_m: 0.2, frequency_hz: 2270.148, duty: 0.6}
  - {id: two, position_m: [1, 0, 2], diameter_m: 0.2, frequency_hz: 3000, duty: 0.3, phase_difference: 0.35}
  - {id: word, position_m: [2, 0, 2], diameter_m: 0.2, word: {bits: "01111010110010", chip_rate_hz: 8000, code: manchester}}
  - {id: plain, position_m: [3, 0, 2], diameter_m: 0.2, word: {bits: "0111", chip_rate_hz: 4000, code: ook}}
  - {id: still, position_m: [4, 0, 2], diameter_m: 0.2, unmodulated: true}
)";
  return file;
}

//! Why \e program was not refused with one line that has \e part; empty: it was.
std::string notRefused(vpProcess &program, const std::string &part)
{
  const int code = program.wait();
  const std::string said = program.err();
  const bool oneLine = std::count(said.begin(), said.end(), '\n') == 1;
  return code == 2 && oneLine && said.find(part) != std::string::npos
             ? ""
             : "exit code " + std::to_string(code) + ": " + said + program.out();
}
} // namespace

TEST(VlpLamp, TellsEveryModulation)
{
  const vpTemporaryFolder folder;
  const std::string map = mapFile(folder);
  vpSimulatedArduino lamp(VLP_LAMP_FIRMWARE);
  Port port(firmware(lamp));
  const std::vector<std::pair<std::string, std::string>> expected = {
      {"one", "frequency_hz=2270.148 duty=0.600028"},
      {"two", "frequency_hz=3000.188 duty=0.300019 phase_difference=0.350084"},
      {"word", "bits=01111010110010 chip_rate_hz=8000.000 code=manchester"},
      {"plain", "bits=0111 chip_rate_hz=4000.000 code=ook"},
      {"still", "unmodulated=true"},
  };
  for (const auto &[id, sent] : expected) {
    SCOPED_TRACE(id);
    vpProcess tell("vlp-lamp", {"--port", port.name(), "--map", map, "--lamp", id});
    EXPECT_EQ(tell.wait(), 0) << tell.err();
    EXPECT_EQ(tell.out(), id + "  id=" + id + " " + sent + " clock_hz=16000000\n");
    EXPECT_EQ(tell.err().find("ppm") != std::string::npos, id == "two")
        << "3000 Hz is no whole number of cycles";
    vpProcess show("vlp-lamp", {"--port", port.name(), "--show"});
    EXPECT_EQ(show.wait(), 0) << show.err();
    EXPECT_EQ(show.out(), "id=" + id + " " + sent + " clock_hz=16000000\n");
  }
}

TEST(VlpLamp, WalksThroughAMap)
{
  const vpTemporaryFolder folder;
  std::ofstream(folder / "enter") << "\n\n\n";
  vpSimulatedArduino lamp(VLP_LAMP_FIRMWARE);
  Port port(firmware(lamp));
  vpProcess tell("vlp-lamp", {"--port", port.name(), "--map", mapFile(folder), "--all"}, "",
                 folder / "enter");
  EXPECT_EQ(tell.wait(), 2) << "five lamps, Enter for three";
  const std::string told = tell.out();
  EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 3) << told;
  EXPECT_NE(tell.err().find("plug in plain (4 of 5), press Enter"), std::string::npos) << tell.err();
  EXPECT_NE(tell.err().find("2 lamps are left"), std::string::npos) << tell.err();
}

TEST(VlpLamp, APortWithoutALampIsOneError)
{
  const std::vector<std::pair<std::string, std::function<std::string(const std::string &)>>> others = {
      {"silent", [](const std::string &) { return ""; }},
      {"echo", [](const std::string &came) { return came; }},
      {"garbage",
       [](const std::string &came) { return came.empty() ? "" : std::string("\xff\x00\n\x7f", 4); }},
      {"endless", [](const std::string &) { return std::string(200, 'x'); }}};
  for (const auto &[name, answer] : others) {
    SCOPED_TRACE(name);
    Port port(answer);
    vpProcess show("vlp-lamp", {"--port", port.name(), "--show"});
    EXPECT_EQ(notRefused(show, port.name() + ": no answer to 'show'"), "");
  }
}

TEST(VlpLamp, APortThatIsUnpluggedIsOneErrorAndTheLampAsItWas)
{
  const vpTemporaryFolder folder;
  const std::string map = mapFile(folder);
  for (const size_t bytes : {7, 20, 40}) {
    SCOPED_TRACE(bytes);
    vpSimulatedArduino lamp(VLP_LAMP_FIRMWARE);
    lamp.run(0.1);
    const std::string before = lamp.ask("set frequency_hz=1000 duty=0.5 id=before");
    std::atomic<bool> gone{false};
    size_t left = bytes;
    const auto board = firmware(lamp);
    Port port([&](const std::string &came) {
      const size_t set = came.find("set");
      if (set == std::string::npos && left == bytes) {
        return board(came);
      }
      const size_t taken = std::min(left, came.size());
      left -= taken;
      gone = true; // within the line that tells it
      return board(came.substr(0, taken));
    });
    vpProcess tell("vlp-lamp", {"--port", port.name(), "--map", map, "--lamp", "word"});
    for (int k = 0; k < 1000 && !gone; ++k) {
      usleep(10000);
    }
    port.unplug();
    EXPECT_EQ(notRefused(tell, port.name()), "");
    vpSimulatedArduino again(VLP_LAMP_FIRMWARE, lamp.eeprom());
    again.run(0.1);
    EXPECT_EQ(again.ask("show"), before);
  }
}

#ifdef VLP_FAULTS // else a sanitizer has to be loaded first
TEST(VlpLamp, CallsThatComeShortAreNoMatterAndThoseThatFailAreOneError)
{
  const vpTemporaryFolder folder;
  const std::string map = mapFile(folder);
  const auto tell = [&](const vpFault &fault) {
    vpSimulatedArduino lamp(VLP_LAMP_FIRMWARE);
    Port port(firmware(lamp));
    const vpEnding ending =
        vpRunWith(fault, port.name(), "vlp-lamp", {"--port", port.name(), "--map", map, "--lamp", "one"});
    EXPECT_TRUE(ending.hit);
    EXPECT_EQ(ending.code == 2, ending.err.rfind("vlp-lamp: error: " + port.name(), 0) == 0) << ending.err;
    return ending;
  };
  for (const std::string call : {"read", "write"}) {
    for (const std::string as : {"EINTR", "short"}) {
      SCOPED_TRACE(call + " " + as);
      const vpEnding ending = tell({call, as, "odd"});
      EXPECT_EQ(ending.code, 0) << ending.err;
      EXPECT_EQ(ending.out.rfind("one  id=one frequency_hz=2270.148", 0), 0u) << ending.out;
    }
    for (const int at : {1, 2, 3}) {
      SCOPED_TRACE(call + " " + std::to_string(at));
      EXPECT_EQ(tell({call, "EIO", std::to_string(at)}).code, 2);
    }
  }
}
#endif

TEST(VlpLamp, ALampThatSendsSomethingElseIsAnError)
{
  const vpTemporaryFolder folder;
  Port port([](const std::string &came) {
    return came.find("set") == std::string::npos && came.find("show") == std::string::npos
               ? ""
               : "lamp frequency_hz=2271.000 duty=0.600000 clock_hz=16000000\r\n";
  });
  vpProcess tell("vlp-lamp", {"--port", port.name(), "--map", mapFile(folder), "--lamp", "one"});
  EXPECT_EQ(notRefused(tell, "expected 2270.148 Hz"), "");
}

TEST(VlpLamp, WhatTheMapDoesNotSayIsNamed)
{
  const vpTemporaryFolder folder;
  const std::string map = folder / "lamps.yaml";
  std::ofstream(map) << "lamps:\n  - {id: A, position_m: [0, 0, 2], diameter_m: 0.2, frequency_hz: 2000}\n";
  vpSimulatedArduino lamp(VLP_LAMP_FIRMWARE);
  Port port(firmware(lamp));
  vpProcess tell("vlp-lamp", {"--port", port.name(), "--map", map, "--lamp", "A"});
  EXPECT_EQ(notRefused(tell, "lamp A: duty: nothing"), "");
  vpProcess all("vlp-lamp", {"--port", port.name(), "--map", map, "--all"});
  EXPECT_EQ(notRefused(all, "lamp A: duty: nothing"), "");
}
