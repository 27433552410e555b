/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// The firmware of apps/lamp-firmware: what it sends to the cycle, what it says, and what is left when power
// goes.

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "vpSimulatedArduino.h"

namespace
{
const double started = 0.036; // s, after which it has begun what it sends

const unsigned int pwmOnD9 = 0x82, freeRunning = 0x01, noDivider = 0x19;

struct Sent {
  std::string line;
  double period = 0;           // cycles
  std::vector<double> changes; // cycles of a period, the first at 0: lit, dark, lit, dark
};

std::string decimal(double value, int digits)
{
  std::ostringstream text;
  text.setf(std::ios::fixed);
  text.precision(digits);
  text << value;
  return text.str();
}

//! Modulations as vp-plan and the paper have them.
class Modulations
{
public:
  explicit Modulations(unsigned int seed) : m_generator(seed) {}

  Sent pulse(bool two)
  {
    const std::string f = decimal(std::exp(even(std::log(500.), std::log(10000.))), 3),
                      lit = decimal(two ? even(0.2, 0.4) : even(0.1, 0.9), 4),
                      second = decimal(even(0.25, 0.42), 4);
    const double frequency = std::stod(f), duty = std::stod(lit), apart = std::stod(second);
    Sent sent;
    sent.line = "set frequency_hz=" + f + " duty=" + lit;
    sent.period = std::round(vpSimulatedArduino::clock / frequency);
    sent.changes = {0, duty * sent.period};
    if (two) {
      sent.line += " phase_difference=" + second;
      sent.changes = {0, duty / 2 * sent.period, apart * sent.period, (apart + duty / 2) * sent.period};
    }
    return sent;
  }

  Sent word()
  {
    const bool manchester = even(0, 1) < 0.5;
    const std::string rate = decimal(even(2000, 20000), 3);
    std::string bits = "01"; // both, whatever follows
    for (int k = 0; k < 12; ++k) {
      bits += even(0, 1) < 0.5 ? '0' : '1';
    }
    return word(bits, rate, manchester);
  }

  static Sent word(const std::string &bits, const std::string &rate, bool manchester)
  {
    std::string chips;
    for (char bit : bits) {
      chips += manchester ? (bit == '1' ? "10" : "01") : std::string(1, bit);
    }
    while (chips.front() != '1' || chips.back() != '0') {
      std::rotate(chips.begin(), chips.begin() + 1, chips.end());
    }
    Sent sent;
    sent.line = "set bits=" + bits + " chip_rate_hz=" + rate + " code=" + (manchester ? "manchester" : "ook");
    const double chip = std::round(vpSimulatedArduino::clock / std::stod(rate));
    sent.period = chip * static_cast<double>(chips.size());
    for (size_t k = 0; k < chips.size(); ++k) {
      if (chips[k] != chips[(k + chips.size() - 1) % chips.size()]) {
        sent.changes.push_back(chip * static_cast<double>(k));
      }
    }
    return sent;
  }

  double even(double from, double to)
  {
    return std::uniform_real_distribution<double>(from, to)(m_generator);
  }

private:
  std::mt19937_64 m_generator;
};

//! By how many cycles at most edges lie elsewhere than \e sent has them, over three periods and more; NaN:
//! they are others, or none.
double worstEdge(const std::vector<vpSimulatedArduino::Edge> &edges, const Sent &sent)
{
  const size_t n = sent.changes.size();
  double best = std::nan("");
  for (size_t first = 0; first < n && first < edges.size(); ++first) { // which of them starts the period
    if (!edges[first].lit || edges.size() < first + 3 * n) {
      continue;
    }
    double worst = 0;
    for (size_t k = 0; k < 3 * n; ++k) {
      const auto at = static_cast<double>(edges[first + k].cycle - edges[first].cycle);
      const double expected = sent.changes[k % n] + sent.period * static_cast<double>(k / n);
      worst = std::max(worst, std::abs(at - expected));
    }
    best = std::fmin(best, worst);
  }
  return best;
}

double fieldOf(const std::string &answer, const std::string &name)
{
  const size_t at = answer.find(" " + name + "=");
  return at == std::string::npos ? std::nan("") : std::stod(answer.substr(at + name.size() + 2));
}
} // namespace

