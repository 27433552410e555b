/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <visp3/vlp_core/vpLampMap.h>

#include "common/vpExpectError.h"
#include "common/vpTemporaryFolder.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
const std::string good =
    "# four lamps\n"
    "lamps:\n"
    "  - {id: A, position_m: [-0.33, -0.33, 1.5], diameter_m: 0.15, frequency_hz: 2000, duty: 0.5}\n"
    "  - {id: B, position_m: [0.33, -0.33, 1.5], shape: square, size_m: 0.3, frequency_hz: 3e3, duty: 0.3, "
    "phase_difference: 0.35, yaw_deg: 30}\n"
    "  - {id: 7, position_m: [0, 0, 1.5], diameter_m: 0.15, word: {bits: \"01111010110010\", chip_rate_hz: "
    "8000, "
    "code: manchester}, oscillator_ppm: 10000}\n"
    "  - {id: D, position_m: [1, 0, 1.5], shape: disk, unmodulated: true, position_sigma_m: 0.01}\n";

void expectSame(const vpLampMap &one, const vpLampMap &other)
{
  ASSERT_EQ(one.lamps.size(), other.lamps.size());
  for (size_t i = 0; i < one.lamps.size(); ++i) {
    const vpLamp &a = one.lamps[i], &b = other.lamps[i];
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.positionSigma, b.positionSigma);
    EXPECT_EQ(a.shape, b.shape);
    EXPECT_TRUE(a.size == b.size || (std::isnan(a.size) && std::isnan(b.size)));
    EXPECT_EQ(a.yaw, b.yaw);
    EXPECT_EQ(a.oscillatorPpm, b.oscillatorPpm);
    EXPECT_EQ(a.modulation.kind, b.modulation.kind);
    EXPECT_EQ(a.modulation.frequency, b.modulation.frequency);
    EXPECT_EQ(a.modulation.duty, b.modulation.duty);
    EXPECT_EQ(a.modulation.phaseDifference, b.modulation.phaseDifference);
    EXPECT_EQ(a.modulation.bits, b.modulation.bits);
    EXPECT_EQ(a.modulation.chipRate, b.modulation.chipRate);
    EXPECT_EQ(a.modulation.code, b.modulation.code);
  }
}
TEST(LampMap, LampsThatBlinkAlikeShareAnIdentifier)
{
  vpLampMap map;
  auto add = [&map](const vpModulation &modulation, double ppm = 50) {
    vpLamp lamp;
    lamp.id = std::to_string(map.lamps.size());
    lamp.modulation = modulation;
    lamp.oscillatorPpm = ppm;
    map.lamps.push_back(lamp);
  };
  vpModulation pulses;
  pulses.kind = vpModulation::Kind::pwm;
  pulses.frequency = 2000;
  pulses.duty = 0.5;
  vpModulation other = pulses;
  other.duty = 0.3;
  vpModulation word;
  word.kind = vpModulation::Kind::word;
  word.code = vpModulation::Code::ook;
  word.chipRate = 8000;
  word.bits = "0010111";
  vpModulation turned = word; // the same light, begun elsewhere
  turned.bits = "1110010";
  vpModulation reversed = word;
  reversed.bits = "1110100";
  add(pulses);
  add(word);
  add(other);
  add(pulses);
  add({});
  add(turned);
  add(reversed);
  add(pulses, 10000);

  const std::vector<vpIdentifier> identifiers = map.identifiers();
  ASSERT_EQ(identifiers.size(), 5u);
  EXPECT_EQ(identifiers[0].lamps, (std::vector<size_t>{0, 3}));
  EXPECT_EQ(identifiers[1].lamps, (std::vector<size_t>{1, 5}));
  EXPECT_EQ(identifiers[2].lamps, (std::vector<size_t>{2}));
  EXPECT_EQ(identifiers[3].lamps, (std::vector<size_t>{6}));
  EXPECT_EQ(identifiers[4].lamps, (std::vector<size_t>{7}));
  EXPECT_EQ(identifiers[4].oscillatorPpm, 10000);
}

} // namespace

