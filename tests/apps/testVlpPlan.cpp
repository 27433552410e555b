/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// vlp-plan, run as a user runs it.

#include <cmath>
#include <set>

#include <gtest/gtest.h>
#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_identification/vpLedIdPlanner.h>

#include "apps/vpExpectRefused.h"
#include "common/vpProcess.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
using namespace vpStatus;

const std::string rig = std::string(VLP_DATA_DIR) + "/rigs/ub300-800x600.yaml";
const std::string hall = std::string(VLP_DATA_DIR) + "/lamps/hall.yaml";

//! The row of that name in a table.
std::string valueIn(const std::string &table, const std::string &name)
{
  const size_t row = table.find("\n  " + name + "  ");
  if (row == std::string::npos) {
    return "no row " + name;
  }
  const size_t begin = table.find_first_not_of(' ', row + name.size() + 3);
  return table.substr(begin, table.find('\n', begin) - begin);
}

class VlpPlan : public testing::Test
{
protected:
  //! These arguments behind those of a small plan.
  static std::vector<std::string> with(const std::vector<std::string> &more)
  {
    std::vector<std::string> arguments = {"--rig", rig, "--heights", "1.2:1.5", "--diameter", "0.175"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  //! Expects one line on stderr with all of \e parts, nothing on stdout, and no file `out`.
  void expectOneLine(const std::vector<std::string> &arguments, int code,
                     const std::vector<std::string> &parts) const
  {
    EXPECT_EQ(vpExpectRefused("vlp-plan", arguments, code, parts), "") << testing::PrintToString(arguments);
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  }

  vpTemporaryFolder folder;
};
} // namespace

TEST_F(VlpPlan, HelpHasExamplesAndExitCodes)
{
  vpProcess help("vlp-plan", {"--help"});
  EXPECT_EQ(help.wait(), done);
  for (const char *part :
       {"Examples:", "--heights FROM:TO", "above the camera, not above the floor", "--check FILE",
        "--reuse N", "smallest circle around the rays", "Exit code: 0 done; 2 bad usage"}) {
    EXPECT_NE(help.out().find(part), std::string::npos) << part;
  }
}

TEST_F(VlpPlan, WritesAMapThatReadsBack)
{
  vpProcess plan("vlp-plan", with({"--lamps", "20", "--out", folder / "out"}));
  EXPECT_EQ(plan.wait(), done) << plan.err();
  EXPECT_EQ(plan.err(), "");
  EXPECT_NE(plan.out().find("chosen                                                   20"), std::string::npos)
      << plan.out();
  EXPECT_EQ(folder.read("out").rfind("# Placeholder positions", 0), 0u);
  const vpLampMap map = vpLampMap::load(folder / "out");
  ASSERT_EQ(map.lamps.size(), 20u);
  EXPECT_EQ(map.identifiers().size(), 20u);
  std::set<std::pair<double, double>> places;
  for (const vpLamp &lamp : map.lamps) {
    EXPECT_EQ(lamp.size, 0.175);
    EXPECT_NEAR(lamp.position.z(), 1.5 + 0.19, 1e-9);
    places.insert({lamp.position.x(), lamp.position.y()});
  }
  EXPECT_EQ(places.size(), 20u);
  EXPECT_EQ(folder.count(), 1u); // nothing temporary stays

  vpProcess check("vlp-plan", {"--rig", rig, "--check", folder / "out", "--worst", "3"});
  EXPECT_EQ(check.wait(), done) << check.err();
  EXPECT_NE(check.out().find("(3 of 190)"), std::string::npos) << check.out();
  EXPECT_NE(check.out().find("  0 nearer than an error of 0.001"), std::string::npos);
}

TEST_F(VlpPlan, PlansWhatATimerMakes)
{
  for (const auto &[timer, clock] : {std::pair<std::string, double>{"avr", 16e6}, {"stm32", 24e6}}) {
    SCOPED_TRACE(timer);
    vpProcess plan("vlp-plan", with({"--lamps", "5", "--timers", timer, "--out", folder / timer}));
    EXPECT_EQ(plan.wait(), done) << plan.err();
    for (const vpLamp &lamp : vpLampMap::load(folder / timer).lamps) {
      const double cycles = std::round(clock / lamp.modulation.frequency),
                   lit = std::round(*lamp.modulation.duty * cycles);
      EXPECT_NEAR(lamp.modulation.frequency, clock / cycles, 0.5e-3);
      const std::string row = valueIn(plan.out(), lamp.id);
      EXPECT_NE(row.find(" " + std::to_string(std::lround(cycles) - 1) + " "), std::string::npos) << row;
      const long compare = std::lround(lit) - (timer == "avr" ? 1 : 0);
      EXPECT_EQ(row.substr(row.rfind(' ') + 1), std::to_string(compare)) << row;
    }
  }
}

TEST_F(VlpPlan, KeepsPlacesAndIds)
{
  const std::string csv = folder.write("places.csv", "id,x_m,y_m,z_m\nhall,1,2,1.6\ndoor,-1,0.5,1.5\n");
  vpProcess plan("vlp-plan", {"--rig", rig, "--place", csv, "--diameter", "0.2", "--oscillator", "rc",
                              "--out", folder / "out"});
  EXPECT_EQ(plan.wait(), done) << plan.err();
  const vpLampMap map = vpLampMap::load(folder / "out");
  ASSERT_EQ(map.lamps.size(), 2u);
  EXPECT_EQ(map.lamps[1].id, "door");
  EXPECT_EQ(map.lamps[1].position, Eigen::Vector3d(-1, 0.5, 1.5));
  EXPECT_EQ(map.lamps[1].oscillatorPpm, 10000);
  EXPECT_EQ(folder.read("out").rfind("lamps:", 0), 0u);

  vpProcess again("vlp-plan", {"--rig", rig, "--place", hall, "--out", folder / "hall.yaml"});
  EXPECT_EQ(again.wait(), done) << again.err();
  const vpLampMap before = vpLampMap::load(hall), after = vpLampMap::load(folder / "hall.yaml");
  ASSERT_EQ(after.lamps.size(), before.lamps.size());
  for (size_t i = 0; i < before.lamps.size(); ++i) {
    EXPECT_EQ(after.lamps[i].id, before.lamps[i].id);
    EXPECT_EQ(after.lamps[i].position, before.lamps[i].position);
    EXPECT_EQ(after.lamps[i].size, before.lamps[i].size);
  }
}

TEST_F(VlpPlan, PlansWords)
{
  vpProcess plan("vlp-plan", with({"--words", "--lamps", "6", "--bits", "10", "--out", folder / "out"}));
  EXPECT_EQ(plan.wait(), done) << plan.err();
  const vpLampMap map = vpLampMap::load(folder / "out");
  ASSERT_EQ(map.lamps.size(), 6u);
  EXPECT_EQ(map.identifiers().size(), 6u);
  for (const vpLamp &lamp : map.lamps) {
    EXPECT_EQ(lamp.modulation.bits.rfind("011110", 0), 0u);
    EXPECT_EQ(lamp.modulation.bits.size(), 10u);
  }
}

TEST_F(VlpPlan, DrawsThePicture)
{
  vpProcess plan("vlp-plan", with({"--frequencies", "500:1200", "--picture", folder / "capacity.png"}));
  EXPECT_EQ(plan.wait(), done) << plan.err();
  EXPECT_EQ(folder.read("capacity.png").substr(0, 4), "\x89PNG");
  EXPECT_EQ(folder.count(), 1u);
}

TEST_F(VlpPlan, LaysFewIdentifiersOverManyLamps)
{
  std::string places = "id,x_m,y_m,z_m\n"; // a grid of 1.5 m
  for (int k = 0; k < 64; ++k) {
    places += "L" + std::to_string(k) + "," + std::to_string(1.5 * (k % 8)) + "," +
              std::to_string(1.5 * (k / 8)) + ",3\n";
  }
  const std::string csv = folder.write("places.csv", places);
  const std::vector<std::string> arguments = {"--rig", rig,       "--place", csv,     "--diameter",
                                              "0.3",   "--reuse", "16",      "--out", folder / "out"};
  vpProcess plan("vlp-plan", arguments);
  EXPECT_EQ(plan.wait(), done) << plan.err();
  const vpLampMap map = vpLampMap::load(folder / "out");
  ASSERT_EQ(map.lamps.size(), 64u);
  EXPECT_EQ(map.lamps[9].id, "L9");
  EXPECT_EQ(map.lamps[9].position, Eigen::Vector3d(1.5, 1.5, 3));
  EXPECT_EQ(map.identifiers().size(), 16u);
  EXPECT_EQ(valueIn(plan.out(), "lamps"), "64");
  EXPECT_EQ(valueIn(plan.out(), "identifiers"), "16");
  EXPECT_EQ(valueIn(plan.out(), "radius of a view, m"),
            "2.87"); // 2.81 m above: hypot(400, 300) / 488.28 of it
  const vpLedIdReuse nearest = vpLedIdPlanner::reuse(map).front();
  const std::string apart = valueIn(plan.out(), "least distance between two lamps of one identifier, m");
  EXPECT_NEAR(std::stod(apart), nearest.apart, 0.01);
  EXPECT_NE(apart.find("(" + map.lamps[nearest.first].id + ", " + map.lamps[nearest.second].id + ")"),
            std::string::npos)
      << apart;
  EXPECT_LT(std::stoi(valueIn(plan.out(), "of these, with one identifier")), 20);
  EXPECT_LT(std::stoi(valueIn(plan.out(), "of these, repeated: they look like another one")), 200);

  vpProcess again("vlp-plan", arguments);
  EXPECT_EQ(again.wait(), done) << again.err();
  EXPECT_EQ(again.out(), plan.out());

  vpProcess check("vlp-plan", {"--rig", rig, "--check", folder / "out"});
  EXPECT_EQ(check.wait(), done) << check.err();
  EXPECT_NE(check.out().find("Identifiers that lamps share (16)"), std::string::npos) << check.out();
}

TEST_F(VlpPlan, ReusesWordsInAViewOfItsOwn)
{
  vpProcess plan("vlp-plan", {"--rig", rig, "--place", hall, "--heights", "1.2:1.5", "--words", "--reuse",
                              "12", "--view-radius", "4.5", "--out", folder / "out"});
  EXPECT_EQ(plan.wait(), done) << plan.err();
  const vpLampMap map = vpLampMap::load(folder / "out");
  ASSERT_EQ(map.lamps.size(), 30u);
  EXPECT_EQ(map.identifiers().size(), 12u);
  EXPECT_EQ(map.lamps[0].modulation.bits.rfind("011110", 0), 0u);
  EXPECT_EQ(valueIn(plan.out(), "radius of a view, m"), "4.5");
}

TEST_F(VlpPlan, ReportsReuse)
{
  const std::string map = folder.write("map.yaml", R"(lamps:
  - {id: A, position_m: [0, 0, 1.7], diameter_m: 0.175, frequency_hz: 1000, duty: 0.5}
  - {id: B, position_m: [3, 4, 1.7], diameter_m: 0.175, frequency_hz: 1000, duty: 0.5}
)");
  vpProcess check("vlp-plan", {"--rig", rig, "--check", map});
  EXPECT_EQ(check.wait(), done) << check.err();
  EXPECT_NE(check.out().find("Identifiers that lamps share (1)"), std::string::npos) << check.out();
  EXPECT_NE(check.out().find("1000 Hz, 0.5      2                A  B        5"), std::string::npos)
      << check.out();
}

TEST_F(VlpPlan, WhatTheRigCannotHoldIsSaid)
{
  const std::string out = folder / "out";
  expectOneLine(with({"--lamps", "5000", "--out", out}), nothingFound,
                {"--lamps: 5000, expected at most the "});
  expectOneLine({"--rig", rig, "--place", hall, "--words", "--bits", "8", "--heights", "1.2", "--reuse", "20",
                 "--out", out},
                nothingFound, {"--reuse: 20, expected at most the "});
  expectOneLine({"--rig", rig, "--heights", "30", "--diameter", "0.175", "--out", out}, nothingFound,
                {"no frequency is left"});
  expectOneLine(with({"--words", "--chip-rate", "1000", "--out", out}), nothingFound,
                {"a word takes 254 lines, the smallest lamp has 56"});
  const std::string one = folder.write(
      "one.yaml", "lamps:\n  - {id: A, position_m: [0, 0, 2], diameter_m: 0.2, unmodulated: true}\n");
  expectOneLine({"--rig", rig, "--check", one}, nothingFound, {"one.yaml: no two lamps that blink alike"});
}

TEST_F(VlpPlan, BadUsageIsOneClearLine)
{
  const std::string out = folder / "out";
  expectOneLine({}, badInput, {"--rig: nothing, expected"});
  expectOneLine({"--rig", rig}, badInput, {"--heights: nothing, expected", "--place"});
  expectOneLine({"--rig", rig, "--heights", "1.5"}, badInput, {"--diameter: nothing, expected"});
  for (const std::string heights : {"0:1", "2:1", "1:2:3", "a:b", "1:", "-1:2", "nan"}) {
    expectOneLine({"--rig", rig, "--diameter", "0.1", "--heights=" + heights}, badInput,
                  {"--heights: " + heights + ", expected FROM:TO"});
  }
  expectOneLine(with({"--oscillator", "quartz"}), badInput,
                {"--oscillator: quartz, expected crystal (50 ppm)"});
  expectOneLine(with({"--clock", "fast"}), badInput, {"--clock: fast, expected a number of Hz"});
  expectOneLine(with({"--timers", "pic"}), badInput, {"--timers: pic, expected avr|stm32"});
  expectOneLine(with({"--timers", "rp2040", "--clock", "9e9"}), badInput,
                {"--timers: rp2040 does not reach 500 Hz"});
  for (const std::string duties : {"0.5,1", "0", "0.2,0.2", "0.2,,0.5", "half"}) {
    expectOneLine(with({"--duties", duties}), badInput, {"--duties: " + duties + ", expected up to 8"});
  }
  expectOneLine(with({"--error", "0"}), badInput, {"--error: 0, expected a probability"});
  expectOneLine(with({"--snr-db", "much"}), badInput, {"--snr-db: much, expected a number of dB"});
  expectOneLine(with({"--lamps", "-1"}), badInput, {"--lamps"});
  expectOneLine(with({"--picture", folder / "capacity.jpg"}), badInput, {"--picture: ", "ends in .png"});
  expectOneLine(with({"--bits", "14"}), badInput, {"--bits", "--words"});
  expectOneLine(with({"--words", "--bits", "40"}), badInput, {"bits: 40, expected 7 to 18"});
  expectOneLine(with({"--words", "--header", "01x"}), badInput, {"header: \"01x\", expected"});
  expectOneLine(with({"--check", hall, "--out", out}), badInput, {"--check: with --out"});
  expectOneLine(with({"--place", hall, "--lamps", "3"}), badInput, {"--lamps: with --place"});
  expectOneLine(with({"--reuse", "3", "--out", out}), badInput, {"--reuse: without --place"});
  expectOneLine(with({"--place", hall, "--reuse", "1"}), badInput, {"--reuse: 1, expected 2 or more"});
  expectOneLine(with({"--place", hall, "--reuse", "31", "--out", out}), badInput,
                {"--reuse: 31, expected at most the 30 lamps of ", "hall.yaml"});
  expectOneLine(with({"--place", hall, "--view-radius", "3"}), badInput, {"--view-radius: without --reuse"});
  for (const std::string radius : {"0", "-1", "inf", "wide"}) {
    expectOneLine(with({"--place", hall, "--reuse", "9", "--view-radius=" + radius}), badInput,
                  {"--view-radius: " + radius + ", expected a number of metres above 0"});
  }
  expectOneLine({"--rig", rig, "--check", hall, "--reuse", "3"}, badInput,
                {"--check: with --out", "--reuse"});
  expectOneLine({"--rig", rig, "--check", hall, "--timers", "avr"}, badInput,
                {"--check: with --out", "--timers"});
  expectOneLine(with({"--place", hall, "--out", hall}), badInput, {"--out: ", "which is an input"});
}

TEST_F(VlpPlan, ViewThatHasNoEndIsSaid)
{
  const std::string aslant = folder.write(
      "rig.yaml", "camera: {file: " + std::string(VLP_DATA_DIR) +
                      "/rigs/ub300-800x600.xml, name: UB300}\n"
                      "shutter: {row_time_s: 43.1e-6, row_time_sigma_s: 2e-9, exposure_s: 43.1e-6, readout: "
                      "rows}\nmount: {translation_m: [0, 0, 0.19], rotation_rpy_deg: [0, 60, 0]}\n");
  const std::vector<std::string> arguments = {"--rig", aslant, "--place", hall, "--reuse", "12"};
  expectOneLine(arguments, badInput, {"--view-radius: nothing, expected", "shows the horizon"});
  std::vector<std::string> given = arguments;
  given.insert(given.end(), {"--view-radius", "4"});
  vpProcess plan("vlp-plan", given);
  EXPECT_EQ(plan.wait(), done) << plan.err();
}

TEST_F(VlpPlan, BadFilesAreOneClearLine)
{
  const std::string none = folder / "none.yaml";
  expectOneLine({"--rig", none, "--heights", "1", "--diameter", "0.1"}, badInput,
                {"none.yaml: cannot be opened"});
  expectOneLine({"--rig", rig, "--check", none}, badInput, {"none.yaml: cannot be opened"});
  const std::string twice = folder.write("twice.csv", "id,x_m,y_m,z_m\nA,0,0,2\nA,1,1,2\n");
  expectOneLine({"--rig", rig, "--place", twice, "--diameter", "0.1"}, badInput,
                {"twice.csv:3: id: A, expected"});
  const std::string low = folder.write("low.csv", "id,x_m,y_m,z_m\nA,0,0,0.1\n");
  expectOneLine({"--rig", rig, "--place", low}, badInput, {"--diameter: nothing, expected", "lamp A"});
  expectOneLine({"--rig", rig, "--place", low, "--diameter", "0.1"}, badInput,
                {"low.csv: lamp A: -0.09 m above the camera"});
  const std::string one = folder.write("one.csv", "id,x_m,y_m,z_m\nA,0,1,2\nB,0,1,2\n");
  expectOneLine({"--rig", rig, "--place", one, "--diameter", "0.1"}, badInput,
                {"one.csv: lamp B: position_m: where lamp A hangs"});
  expectOneLine(with({"--lamps", "3", "--out", "/proc/none/lamps.yaml"}), badInput, {"/proc/none"});
}