TEST(LampFirmware, IsLitUntilItIsTold)
{
  vpSimulatedArduino lamp(VLP_LAMP_FIRMWARE);
  ASSERT_TRUE(lamp.run(started));
  EXPECT_EQ(lamp.ask("show"), "lamp unmodulated=true clock_hz=16000000");
  ASSERT_FALSE(lamp.edges.empty());
  EXPECT_TRUE(lamp.edges.back().lit);
  lamp.edges.clear();
  lamp.run(0.1);
  EXPECT_TRUE(lamp.edges.empty());
}

TEST(LampFirmware, StartsSoftly)
{
  vpSimulatedArduino lamp(VLP_LAMP_FIRMWARE);
  double before = 0;
  for (int part = 0; part < 6; ++part) {
    lamp.run(0.005);
    EXPECT_EQ(lamp.byte(lamp.TCCR1A), pwmOnD9);
    const double share = lamp.word(lamp.OCR1A) / (lamp.word(lamp.ICR1) + 1.);
    EXPECT_GT(share, before + 0.1);
    before = share;
  }
}

TEST(LampFirmware, OnePulseIsTheTimersOwn)
{
  vpSimulatedArduino lamp(VLP_LAMP_FIRMWARE);
  lamp.run(started);
  Modulations modulations(1);
  for (int k = 0; k < 80; ++k) {
    const Sent sent = modulations.pulse(false);
    const std::string answer = lamp.ask(sent.line);
    SCOPED_TRACE(sent.line + " -> " + answer);
    EXPECT_EQ(lamp.byte(lamp.TCCR1A), pwmOnD9);
    EXPECT_EQ(lamp.byte(lamp.TCCR1B), noDivider);
    EXPECT_EQ(lamp.word(lamp.ICR1) + 1, sent.period);
    EXPECT_NEAR(lamp.word(lamp.OCR1A) + 1, sent.changes[1], 1);
    EXPECT_NEAR(fieldOf(answer, "frequency_hz"), vpSimulatedArduino::clock / sent.period, 0.00051);
    EXPECT_NEAR(fieldOf(answer, "duty"), sent.changes[1] / sent.period, 1 / sent.period);
  }
}

TEST(LampFirmware, EdgesOfTwoPulsesAndWordsAreRightToTheCycle)
{
  vpSimulatedArduino lamp(VLP_LAMP_FIRMWARE);
  lamp.run(started);
  Modulations modulations(2);
  double worst = 0;
  for (int k = 0; k < 120; ++k) {
    const Sent sent = k % 2 == 0 ? modulations.pulse(true) : modulations.word();
    const std::string answer = lamp.ask(sent.line);
    SCOPED_TRACE(sent.line + " -> " + answer);
    ASSERT_EQ(answer.substr(0, 5), "lamp ");
    EXPECT_EQ(lamp.byte(lamp.TCCR1B), freeRunning);
    lamp.run(1e-3);
    lamp.edges.clear();
    lamp.say("show\n"); // interrupts of the serial port come between
    lamp.run(5 * sent.period / vpSimulatedArduino::clock);
    const double off = worstEdge(lamp.edges, sent);
    EXPECT_LE(off, 1);
    worst = std::fmax(worst, off);
    lamp.run(0.05);
  }
  std::cout << "edges are off by " << worst << " cycles at most\n";
}

TEST(LampFirmware, KeepsWhatItWasToldWithoutPower)
{
  vpSimulatedArduino lamp(VLP_LAMP_FIRMWARE);
  lamp.run(started);
  Modulations modulations(3);
  for (int k = 0; k < 10; ++k) {
    const Sent sent = k % 2 == 0 ? modulations.pulse(k % 4 == 0) : modulations.word();
    const std::string told = lamp.ask(sent.line + " id=L" + std::to_string(k));
    ASSERT_NE(told.find(" id=L" + std::to_string(k)), std::string::npos);
    vpSimulatedArduino again(VLP_LAMP_FIRMWARE, lamp.eeprom());
    again.run(started);
    EXPECT_EQ(again.ask("show"), told);
  }
}