TEST(LampMap, ReadsWhatTheFileSays)
{
  const vpTemporaryFolder folder;
  const vpLampMap map = vpLampMap::load(folder.write("lamps.yaml", good));
  ASSERT_EQ(map.lamps.size(), 4u);

  const vpLamp *a = map.find("A");
  ASSERT_TRUE(a);
  EXPECT_EQ(a->position, Eigen::Vector3d(-0.33, -0.33, 1.5));
  EXPECT_EQ(a->size, 0.15);
  EXPECT_EQ(a->shape, vpLamp::Shape::disk);
  EXPECT_EQ(a->modulation.kind, vpModulation::Kind::pwm);
  EXPECT_EQ(a->modulation.frequency, 2000);
  EXPECT_EQ(a->modulation.duty, 0.5);
  EXPECT_EQ(a->oscillatorPpm, 50);
  EXPECT_EQ(a->positionSigma, 0);

  const vpLamp *b = map.find("B");
  ASSERT_TRUE(b);
  EXPECT_EQ(b->shape, vpLamp::Shape::square);
  EXPECT_EQ(b->size, 0.3);
  EXPECT_DOUBLE_EQ(b->yaw, M_PI / 6);
  EXPECT_EQ(b->modulation.kind, vpModulation::Kind::twoPulse);
  EXPECT_EQ(b->modulation.phaseDifference, 0.35);

  const vpLamp *c = map.find("7");
  ASSERT_TRUE(c);
  EXPECT_EQ(c->modulation.kind, vpModulation::Kind::word);
  EXPECT_EQ(c->modulation.bits, "01111010110010");
  EXPECT_EQ(c->modulation.chipRate, 8000);
  EXPECT_EQ(c->modulation.code, vpModulation::Code::manchester);
  EXPECT_EQ(c->oscillatorPpm, 10000);

  const vpLamp *d = map.find("D");
  ASSERT_TRUE(d);
  EXPECT_EQ(d->modulation.kind, vpModulation::Kind::unmodulated);
  EXPECT_TRUE(std::isnan(d->size));
  EXPECT_EQ(d->positionSigma, 0.01);

  EXPECT_EQ(map.find("E"), nullptr);
}

TEST(LampMap, UnquotedBitsStayText)
{
  const vpTemporaryFolder folder;
  const vpLampMap map = vpLampMap::load(folder.write(
      "lamps.yaml",
      "lamps: [{id: 007, position_m: [0, 0, 1], word: {bits: 0011, chip_rate_hz: 1e3, code: ook}}]\n"));
  EXPECT_EQ(map.lamps[0].modulation.bits, "0011");
  EXPECT_EQ(map.lamps[0].id, "007");
}

TEST(LampMap, SavedAndLoadedItIsTheSame)
{
  const vpTemporaryFolder folder;
  vpLampMap map = vpLampMap::load(folder.write("lamps.yaml", good));
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-3, 3);
  for (const std::string id :
       {"true", "null", "~",  "a b", "a: b", "#1", "- x", "'", "\"", "\\", "{x}", "1e3",  "0x1f", "lámpara",
        "Ω",    "[1]",  "*a", "&a",  "!t",   "%",  "@",   "|", ">",  "?",  "NO",  ".inf", "a,b"}) {
    vpLamp lamp;
    lamp.id = id;
    lamp.position = Eigen::Vector3d(uniform(random), uniform(random), 1 / 3.0);
    lamp.positionSigma = 1e-3 / 3;
    lamp.shape = vpLamp::Shape::square;
    lamp.size = 0.1 + 0.2;
    lamp.modulation.kind = vpModulation::Kind::pwm;
    lamp.modulation.frequency = 2000.0 / 3;
    map.lamps.push_back(lamp);
  }
  map.save(folder / "saved.yaml");
  expectSame(map, vpLampMap::load(folder / "saved.yaml"));
  EXPECT_EQ(folder.count(), 2u);

  // in the notation of the documentation, without noise in the digits
  EXPECT_NE(folder.read("saved.yaml")
                .find("\n  - {id: B, position_m: [0.33, -0.33, 1.5], shape: square, size_m: 0.3, "
                      "yaw_deg: 30, frequency_hz: 3000, duty: 0.3, phase_difference: 0.35}\n"),
            std::string::npos)
      << folder.read("saved.yaml");

  const std::string before = folder.read("saved.yaml");
  vpLampMap::load(folder / "saved.yaml").save(folder / "saved.yaml");
  EXPECT_EQ(folder.read("saved.yaml"), before);
}

