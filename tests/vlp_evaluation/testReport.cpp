/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <cstdlib>

#include <gtest/gtest.h>
#include <visp3/vlp_evaluation/vpEvaluationFigures.h>
#include <visp3/vlp_evaluation/vpGnuplot.h>
#include <visp3/vlp_evaluation/vpHtmlReport.h>
#include <visp3/vlp_evaluation/vpReportTable.h>

#include "common/vpExpectError.h"
#include "common/vpMarkup.h"
#include "common/vpTemporaryFolder.h"
#include "vlp_evaluation/madeTracks.h"

namespace
{
using namespace madeTracks;

//! An environment variable that is back at the end.
class Variable
{
public:
  Variable(const char *name, const std::string &value) : m_name(name), m_before(std::getenv(name))
  {
    m_kept = m_before == nullptr ? "" : m_before;
    setenv(name, value.c_str(), 1);
  }
  ~Variable() { m_before == nullptr ? unsetenv(m_name) : setenv(m_name, m_kept.c_str(), 1); }

private:
  const char *m_name;
  const char *m_before;
  std::string m_kept;
};

vpEvaluation evaluationOfALine()
{
  const vpTrajectory truth = straight({-0.35, 0}, {0.35, -0.005});
  const vpFixLog log = drawnFixes(truth, 1, 31);
  return vpEvaluation::of(truth, log.trajectory(), &log);
}

std::vector<vpReportFigure> drawn(const vpEvaluation &evaluation)
{
  std::vector<vpReportFigure> figures;
  for (const vpFigure &figure : vpFiguresOf(evaluation)) {
    figures.push_back({figure.name, figure.caption, figure.svg()});
  }
  return figures;
}
} // namespace

TEST(Gnuplot, DrawsAndRefuses)
{
  vpGnuplot::check();
  EXPECT_EQ(vpGnuplot::draw("set terminal pngcairo\nplot x\n").substr(1, 3), "PNG");
  vpExpectError([] { vpGnuplot::draw("plot nonsense(\n"); }, {"gnuplot: exit code 1: ", "line"});
  vpExpectError([] { vpGnuplot::draw(""); }, {"gnuplot: it drew nothing"});
}

TEST(Gnuplot, WithoutTheProgramIsOneClearError)
{
  const vpTemporaryFolder nothing;
  const Variable path("PATH", nothing.path());
  vpExpectError([] { vpGnuplot::check(); },
                {"gnuplot: cannot be run: No such file or directory", "install it (Debian: gnuplot-nox)"});
}

TEST(Gnuplot, LeavesNoFiles)
{
  const vpTemporaryFolder folder;
  const Variable place("TMPDIR", folder.path());
  vpGnuplot::draw("set terminal svg\nplot x\n");
  vpExpectError([] { vpGnuplot::draw("plot nonsense(\n"); }, {"gnuplot"});
  EXPECT_EQ(folder.count(), 0u);
}

TEST(Gnuplot, QuotedTextIsNothingButText)
{
  EXPECT_EQ(vpGnuplot::quoted("it's\n\"`a`\""), "'it\xE2\x80\x99s \"`a`\"'");
  const vpTemporaryFolder folder;
  const std::string file = folder / "made";
  const std::string evil = "'; system(\"touch " + file + "\"); `touch " + file + "` $(touch " + file + ")\n" +
                           "system(\"touch " + file + "\") \\";
  const std::string svg =
      vpGnuplot::draw("set terminal svg noenhanced\nset title " + vpGnuplot::quoted(evil) + "\nplot x\n");
  EXPECT_NE(svg.find("$(touch "), std::string::npos);
  EXPECT_EQ(folder.count(), 0u);
}

