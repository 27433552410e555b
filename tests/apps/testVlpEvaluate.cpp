/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// vlp-evaluate, run as a user runs it.

#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>
#include <visp3/vlp_core/vpPoseText.h>
#include <visp3/vlp_evaluation/vpEvaluation.h>

#include "apps/vpExpectRefused.h"
#include "common/vpMarkup.h"
#include "common/vpProcess.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
using namespace vpStatus;

const std::string fixesHeader =
    "timestamp_s,x,y,z,roll,pitch,yaw,sigma_x,sigma_y,sigma_z,sigma_yaw,cov_xy,lamps,state,compute_s\n";

//! Along x at 1 m/s, a row each 0.1 s from a time on, shifted by a vector.
std::string tum(int rows, double from = 0, double dx = 0, double dy = 0)
{
  std::string text = "# made by the test\n";
  for (int i = 0; i < rows; ++i) {
    const double time = from + 0.1 * i;
    text += vpTumRow(time, vpPoseOf(Eigen::Vector3d(time + dx, dy, 0), Eigen::Vector3d(0, 0, 0))) + "\n";
  }
  return text;
}

//! The value that statistics.csv has under a name, or NaN.
double valueOf(const std::string &csv, const std::string &name)
{
  const size_t at = csv.find("\n" + name + ",");
  return at == std::string::npos ? NAN : std::atof(csv.c_str() + csv.find(',', at + name.size() + 2) + 1);
}

//! A folder with a truth, an estimate 3 mm and 4 mm off, and fixes of the same poses.
class VlpEvaluate : public testing::Test
{
protected:
  VlpEvaluate()
  {
    truth = folder.write("truth.tum", tum(51));
    estimate = folder.write("estimate.tum", tum(51, 0, 0.003, 0.004));
    std::string rows = fixesHeader;
    for (int i = 0; i < 50; ++i) {
      const std::string time = std::to_string(0.1 * i);
      const bool fix = i % 5 != 4;
      rows +=
          fix ? time + "," + std::to_string(0.1 * i + 0.003) +
                    ",0.004,0,0,0,0,0.003,0.004,0.01,0.01,0,A;B,fix,0.02\n"
              : time + (i % 2 == 0 ? ",,,,,,,,,,,,,none,0.01\n" : ",9,9,9,0,0,0,,,,,,A;B,ambiguous,0.03\n");
    }
    fixes = folder.write("fixes.csv", rows);
  }

  //! Expects one line on stderr with all of \e parts, nothing on stdout, and no folder `out`.
  void expectOneLine(const std::vector<std::string> &arguments, int code,
                     const std::vector<std::string> &parts) const
  {
    EXPECT_EQ(vpExpectRefused("vlp-evaluate", arguments, code, parts), "")
        << testing::PrintToString(arguments);
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
  }

  vpTemporaryFolder folder;
  std::string truth, estimate, fixes;
};
} // namespace

TEST_F(VlpEvaluate, PrintsTheTables)
{
  vpProcess evaluate("vlp-evaluate", {"--truth", truth, "--estimate", estimate});
  EXPECT_EQ(evaluate.wait(), done);
  EXPECT_EQ(evaluate.err(), "");
  const std::string out = evaluate.out();
  for (const char *part :
       {"of these held against the truth    51", "horizontal (mm)", "5.000", "yaw (deg)",
        "from the line (mm)", "farthest pair (the paper's diameter)", "fitted to the estimate"}) {
    EXPECT_NE(out.find(part), std::string::npos) << part << "\n" << out;
  }
  EXPECT_EQ(out.find("NEES"), std::string::npos);
  EXPECT_EQ(folder.count(), 3u);
}

TEST_F(VlpEvaluate, HelpHasExamplesAndExitCodes)
{
  vpProcess help("vlp-evaluate", {"--help"});
  EXPECT_EQ(help.wait(), done);
  for (const char *part :
       {"Examples:", "--max-gap", "--align none|origin|se2", "Exit code: 0 done; 2 bad usage"}) {
    EXPECT_NE(help.out().find(part), std::string::npos) << part;
  }
}