TEST(LampMap, SavingWhereNothingCanBeWritten)
{
  const vpTemporaryFolder folder;
  vpExpectError([&] { vpLampMap().save(folder / "none/lamps.yaml"); },
                {folder / "none/lamps.yaml", "cannot be written: No such file or directory"});
}

//! Each of these is one lamp of a file, or a whole file, and what its error has to say.
TEST(LampMap, BadFilesAreRefusedWithFileLineAndField)
{
  struct Bad {
    std::string text;
    std::vector<std::string> parts;
  };
  const std::string id = "lamps:\n  - id: A\n    ", at = "position_m: [0, 0, 1]\n    ",
                    hz = "frequency_hz: 1000\n    ";
  const std::string start = id + at + hz; // lines 1 to 4; what follows is on line 5
  const std::string word = id + at + "word: {chip_rate_hz: 8000, ";
  const std::vector<Bad> all = {
      // one number, out of its range or none
      {start + "duty: 1.3", {":5: lamps[0].duty: 1.3, expected a number between 0 and 1 (both excluded)"}},
      {start + "duty: 0", {":5: lamps[0].duty: 0, expected"}},
      {start + "duty: 1", {":5: lamps[0].duty: 1, expected"}},
      {start + "duty: half", {":5: lamps[0].duty: half, expected a number between"}},
      {start + "duty: \"0.5\"", {":5: lamps[0].duty: \"0.5\", expected a number between"}},
      {start + "duty:", {":5: lamps[0].duty: nothing, expected a number between"}},
      {start + "duty: [0.5]", {":5: lamps[0].duty: a list of 1, expected a number between"}},
      {start + "duty: .nan", {":5: lamps[0].duty: .nan, expected"}},
      {start + "duty: 0,5", {":5: lamps[0].duty: 0,5, expected"}},
      {id + at + "frequency_hz: 0", {":4: lamps[0].frequency_hz: 0, expected a number above 0"}},
      {id + at + "frequency_hz: -5", {":4: lamps[0].frequency_hz: -5, expected a number above 0"}},
      {id + at + "frequency_hz: .inf", {":4: lamps[0].frequency_hz: .inf, expected a number above 0"}},
      {id + at + "frequency_hz: 1e999", {":4: lamps[0].frequency_hz: 1e999, expected a number above 0"}},
      {id + at + "frequency_hz: 1e12", {":4: lamps[0].frequency_hz: 1e+12, expected Hz, at most 1e+06"}},
      {id + at + "frequency_hz: 2 kHz", {":4: lamps[0].frequency_hz: 2 kHz, expected a number above 0"}},
      {start + "oscillator_ppm: -1", {":5: lamps[0].oscillator_ppm: -1, expected a number of 0 or more"}},
      {start + "position_sigma_m: -0.1",
       {":5: lamps[0].position_sigma_m: -0.1, expected a number of 0 or more"}},
      {start + "diameter_m: 0", {":5: lamps[0].diameter_m: 0, expected a number above 0"}},
      {start + "phase_difference: 0.5",
       {":5: lamps[0].phase_difference: 0.5, expected a number between 0 and 0.5"}},
      {start + "phase_difference: 0",
       {":5: lamps[0].phase_difference: 0, expected a number between 0 and 0.5"}},
      {start + "duty: 0.6\n    phase_difference: 0.25",
       {":6: lamps[0].phase_difference: 0.25, expected at least duty / 2 = 0.3 (duty 0.6)"}},
      {id + hz + "position_m: [0, 0]", {":4: lamps[0].position_m: a list of 2, expected 3 numbers"}},
      {id + hz + "position_m: 3", {":4: lamps[0].position_m: 3, expected 3 numbers"}},
      {id + hz + "position_m:\n      - 0\n      - north\n      - 1",
       {":6: lamps[0].position_m[1]: north, expected a finite number"}},
      // keys
      {id + at, {":2: lamps[0]: no modulation, expected exactly one of frequency_hz, word and unmodulated"}},
      {id + hz, {":2: lamps[0].position_m: missing, expected 3 numbers"}},
      {"lamps:\n  - {position_m: [0, 0, 1], frequency_hz: 1000}",
       {":2: lamps[0].id: missing, expected text"}},
      {start + "dutty: 0.5", {":5: lamps[0].dutty: unknown key, expected one of id, position_m,", "duty"}},
      {start + "duty: 0.5\n    duty: 0.5", {":6: lamps[0].duty: twice, expected once"}},
      {start + "[1, 2]: 0.5", {":5: lamps[0]: a list of 2 as a key"}},
      {start + "unmodulated: true", {":2: lamps[0]: frequency_hz, unmodulated, expected exactly one"}},
      {id + at + "unmodulated: false", {":4: lamps[0].unmodulated: false, expected true"}},
      {id + at + "unmodulated: yes", {":4: lamps[0].unmodulated: yes, expected true or false"}},
      {id + at + "unmodulated: true\n    duty: 0.5", {":5: lamps[0].duty: without frequency_hz"}},
      // shape
      {start + "size_m: 0.3", {":5: lamps[0].size_m: of a disk, expected diameter_m"}},
      {start + "shape: square\n    diameter_m: 1", {":6: lamps[0].diameter_m: of a square, expected size_m"}},
      {start + "yaw_deg: 10", {":5: lamps[0].yaw_deg: of a disk, expected only of a square"}},
      {start + "shape: round", {":5: lamps[0].shape: round, expected one of disk, square"}},
      // words
      {id + at + "word: 0101", {":4: lamps[0].word: 0101, expected a mapping"}},
      {word + "bits: 1, code: ook}", {":4: lamps[0].word.bits: \"1\", expected two or more of 0 and 1"}},
      {word + "bits: 0120, code: ook}",
       {":4: lamps[0].word.bits: \"0120\", expected two or more of 0 and 1"}},
      {word + "bits: 1111, code: ook}", {":4: lamps[0].word.bits: \"1111\", expected both 0 and 1"}},
      {word + "bits: 0000, code: ook}", {":4: lamps[0].word.bits: \"0000\", expected both 0 and 1"}},
      {word + "bits: 0110, code: miller}",
       {":4: lamps[0].word.code: miller, expected one of manchester, ook"}},
      {word + "bits: 0110}", {":4: lamps[0].word.code: missing, expected one of manchester, ook"}},
      {word + "bits: 0110, code: ook, duty: 1}", {":4: lamps[0].word.duty: unknown key"}},
      // ids
      {start + "\n  - {id: A, position_m: [0, 0, 1], unmodulated: true}",
       {":6: lamps[1].id: A a second time"}},
      {"lamps:\n  - {id: '', position_m: [0, 0, 1], unmodulated: true}",
       {":2: lamps[0].id: \"\", expected text"}},
      {"lamps:\n  - {id: , position_m: [0, 0, 1], unmodulated: true}",
       {":2: lamps[0].id: nothing, expected text"}},
      {"lamps:\n  - {id: [A], position_m: [0, 0, 1], unmodulated: true}", {":2: lamps[0].id: a list of 1"}},
      {"lamps:\n  - {id: \"A\\nB\", position_m: [0, 0, 1], unmodulated: true}",
       {":2: lamps[0].id: A\\x0aB, expected"}},
      {"lamps:\n  - {id: A\xce, position_m: [0, 0, 1], unmodulated: true}",
       {":2: lamps[0].id: A\\xce, expected text in UTF-8"}},
      // the whole file
      {"", {":1: nothing, expected a mapping"}},
      {"# only a comment\n", {":1: nothing, expected a mapping"}},
      {"- 1\n", {":1: a list of 1, expected a mapping"}},
      {"lamps\n", {":1: lamps, expected a mapping"}},
      {"lamps: []\n", {":1: lamps: an empty list, expected one lamp or more"}},
      {"\nlamps:\n", {":2: lamps: nothing, expected a list of mappings"}},
      {"lamps: {id: A}\n", {":1: lamps: a mapping, expected a list of mappings"}},
      {"lamps:\n  - A\n", {":2: lamps[0]: A, expected a mapping"}},
      {"lights: []\n", {":1: lamps: missing, expected a list of mappings"}},
      {good + "units: m\n", {":7: units: unknown key, expected one of lamps"}},
      {good + "lamps: []\n", {":7: lamps: twice, expected once"}},
      {good + "---\nlamps: []\n", {":7: a second document, expected one"}},
      {",", {":1: nothing, expected a mapping"}},
      {"a\1: 1\na\1: 1\n", {":2: a\\x01: twice, expected once"}},
      {"lamps:\n  - {id: A, position_m: [0, 0, 1]\n", {"not YAML:"}},
      {"lamps:\n\t- id: A\n", {":2: not YAML:"}},
      {"lamps:\n  - *nobody\n", {":2: not YAML:"}},
      {std::string("\x89PNG\r\n\x1a\n\0\0\0\rIHDR", 16), {"lamps.yaml:", "not YAML: "}},
      {std::string(100000, '['), {"lamps.yaml:"}},
  };
  for (const Bad &bad : all) {
    SCOPED_TRACE(bad.text.substr(0, 300));
    const vpTemporaryFolder folder;
    const std::string file = folder.write("lamps.yaml", bad.text);
    std::vector<std::string> parts = {file + ":"};
    parts.insert(parts.end(), bad.parts.begin(), bad.parts.end());
    vpExpectError([&] { vpLampMap::load(file); }, parts);
  }
}