TEST(LampFirmware, AWrongChecksumLeavesTheProgramBefore)
{
  vpSimulatedArduino lamp(VLP_LAMP_FIRMWARE);
  lamp.run(started);
  const std::string before = lamp.ask("set frequency_hz=1000 duty=0.25 id=before");
  const vpSimulatedArduino::Eeprom old = lamp.eeprom();
  lamp.ask("set bits=0111 chip_rate_hz=8000 code=ook id=after");
  const vpSimulatedArduino::Eeprom both = lamp.eeprom();
  for (size_t k = 0; k < both.size(); ++k) {
    if (both[k] != old[k]) {
      vpSimulatedArduino::Eeprom broken = both;
      broken[k] ^= 0x10;
      vpSimulatedArduino again(VLP_LAMP_FIRMWARE, broken);
      again.run(started);
      EXPECT_EQ(again.ask("show"), before) << "byte " << k;
    }
  }
}

//! Each save has a number of eight bits.
TEST(LampFirmware, TheLastOfManyProgramsCounts)
{
  vpSimulatedArduino lamp(VLP_LAMP_FIRMWARE);
  lamp.run(started);
  for (int period = 1000; period < 1520; ++period) {
    const Sent sent = {"set duty=0.5 frequency_hz=" + decimal(vpSimulatedArduino::clock / period, 3), 0, {}};
    ASSERT_EQ(lamp.ask(sent.line).substr(0, 5), "lamp ");
    if ((period - 1000 + 3) % 256 < 6) {
      vpSimulatedArduino again(VLP_LAMP_FIRMWARE, lamp.eeprom());
      again.run(started);
      EXPECT_EQ(again.word(lamp.ICR1) + 1, static_cast<unsigned int>(period));
    }
  }
}

//! Power that goes leaves the program before or the one after, and anything in the byte that is being
//! written.
TEST(LampFirmware, PowerLostWhileItIsToldLeavesTheOldProgramOrTheNew)
{
  static const int moments = 1000;
  vpSimulatedArduino lamp(VLP_LAMP_FIRMWARE);
  lamp.run(started);
  lamp.ask("set frequency_hz=1000 duty=0.25");
  lamp.ask("set frequency_hz=2000 duty=0.5 id=old"); // both copies are in use
  // The simulator writes a byte at once; the controller takes 3.4 ms, in which it may be anything.
  const Sent next = Modulations::word("01111010110010", "8000", true);
  lamp.say(next.line + " id=another-lamp\n");
  std::vector<vpSimulatedArduino::Eeprom> steps{lamp.eeprom()};
  for (int k = 0; k < 200000 && lamp.heard().find("id=another-lamp") == std::string::npos; ++k) {
    lamp.run(1e-6);
    const vpSimulatedArduino::Eeprom now = lamp.eeprom();
    if (now != steps.back()) {
      steps.push_back(now);
    }
  }
  ASSERT_GT(steps.size(), 5u);
  std::mt19937_64 generator(4);
  std::vector<vpSimulatedArduino::Eeprom> left;
  for (int k = 0; k < moments; ++k) {
    const size_t step = generator() % steps.size();
    left.push_back(steps[step]);
    if (step + 1 < steps.size()) {
      const auto byte = std::mismatch(steps[step].begin(), steps[step].end(), steps[step + 1].begin());
      left.back()[static_cast<size_t>(byte.first - steps[step].begin())] = static_cast<uint8_t>(generator());
    }
  }
  int old = 0, after = 0;
  for (const vpSimulatedArduino::Eeprom &eeprom : left) {
    vpSimulatedArduino again(VLP_LAMP_FIRMWARE, eeprom);
    again.run(started);
    again.edges.clear();
    again.run(0.02);
    const bool both = again.word(lamp.ICR1) + 1 == 8000 && again.word(lamp.OCR1A) + 1 == 4000;
    old += again.byte(lamp.TCCR1B) == noDivider && both;
    after += again.byte(lamp.TCCR1B) == freeRunning && worstEdge(again.edges, next) <= 1;
  }
  std::cout << moments << " moments within the " << steps.size() - 1 << " bytes that are written: " << old
            << " old, " << after << " new\n";
  EXPECT_EQ(old + after, moments);
}

