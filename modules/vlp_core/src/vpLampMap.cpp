/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_core/vpLampMap.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_set>

#include <visp3/vlp_core/vpAtomicFile.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_core/vpYamlNode.h>

BEGIN_VISP_NAMESPACE

namespace
{
using Range = vpYamlNode::Range;

void readShape(const vpYamlNode &node, vpLamp &lamp)
{
  lamp.shape = vpLamp::Shape::disk;
  if (node.has("shape") && node.choice("shape", {"disk", "square"}) == 1) {
    lamp.shape = vpLamp::Shape::square;
  }
  const bool square = lamp.shape == vpLamp::Shape::square;
  const std::string own = square ? "size_m" : "diameter_m";
  const std::string other = square ? "diameter_m" : "size_m";
  if (node.has(other)) {
    node.fail(other, std::string("of a ") + (square ? "square" : "disk") + ", expected " + own);
  }
  lamp.size = node.number(own, Range::positive, lamp.size);
  if (node.has("yaw_deg") && !square) {
    node.fail("yaw_deg", "of a disk, expected only of a square");
  }
  lamp.yaw = node.number("yaw_deg", Range::any, 0) * M_PI / 180;
}

//! Of pulses or chips, Hz.
double rateOf(const vpYamlNode &node, const std::string &key)
{
  static const double most = 1e6; // twice what a picture with a line each microsecond could show
  const double rate = node.number(key, Range::positive);
  if (rate > most) {
    node.fail(key, vpNumberText(rate) + ", expected Hz, at most " + vpNumberText(most));
  }
  return rate;
}

void readPulses(const vpYamlNode &node, vpModulation &modulation)
{
  modulation.kind = vpModulation::Kind::pwm;
  modulation.frequency = rateOf(node, "frequency_hz");
  if (node.has("duty")) {
    modulation.duty = node.number("duty", Range::openUnit);
  }
  if (!node.has("phase_difference")) {
    return;
  }
  modulation.kind = vpModulation::Kind::twoPulse;
  modulation.phaseDifference = node.number("phase_difference");
  const std::string phase = vpNumberText(modulation.phaseDifference);
  if (!(modulation.phaseDifference > 0 && modulation.phaseDifference < 0.5)) {
    node.fail("phase_difference", phase + ", expected a number between 0 and 0.5 (both excluded)");
  }
  if (modulation.duty && *modulation.duty / 2 > modulation.phaseDifference) {
    node.fail("phase_difference",
              phase + ", expected at least duty / 2 = " + vpNumberText(*modulation.duty / 2) + " (duty " +
                  vpNumberText(*modulation.duty) + "), or the two pulses overlap");
  }
}

void readWord(const vpYamlNode &node, vpModulation &modulation)
{
  modulation.kind = vpModulation::Kind::word;
  modulation.bits = node.text("bits");
  modulation.chipRate = rateOf(node, "chip_rate_hz");
  modulation.code = node.choice("code", {"manchester", "ook"}) == 0 ? vpModulation::Code::manchester
                                                                    : vpModulation::Code::ook;
  const std::string &bits = modulation.bits;
  if (bits.size() < 2 || bits.find_first_not_of("01") != std::string::npos) {
    node.fail("bits", "\"" + vpShown(bits) + "\", expected two or more of 0 and 1");
  }
  if (modulation.code == vpModulation::Code::ook &&
      bits.find(bits[0] == '0' ? '1' : '0') == std::string::npos) {
    node.fail("bits", "\"" + vpShown(bits) + "\", expected both 0 and 1 in ook, or the lamp never blinks");
  }
  node.finish();
}

void readModulation(const vpYamlNode &node, vpModulation &modulation)
{
  const bool pulses = node.has("frequency_hz"), word = node.has("word"),
             unmodulated = node.has("unmodulated");
  if (pulses + word + unmodulated != 1) {
    const std::string came = std::string(pulses ? "frequency_hz, " : "") + (word ? "word, " : "") +
                             (unmodulated ? "unmodulated, " : "");
    node.fail("", (came.empty() ? "no modulation, " : came) +
                      "expected exactly one of frequency_hz, word and unmodulated");
  }
  if (pulses) {
    readPulses(node, modulation);
    return;
  }
  for (const std::string key : {"duty", "phase_difference"}) {
    if (node.has(key)) {
      node.fail(key, "without frequency_hz, expected only with it");
    }
  }
  if (word) {
    readWord(node.mapping("word"), modulation);
  } else if (!node.boolean("unmodulated")) {
    node.fail("unmodulated", "false, expected true; leave it out for a lamp that blinks");
  }
}

std::string modulationText(const vpModulation &modulation)
{
  std::string text;
  switch (modulation.kind) {
  case vpModulation::Kind::pwm:
  case vpModulation::Kind::twoPulse:
    text = "frequency_hz: " + vpNumberText(modulation.frequency);
    if (modulation.duty) {
      text += ", duty: " + vpNumberText(*modulation.duty);
    }
    if (modulation.kind == vpModulation::Kind::twoPulse) {
      text += ", phase_difference: " + vpNumberText(modulation.phaseDifference);
    }
    return text;
  case vpModulation::Kind::word:
    return "word: {bits: \"" + modulation.bits + "\", chip_rate_hz: " + vpNumberText(modulation.chipRate) +
           ", code: " + (modulation.code == vpModulation::Code::manchester ? "manchester" : "ook") + "}";
  case vpModulation::Kind::unmodulated:
    break;
  }
  return "unmodulated: true";
}

std::string lampText(const vpLamp &lamp)
{
  const vpLamp left; // what load() takes for what is left out
  std::string text = "id: " + vpYamlNode::quoted(lamp.id) + ", position_m: [" +
                     vpNumberText(lamp.position.x()) + ", " + vpNumberText(lamp.position.y()) + ", " +
                     vpNumberText(lamp.position.z()) + "]";
  if (lamp.positionSigma != left.positionSigma) {
    text += ", position_sigma_m: " + vpNumberText(lamp.positionSigma);
  }
  const bool square = lamp.shape == vpLamp::Shape::square;
  if (square) {
    text += ", shape: square";
  }
  if (!std::isnan(lamp.size)) {
    text += std::string(square ? ", size_m: " : ", diameter_m: ") + vpNumberText(lamp.size);
  }
  if (square && lamp.yaw != left.yaw) {
    text += ", yaw_deg: " + vpDegreesText(lamp.yaw);
  }
  text += ", " + modulationText(lamp.modulation);
  if (lamp.oscillatorPpm != left.oscillatorPpm) {
    text += ", oscillator_ppm: " + vpNumberText(lamp.oscillatorPpm);
  }
  return "  - {" + text + "}\n";
}
} // namespace