TEST(LampMap, FilesThatCannotBeRead)
{
  const vpTemporaryFolder folder;
  vpExpectError([&] { vpLampMap::load(folder / "lamps.yaml"); },
                {folder / "lamps.yaml: cannot be opened: No such file or directory"});
  vpExpectError([&] { vpLampMap::load(folder.path()); },
                {folder.path() + ": cannot be read: Is a directory"});
}

//! Whatever a file says, there is an answer or a vpException.
TEST(LampMap, DamagedFilesNeverDoWorse)
{
  std::mt19937 random(7);
  const vpTemporaryFolder folder;
  for (int i = 0; i < 400; ++i) {
    std::string text = good;
    for (int k = 0; k < 3; ++k) {
      const size_t place = random() % text.size();
      const std::string odd = "{}[]:,-\"'\n\t&*!|>%#\\\x01\xff"
                              "0e.";
      if (random() % 2) {
        text[place] = odd[random() % odd.size()];
      } else {
        text.erase(place, random() % 20);
      }
    }
    try {
      vpLampMap::load(folder.write("lamps.yaml", text));
    } catch (const vpException &error) {
      EXPECT_EQ(error.getStringMessage().find('\n'), std::string::npos) << text;
      EXPECT_EQ(error.getStringMessage().find(folder / "lamps.yaml:"), 0u) << error.getStringMessage();
    }
  }
}
