/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// What the firmware sends, in a picture: the camera reads of each lamp what it was told.

#include <cmath>
#include <iostream>
#include <sstream>

#include <gtest/gtest.h>
#include <visp3/vlp_identification/vpLedDetector.h>
#include <visp3/vlp_identification/vpLedIdPlanner.h>

#include "common/vpLampPicture.h"
#include "common/vpUpwardRig.h"
#include "vpSimulatedArduino.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
const unsigned int size = 240, lines = 146; // of the picture and of the lamp in it, px

vpModulation twoPulse(double frequency, double duty, double difference)
{
  vpModulation modulation;
  modulation.kind = vpModulation::Kind::twoPulse;
  modulation.frequency = frequency;
  modulation.duty = duty;
  modulation.phaseDifference = difference;
  return modulation;
}

//! Sixteen of one pulse and sixteen words, as vp-plan has them, and four of two pulses between the former.
vpLampMap mapFor(const vpVlpRig &rig)
{
  vpLedIdPlanner planner(rig);
  planner.clock = vpSimulatedArduino::clock;
  planner.lowestFrequency = 1000;
  planner.highestFrequency = 5000;
  std::vector<vpModulation> sent = planner.spread(lines, 50, 16).identifiers;
  const std::vector<vpModulation> words = planner.words(lines, vpWordScheme()).words;
  for (size_t k = 0; k < 16 && k < words.size(); ++k) {
    sent.push_back(words[k * words.size() / 16]);
  }
  for (double frequency : {1130.07, 1540.3, 2210.9, 2790.33}) {
    sent.push_back(twoPulse(frequency, 0.3, 0.33));
  }
  vpLampMap map;
  for (const vpModulation &modulation : sent) {
    vpLamp lamp;
    lamp.id = "L" + std::to_string(map.lamps.size());
    lamp.modulation = modulation;
    map.lamps.push_back(lamp);
  }
  return map;
}

std::string lineOf(const vpModulation &modulation)
{
  std::ostringstream line;
  line.precision(10);
  if (modulation.kind == vpModulation::Kind::word) {
    line << "set bits=" << modulation.bits << " chip_rate_hz=" << modulation.chipRate << " code=manchester";
  } else {
    line << "set frequency_hz=" << modulation.frequency << " duty=" << modulation.duty.value();
  }
  if (modulation.kind == vpModulation::Kind::twoPulse) {
    line << " phase_difference=" << modulation.phaseDifference;
  }
  return line.str();
}

//! Lights \e painted as the board's pin does, from the first edge after what it was told.
void light(vpSimulatedArduino &board, vpPaintedLamp &painted)
{
  if ((board.byte(board.TIMSK1) & 0x02) == 0) { // the timer does without interrupts
    const double period = board.word(board.ICR1) + 1;
    painted.frequency = board.clock / period;
    painted.pwm((board.word(board.OCR1A) + 1) / period);
    return;
  }
  board.run(1e-3);
  board.edges.clear();
  board.say("show\n"); // interrupts of the serial port come between
  board.run(0.05);     // in which it answers
  const size_t first = board.edges.front().lit ? 0 : 1,
               last = (board.edges.size() - first - 1) / 2 * 2 + first;
  const auto begin = static_cast<double>(board.edges[first].cycle);
  const double length = static_cast<double>(board.edges[last].cycle) - begin;
  painted.frequency = board.clock / length; // all that was heard is one period, longer than the picture
  painted.pulses.clear();
  for (size_t k = first; k < last; k += 2) {
    const auto rise = static_cast<double>(board.edges[k].cycle),
               fall = static_cast<double>(board.edges[k + 1].cycle);
    painted.pulses.push_back({(rise - begin) / length, (fall - rise) / length});
  }
}
} // namespace

TEST(LampInPicture, IsReadAsItWasTold)
{
  const vpVlpRig rig = vpUpwardRig(size, size);
  const vpLampMap map = mapFor(rig);
  ASSERT_EQ(map.lamps.size(), 36u);
  vpLedDetector detector(rig, map);
  vpSimulatedArduino board(VLP_LAMP_FIRMWARE);
  board.run(0.036);
  double worst = 0, most = 0;
  for (const vpLamp &lamp : map.lamps) {
    SCOPED_TRACE(lineOf(lamp.modulation));
    ASSERT_EQ(board.ask(lineOf(lamp.modulation)).substr(0, 5), "lamp ");
    vpLampPicture picture;
    picture.width = picture.height = size;
    picture.rowTime = rig.shutter.rowTime;
    picture.exposure = rig.shutter.exposure;
    picture.blur = 0.7;
    picture.lamps.resize(1);
    picture.lamps[0].centre = {0.5 * size, 0.5 * size};
    picture.lamps[0].a = picture.lamps[0].b = 0.5 * lines;
    light(board, picture.lamps[0]);
    ASSERT_GT(1 / picture.lamps[0].frequency, 0);
    detector.detect(picture.render());
    ASSERT_EQ(detector.observations().size(), 1u);
    const vpLampObservation &seen = detector.observations().front();
    EXPECT_EQ(seen.id, lamp.id) << seen.features.frequency;
    if (lamp.modulation.kind != vpModulation::Kind::word) {
      const double off = seen.features.frequency - lamp.modulation.frequency;
      EXPECT_LT(std::abs(off), 4 * seen.features.frequencySigma + 1e-4 * lamp.modulation.frequency);
      worst = std::max(worst, std::abs(off));
      most = std::max(most, std::abs(off) / seen.features.frequencySigma);
    }
  }
  std::cout << "frequencies are read within " << worst << " Hz, " << most << " standard deviations\n";
}