vpLamp vpLamp::read(const vpYamlNode &node)
{
  vpLamp lamp;
  lamp.id = node.text("id");
  if (std::any_of(lamp.id.begin(), lamp.id.end(),
                  [](char c) { return static_cast<unsigned char>(c) < 0x20; })) {
    node.fail("id", vpShown(lamp.id) + ", expected text on one line");
  }
  const std::vector<double> position = node.numbers("position_m", 3);
  lamp.position = Eigen::Vector3d(position[0], position[1], position[2]);
  lamp.positionSigma = node.number("position_sigma_m", Range::notNegative, lamp.positionSigma);
  readShape(node, lamp);
  readModulation(node, lamp.modulation);
  lamp.oscillatorPpm = node.number("oscillator_ppm", Range::notNegative, lamp.oscillatorPpm);
  node.finish();
  return lamp;
}

const vpLamp *vpLampMap::find(const std::string &id) const
{
  const auto found =
      std::find_if(lamps.begin(), lamps.end(), [&id](const vpLamp &lamp) { return lamp.id == id; });
  return found == lamps.end() ? nullptr : &*found;
}

std::vector<vpIdentifier> vpLampMap::identifiers() const
{
  // Lamps of one identifier repeat at the same rate: only those need to be compared.
  std::multimap<double, size_t> byRate;
  std::vector<vpIdentifier> identifiers;
  for (size_t i = 0; i < lamps.size(); ++i) {
    const vpLamp &lamp = lamps[i];
    const double rate = lamp.modulation.repetitionFrequency();
    if (lamp.modulation.kind == vpModulation::Kind::unmodulated) {
      continue;
    }
    const auto [first, last] = byRate.equal_range(rate);
    const auto same = std::find_if(first, last, [&](const auto &entry) {
      const vpIdentifier &other = identifiers[entry.second];
      return other.oscillatorPpm == lamp.oscillatorPpm && other.modulation.sameSignal(lamp.modulation);
    });
    if (same != last) {
      identifiers[same->second].lamps.push_back(i);
    } else {
      byRate.emplace(rate, identifiers.size());
      identifiers.push_back({lamp.modulation, lamp.oscillatorPpm, {i}});
    }
  }
  return identifiers;
}

vpLampMap vpLampMap::load(const std::string &filename)
{
  const vpYamlNode top = vpYamlNode::load(filename);
  vpLampMap map;
  std::unordered_set<std::string> ids;
  for (const vpYamlNode &node : top.mappings("lamps")) {
    vpLamp lamp = vpLamp::read(node);
    if (!ids.insert(lamp.id).second) {
      node.fail("id", vpShown(lamp.id) + " a second time, expected an id of its own");
    }
    map.lamps.push_back(std::move(lamp));
  }
  if (map.lamps.empty()) {
    top.fail("lamps", "an empty list, expected one lamp or more");
  }
  top.finish();
  return map;
}

void vpLampMap::save(const std::string &filename, const std::vector<std::string> &comment) const
{
  vpAtomicFile file(filename);
  for (const std::string &line : comment) {
    file.stream() << "# " << line << "\n";
  }
  file.stream() << "lamps:\n";
  for (const vpLamp &lamp : lamps) {
    file.stream() << lampText(lamp);
  }
  file.commit();
}

END_VISP_NAMESPACE