TEST(Figures, AreDrawnForOneManyAndStrangePairs)
{
  vpTrajectory one, other;
  one.add(0, pose(1, 2, 0));
  other.add(0, pose(1.5, 2, 0));
  const vpTrajectory track = eight(5000);
  vpTrajectory wide = straight({0, 0}, {1e4, 0});
  const std::vector<vpEvaluation> all = {evaluationOfALine(),
                                         vpEvaluation::of(one, one),
                                         vpEvaluation::of(one, other),
                                         vpEvaluation::of(track, track),
                                         vpEvaluation::of(track, drawnFixes(track, 1000, 32).trajectory()),
                                         vpEvaluation::of(wide, drawnFixes(wide, 1, 33).trajectory())};
  for (size_t i = 0; i < all.size(); ++i) {
    const std::vector<vpFigure> figures = vpFiguresOf(all[i]);
    ASSERT_EQ(figures.size(), 5u);
    for (const vpFigure &figure : figures) {
      SCOPED_TRACE(std::to_string(i) + " " + figure.name);
      const std::string svg = figure.svg(), png = figure.png();
      EXPECT_EQ(png.substr(1, 3), "PNG");
      EXPECT_NE(svg.find("</svg>"), std::string::npos);
      EXPECT_LT(svg.size(), 1000000u); // many pairs are thinned
      EXPECT_EQ(svg.find("nan"), std::string::npos);
    }
  }
  EXPECT_TRUE(vpFiguresOf(vpEvaluation::of(one, vpTrajectory())).empty());
}

TEST(ReportTable, TextIsInColumns)
{
  const vpReportTable table = {
      "Head", {"", "a", "bb"}, {{"one", "1", "2"}, {"three", "100", "2.5"}}, "Note."};
  EXPECT_EQ(table.text(), "Head\n"
                          "           a   bb\n"
                          "  one      1    2\n"
                          "  three  100  2.5\n"
                          "  Note.\n");
}

TEST(ReportTable, TablesHoldWhatApplies)
{
  const auto headings = [](const vpEvaluation &evaluation) {
    std::vector<std::string> texts;
    for (const vpReportTable &table : vpTablesOf(evaluation)) {
      texts.push_back(table.heading);
      for (const std::vector<std::string> &row : table.rows) {
        EXPECT_EQ(row.size(), table.columns.size());
      }
    }
    return texts;
  };
  EXPECT_EQ(headings(evaluationOfALine()),
            (std::vector<std::string>{"Data", "Errors", "Dispersion of the horizontal error", "Line",
                                      "Frames and time per fix", "Consistency (NEES)"}));
  EXPECT_EQ(headings(vpEvaluation::of(eight(), vpTrajectory())), (std::vector<std::string>{"Data"}));
}

TEST(HtmlReport, IsWellFormedAndSelfContained)
{
  const vpEvaluation evaluation = evaluationOfALine();
  const std::string page = vpHtmlReport("Run A", {"Truth: a.tum"}, evaluation, drawn(evaluation));
  EXPECT_EQ(vpMarkupProblem(page), "");
  for (const char *part :
       {"<title>Run A</title>", "<h1>Run A</h1>", "Truth: a.tum", "viewport", "@media print",
        "horizontal (mm)", "scatter-gnuplot_canvas", "cdf-gnuplot_canvas"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(vpMarkupProblem(vpHtmlReport("", {}, vpEvaluation(), {})), "");
}

TEST(HtmlReport, TextOfOthersIsEscaped)
{
  const std::string evil = "</title><script>alert('1')</script>&\"\n\x01 caf\xC3\xA9 \xE2\x82\xAC";
  const std::string broken = "\xC3 \xFF \xED\xA0\x80 \xC0\xAF \xF4\x90\x80\x80 \xE2\x82";
  const std::string page = vpHtmlReport(evil, {evil, broken}, evaluationOfALine(), {});
  EXPECT_EQ(vpMarkupProblem(page), "");
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_NE(page.find("&lt;/title&gt;&lt;script&gt;alert(&#39;1&#39;)&lt;/script&gt;&amp;&quot;"),
            std::string::npos);
  EXPECT_NE(page.find("caf\xC3\xA9 \xE2\x82\xAC"), std::string::npos); // letters of others stay
  for (const std::string bytes : {"\x01", "\xFF", "\xED\xA0", "\xC0\xAF", "\xF4\x90"}) {
    EXPECT_EQ(page.find(bytes), std::string::npos);
  }
}