TEST_F(VlpEvaluate, FixesAreTheEstimateWhereThereIsNoOther)
{
  vpProcess evaluate("vlp-evaluate", {"--truth", truth, "--fixes", fixes, "--out", folder / "out"});
  EXPECT_EQ(evaluate.wait(), done);
  const std::string csv = folder.read("out/statistics.csv");
  EXPECT_EQ(csv.rfind("name,unit,value\n", 0), 0u);
  EXPECT_EQ(valueOf(csv, "pairs"), 40); // neither none nor ambiguous
  EXPECT_EQ(valueOf(csv, "frames"), 50);
  EXPECT_EQ(valueOf(csv, "ambiguous"), 5);
  EXPECT_NEAR(valueOf(csv, "fix_share"), 0.8, 1e-12);
  EXPECT_NEAR(valueOf(csv, "compute_median"), 0.02, 1e-12);
  EXPECT_NEAR(valueOf(csv, "compute_max"), 0.03, 1e-12);
  EXPECT_NEAR(valueOf(csv, "horizontal_mean"), 0.005, 1e-6);
  EXPECT_NEAR(valueOf(csv, "nees_xy_mean"), 2, 1e-3);
  EXPECT_NEAR(valueOf(csv, "nees_yaw_mean"), 0, 1e-9);
  EXPECT_NE(folder.read("out/report.html").find("<h1>fixes.csv</h1>"), std::string::npos);
}

TEST_F(VlpEvaluate, WritesFiguresAndOneReport)
{
  vpProcess evaluate("vlp-evaluate", {"--truth", truth, "--estimate", estimate, "--fixes", fixes, "--out",
                                      folder / "a/out", "--title", "Run A"});
  EXPECT_EQ(evaluate.wait(), done) << evaluate.err();
  for (const std::string name : {"scatter", "track", "pmf", "cdf", "error-over-time"}) {
    EXPECT_EQ(folder.read("a/out/" + name + ".png").substr(0, 4), "\x89PNG") << name;
    EXPECT_NE(folder.read("a/out/" + name + ".svg").find("</svg>"), std::string::npos) << name;
  }
  const auto files = std::filesystem::directory_iterator(folder / "a/out");
  EXPECT_EQ(std::distance(files, {}), 12); // nothing temporary stays
  const std::string page = folder.read("a/out/report.html");
  EXPECT_EQ(vpMarkupProblem(page), "");
  size_t figures = 0;
  for (size_t at = page.find("<svg"); at != std::string::npos; at = page.find("<svg", at + 1)) {
    ++figures;
  }
  EXPECT_EQ(figures, 5u);
  EXPECT_NE(page.find("<h1>Run A</h1>"), std::string::npos);
  EXPECT_NE(page.find("Consistency (NEES)"), std::string::npos);
}

TEST_F(VlpEvaluate, TitlesAndNamesAreNeverRun)
{
  const std::string made = folder / "made";
  const std::string evil = "</h1><script>x</script>'; system(\"touch " + made + "\") `touch " + made +
                           "` $(touch " + made + ")\n\\";
  const std::string odd = folder.write("it's $(touch made) `touch made`.tum", tum(51, 0, 0.001));
  vpProcess evaluate("vlp-evaluate", {"--truth", truth, "--estimate", odd, "--title", evil, "--out",
                                      folder / "it's \"out\" $(touch made)"});
  EXPECT_EQ(evaluate.wait(), done) << evaluate.err();
  EXPECT_FALSE(std::filesystem::exists(made));
  EXPECT_FALSE(std::filesystem::exists("made"));
  const std::string page = folder.read("it's \"out\" $(touch made)/report.html");
  EXPECT_EQ(vpMarkupProblem(page), "");
  EXPECT_NE(page.find("&lt;script&gt;"), std::string::npos);
}