TEST(LampFirmware, AnErrorNamesTheFieldAndChangesNothing)
{
  vpSimulatedArduino lamp(VLP_LAMP_FIRMWARE);
  lamp.run(started);
  const std::string told = lamp.ask("set frequency_hz=2270 duty=0.6 id=L3");
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"set frequency_hz=2270", "duty"},
      {"set frequency_hz=2270 duty=1", "duty"},
      {"set frequency_hz=2270 duty=-0.1", "duty"},
      {"set frequency_hz=2270 duty=0,5", "duty"},
      {"set frequency_hz=fast duty=0.5", "frequency_hz"},
      {"set frequency_hz=0 duty=0.5", "frequency_hz"},
      {"set frequency_hz=1e3 duty=0.5", "frequency_hz"},
      {"set frequency_hz=200 duty=0.5", "frequency_hz"},
      {"set frequency_hz=60000 duty=0.5", "frequency_hz"},
      {"set frequency_hz=999999999 duty=0.5", "frequency_hz"},
      {"set frequency_hz=2270 frequency_hz=2270 duty=0.5", "frequency_hz"},
      {"set frequency_hz=3000 duty=0.3 phase_difference=0.1", "phase_difference"},
      {"set frequency_hz=3000 duty=0.3 phase_difference=0.6", "phase_difference"},
      {"set bits=0123 chip_rate_hz=8000 code=ook", "bits"},
      {"set bits= chip_rate_hz=8000 code=ook", "bits"},
      {"set bits=" + std::string(49, '1') + " chip_rate_hz=8000 code=ook", "bits"},
      {"set bits=0111 chip_rate_hz=8000", "code"},
      {"set bits=0111 chip_rate_hz=8000 code=morse", "code"},
      {"set bits=0111 chip_rate_hz=1000000 code=ook", "chip_rate_hz"},
      {"set bits=1111 chip_rate_hz=8000 code=ook", "chip_rate_hz"},
      {"set bits=0111 code=ook", "chip_rate_hz"},
      {"set bits=0111 duty=0.5 chip_rate_hz=8000 code=ook", "duty"},
      {"set frequency_hz=2270 bits=0111 duty=0.5", "set"},
      {"set unmodulated=maybe", "unmodulated"},
      {"set id=A", "set"},
      {"set frequency_hz=2270 duty=0.6 id=abcdefghijklmnop", "id"},
      {"set colour=red", "colour"},
      {"set frequency_hz", "frequency_hz"},
      {"set ", "set"},
      {"sett frequency_hz=2270", "line"},
      {"\x7f\x01\xfe", "line"},
      {"show me", "line"},
      {std::string(400, 'x'), "line"},
  };
  for (const auto &[line, field] : bad) {
    SCOPED_TRACE(line);
    const std::string answer = lamp.ask(line);
    EXPECT_EQ(answer.substr(0, answer.find(": expected ")), "error " + field) << answer;
    EXPECT_EQ(lamp.ask("show"), told);
  }
  EXPECT_EQ(lamp.word(lamp.ICR1) + 1, std::round(vpSimulatedArduino::clock / 2270));
}

TEST(LampFirmware, GarbageDoesNotStopIt)
{
  vpSimulatedArduino lamp(VLP_LAMP_FIRMWARE);
  lamp.run(started);
  const std::string told = lamp.ask("set frequency_hz=3000 duty=0.3 phase_difference=0.35");
  std::mt19937_64 generator(5);
  std::string garbage;
  for (int k = 0; k < 20000; ++k) {
    garbage += static_cast<char>(generator());
  }
  lamp.say(garbage);
  lamp.run(0.2);
  lamp.ask(""); // ends what has begun
  lamp.run(0.2);
  EXPECT_EQ(lamp.ask("show"), told);
}

//! Edges that stop coming are none that a lamp ever sends: the watchdog starts it anew within a second.
TEST(LampFirmware, WatchdogStartsItAnew)
{
  vpSimulatedArduino lamp(VLP_LAMP_FIRMWARE);
  lamp.run(started);
  const std::string told = lamp.ask("set frequency_hz=3000 duty=0.3 phase_difference=0.35");
  lamp.poke(lamp.TIMSK1, 0);
  lamp.run(1.3);
  lamp.edges.clear();
  lamp.run(0.01);
  EXPECT_GT(lamp.edges.size(), 4u * 25);
  EXPECT_EQ(lamp.ask("show"), told);
}
