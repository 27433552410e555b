/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// What all programs have in common.

#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/vpProcess.h"

namespace
{
class Programs : public testing::TestWithParam<std::string>
{
};
} // namespace

TEST_P(Programs, SayTheirVersion)
{
  vpProcess program(GetParam(), {"--version"});
  EXPECT_EQ(program.wait(), 0);
  EXPECT_EQ(program.out(), GetParam() + " (visp_vlp) " VLP_VERSION "\n");
}

namespace
{
//! One line, without anything that a terminal obeys.
void expectOneLine(const std::string &err, const std::string &part)
{
  ASSERT_FALSE(err.empty());
  EXPECT_EQ(err.find('\n'), err.size() - 1) << err;
  for (const char *control : {"\x1b", "\r", "\x9b", "\xff"}) {
    EXPECT_EQ(err.find(control), std::string::npos) << testing::PrintToString(err);
  }
  EXPECT_NE(err.find(part), std::string::npos) << err;
}

const std::string oddName = "a\n\x1b[31m\r\xC2\x9b\xff", shownName = "a\\x0a\\x1b[31m\\x0d\\xc2\\x9b\\xff";
} // namespace

TEST_P(Programs, TellOddNamesInOneLine)
{
  vpProcess option(GetParam(), {"--" + oddName});
  EXPECT_EQ(option.wait(), 2);
  expectOneLine(option.err(), shownName);
}

TEST(OddNames, OfFilesThatAreMissing)
{
  const vpTemporaryFolder folder;
  const std::string name = folder / oddName, data = VLP_DATA_DIR;
  const std::vector<std::pair<std::string, std::vector<std::string>>> runs = {
      {"vlp-locate", {"--run", name}},
      {"vlp-locate", {"--rig", name, "--lamps", name, "--image", name}},
      {"vlp-locate", {"--run", data + "/paper-room", "--frames", "1", "--poses", name + "/poses.tum"}},
      {"vlp-simulate", {"--scenario", name, "--out", folder / "run"}},
      {"vlp-evaluate", {"--truth", name, "--estimate", name}},
      {"vlp-plan", {"--rig", name, "--heights", "1:2", "--diameter", "0.1"}},
      {"vlp-servo", {"--robot", "sim", "--scenario", name, "--path", data + "/paths/line-a.yaml"}},
      {"vlp-servo", {"--robot", "opencr:" + name, "--path", data + "/paths/line-a.yaml"}},
      {"vlp-calibrate", {"mount", "--run", name, "--out", folder / "out"}},
      {"vlp-calibrate", {"camera", "--camera-info", name, "--out", folder / "out"}},
      {"vlp-lamp", {"--port", name, "--map", data + "/paper-room/lamps.yaml", "--lamp", "LED1"}}};
  for (const auto &[program, arguments] : runs) {
    SCOPED_TRACE(testing::PrintToString(arguments));
    vpProcess process(program, arguments);
    EXPECT_EQ(process.wait(), 2);
    expectOneLine(process.err(), program + ": error: ");
  }
}

//! Ids of lamps are in messages, tables and CSV files.
TEST(OddNames, OfLamps)
{
  const vpTemporaryFolder folder;
  const std::string data = VLP_DATA_DIR "/paper-room", seen = folder / "seen.csv";
  std::string map;
  std::ifstream file(data + "/lamps.yaml");
  for (std::string line; std::getline(file, line);) {
    const size_t id = line.find("id: ");
    map += (id == std::string::npos
                ? line
                : line.substr(0, id + 4) + "\"\\u009b31m" + line.substr(id + 4, line.find(',', id) - id - 4) +
                      "\\x7f\"" + line.substr(line.find(',', id))) +
           "\n";
  }
  const std::string lamps = folder.write("lamps.yaml", map);
  vpProcess locate("vlp-locate", {"--run", data, "--lamps", lamps, "--seen", seen});
  EXPECT_EQ(locate.wait(), 0) << locate.err();
  vpProcess plan("vlp-plan", {"--rig", data + "/rig.yaml", "--check", lamps});
  EXPECT_EQ(plan.wait(), 0) << plan.err();
  for (const std::string &text : {locate.err(), plan.out(), plan.err(), folder.read("seen.csv")}) {
    EXPECT_EQ(text.find('\x7f'), std::string::npos) << text;
  }
  EXPECT_EQ((locate.err() + plan.out()).find("\xC2\x9b"), std::string::npos);
  EXPECT_NE(plan.out().find("\\xc2\\x9b31m"), std::string::npos) << plan.out();
}

INSTANTIATE_TEST_SUITE_P(All, Programs,
                         testing::Values("vlp-calibrate", "vlp-evaluate", "vlp-lamp", "vlp-locate",
                                         "vlp-plan", "vlp-servo", "vlp-simulate"));