TEST_F(VlpEvaluate, AlignmentLineAndGapAreObeyed)
{
  const auto csv = [&](const std::vector<std::string> &more) {
    std::vector<std::string> arguments = {"--truth", truth, "--estimate", estimate, "--out", folder / "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    vpProcess evaluate("vlp-evaluate", arguments);
    EXPECT_EQ(evaluate.wait(), done) << evaluate.err();
    return folder.read("out/statistics.csv");
  };
  EXPECT_NEAR(valueOf(csv({}), "horizontal_max"), 0.005, 1e-9);
  EXPECT_NEAR(valueOf(csv({}), "line_mean"), 0.004, 1e-9);
  EXPECT_NEAR(valueOf(csv({"--align", "se2"}), "horizontal_max"), 0, 1e-9);
  EXPECT_NEAR(valueOf(csv({"--align", "origin"}), "horizontal_max"), 0, 1e-9);
  EXPECT_NEAR(valueOf(csv({"--line", "-1,0.104,1,0.104"}), "line_mean"), 0.1, 1e-9);
  const std::string sparse =
      folder.write("sparse.tum", "0 0 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n5 5 0 0 0 0 0 1\n");
  vpProcess evaluate("vlp-evaluate",
                     {"--truth", sparse, "--estimate", estimate, "--max-gap", "2", "--out", folder / "out"});
  EXPECT_EQ(evaluate.wait(), done);
  EXPECT_EQ(valueOf(folder.read("out/statistics.csv"), "pairs"), 22); // 0 to 2 s, and at 5 s
  EXPECT_EQ(valueOf(folder.read("out/statistics.csv"), "in_truth_gaps"), 29);
}

TEST_F(VlpEvaluate, OneRowIsSane)
{
  const std::string one = folder.write("one.tum", tum(1)),
                    other = folder.write("other.tum", tum(1, 0, 0.002));
  vpProcess evaluate("vlp-evaluate", {"--truth", one, "--estimate", other, "--out", folder / "out"});
  EXPECT_EQ(evaluate.wait(), done) << evaluate.err();
  EXPECT_EQ(evaluate.out().find("nan"), std::string::npos);
  EXPECT_EQ(evaluate.out().find("fitted"), std::string::npos);
  const std::string csv = folder.read("out/statistics.csv");
  EXPECT_NEAR(valueOf(csv, "horizontal_mean"), 0.002, 1e-12);
  EXPECT_EQ(valueOf(csv, "dispersion_diameter"), 0);
  EXPECT_TRUE(std::isnan(valueOf(csv, "fit_slope")));
  EXPECT_EQ(vpMarkupProblem(folder.read("out/report.html")), "");
}

TEST_F(VlpEvaluate, NothingToEvaluateSaysWhy)
{
  const std::string empty = folder.write("empty.tum", "# no rows\n"),
                    late = folder.write("late.tum", tum(5, 100));
  const std::string ends = folder.write("ends.tum", "0 0 0 0 0 0 0 1\n5 5 0 0 0 0 0 1\n");
  const std::string inside = folder.write("inside.tum", tum(5, 2));
  const std::string none = folder.write("none.csv", fixesHeader + "0,,,,,,,,,,,,,none,0.1\n");
  const std::string head = folder.write("head.csv", fixesHeader);
  const std::vector<std::string> out = {"--out", folder / "out"};
  const auto with = [&out](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), out.begin(), out.end());
    return arguments;
  };
  expectOneLine(with({"--truth", empty, "--estimate", estimate}), nothingFound,
                {"empty.tum: no poses, nothing to evaluate against"});
  expectOneLine(with({"--truth", truth, "--estimate", empty}), nothingFound,
                {"empty.tum: no poses, nothing to evaluate"});
  expectOneLine(with({"--truth", truth, "--fixes", none}), nothingFound,
                {"none.csv", "1 frames, none with a fix"});
  expectOneLine(with({"--truth", truth, "--fixes", head}), nothingFound, {"head.csv", "0 frames"});
  expectOneLine(with({"--truth", truth, "--estimate", late}), nothingFound,
                {"late.tum: none of the 5 poses is at a time of the truth", "5 outside 0 to 5 s"});
  expectOneLine(with({"--truth", ends, "--estimate", inside}), nothingFound,
                {"5 in gaps of the truth longer than 1 s (--max-gap)"});
}

TEST_F(VlpEvaluate, BadUsageIsOneClearLine)
{
  const std::vector<std::string> good = {"--truth", truth, "--estimate", estimate, "--out", folder / "out"};
  const auto with = [&good](const std::vector<std::string> &more) {
    std::vector<std::string> arguments = good;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  expectOneLine({}, badInput, {"--truth: nothing, expected"});
  expectOneLine({"--truth", truth}, badInput, {"--estimate: nothing, expected", "--fixes"});
  expectOneLine({"--truth", ""}, badInput, {"--truth", "an empty name"});
  expectOneLine(with({"--colour", "red"}), badInput, {"--colour"});
  expectOneLine(with({"--align", "se3"}), badInput, {"--align", "se3, expected none|origin|se2"});
  for (const std::string line : {"1,2,3", "1,2,3,4,5", "a,b,c,d", "1,2,,4", "nan,0,1,1", "1 2 3 4"}) {
    expectOneLine(with({"--line", line}), badInput,
                  {"--line: " + line + ", expected four numbers x1,y1,x2,y2"});
  }
  expectOneLine(with({"--line", "1,2,1,2"}), badInput, {"--line: 1,2,1,2, expected two different points"});
  for (const std::string gap : {"0", "-1", "inf", "nan", "one"}) {
    expectOneLine(with({"--max-gap=" + gap}), badInput,
                  {"--max-gap: " + gap + ", expected a number of seconds"});
  }
}

TEST_F(VlpEvaluate, BadFilesAreOneClearLine)
{
  const std::string row = folder.write("row.tum", tum(3) + "9 1 2\n"),
                    text = folder.write("text.tum", "poses\n");
  const std::string twice = folder.write("twice.tum", tum(3) + "0 0 0 0 0 0 0 1\n");
  const std::string zero = folder.write("zero.tum", "0 0 0 0 0 0 0 0\n");
  const std::string sigma = folder.write("sigma.csv", fixesHeader + "0,0,0,0,0,0,0,-1,,,,,A,fix,0.1\n");
  const std::string far = folder.write("far.tum", "0 1.7e308 1.7e308 0 0 0 0 1\n");
  expectOneLine({"--truth", truth, "--estimate", far, "--out", folder / "out"}, badInput,
                {"errors: inf m, expected finite distances"});
  const std::string none = folder / "none.tum", out = folder / "out";
  expectOneLine({"--truth", none, "--estimate", estimate}, badInput,
                {"none.tum: cannot be opened: No such file"});
  expectOneLine({"--truth", folder.path(), "--estimate", estimate}, badInput, {"Is a directory"});
  expectOneLine({"--truth", truth, "--estimate", row}, badInput, {"row.tum:5: 3 fields, expected 8"});
  expectOneLine({"--truth", text, "--estimate", estimate}, badInput, {"text.tum:1: 1 field, expected 8"});
  expectOneLine({"--truth", twice, "--estimate", estimate}, badInput,
                {"twice.tum:5: timestamp: 0, expected"});
  expectOneLine({"--truth", truth, "--estimate", zero}, badInput, {"zero.tum:1: qx qy qz qw: of length 0"});
  expectOneLine({"--truth", truth, "--fixes", sigma, "--out", out}, badInput, {"sigma.csv:2: sigma_x: -1"});
  expectOneLine({"--truth", truth, "--fixes", truth, "--out", out}, badInput, {"truth.tum:1: header: "});
  expectOneLine({"--truth", truth, "--estimate", estimate, "--out", truth}, badInput,
                {"truth.tum: the folder cannot be made"});
  expectOneLine({"--truth", truth, "--estimate", estimate, "--out", "/proc/out"}, badInput, {"/proc/out"});
}

TEST_F(VlpEvaluate, WithoutGnuplotIsOneClearLine)
{
  const std::string before = std::getenv("PATH");
  setenv("PATH", folder.path().c_str(), 1);
  expectOneLine({"--truth", truth, "--estimate", estimate, "--out", folder / "out"}, badInput,
                {"gnuplot: cannot be run: No such file or directory", "gnuplot-nox"});
  vpProcess evaluate("vlp-evaluate", {"--truth", truth, "--estimate", estimate}); // the numbers need none
  EXPECT_EQ(evaluate.wait(), done);
  setenv("PATH", before.c_str(), 1);
}

TEST_F(VlpEvaluate, ReadsWhatVlpLocateWrites)
{
  const std::string run = std::string(VLP_DATA_DIR) + "/paper-room";
  vpProcess locate("vlp-locate", {"--run", run, "--poses", folder / "p.tum", "--fixes", folder / "f.csv"});
  ASSERT_EQ(locate.wait(), done) << locate.err();
  vpProcess evaluate("vlp-evaluate", {"--truth", run + "/truth.tum", "--estimate", folder / "p.tum",
                                      "--fixes", folder / "f.csv", "--out", folder / "out"});
  EXPECT_EQ(evaluate.wait(), done) << evaluate.err();
  const std::string csv = folder.read("out/statistics.csv");
  EXPECT_EQ(valueOf(csv, "pairs"), 9);
  EXPECT_EQ(valueOf(csv, "fix_share"), 1);
  EXPECT_LT(valueOf(csv, "horizontal_max"), 0.001);
  EXPECT_GT(valueOf(csv, "nees_xy_count"), 0);
}
