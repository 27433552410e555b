/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <visp3/vlp_core/vpAtomicFile.h>
#include <visp3/vlp_core/vpCameraXml.h>
#include <visp3/vlp_core/vpCsvTable.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_core/vpPrintable.h>
#include <visp3/vlp_core/vpReadFile.h>
#include <visp3/vlp_core/vpTrajectory.h>
#include <visp3/vlp_core/vpYamlNode.h>

#include "common/vpExpectError.h"
#include "common/vpTemporaryFolder.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

TEST(NumberText, ReadsBackUnchanged)
{
  EXPECT_EQ(vpNumberText(0.1), "0.1");
  EXPECT_EQ(vpNumberText(2000), "2000");
  EXPECT_EQ(vpNumberText(-0.0), "0");
  EXPECT_EQ(vpDegreesText(M_PI), "180");
  EXPECT_EQ(vpDegreesText(0.1 * M_PI / 180), "0.1");
  std::mt19937_64 random(3);
  for (int i = 0; i < 10000; ++i) {
    const double value =
        std::ldexp(static_cast<double>(random()) - 9e18, static_cast<int>(random() % 200) - 160);
    double back = 0;
    ASSERT_TRUE(vpParseNumber(vpNumberText(value), back));
    ASSERT_EQ(back, value);
    const double angle = std::remainder(value, 2 * M_PI);
    ASSERT_TRUE(vpParseNumber(vpDegreesText(angle), back));
    ASSERT_NEAR(back * M_PI / 180, angle, 1e-15);
  }
}

TEST(NumberText, ParsesNumbersAndNothingElse)
{
  double value = 0;
  for (const auto &[text, expected] : std::vector<std::pair<std::string, double>>{{"1", 1},
                                                                                  {"+1.5", 1.5},
                                                                                  {"-2e3", -2000},
                                                                                  {" 43.1e-6 ", 43.1e-6},
                                                                                  {".5", 0.5},
                                                                                  {"5.", 5},
                                                                                  {"1E3", 1000}}) {
    EXPECT_TRUE(vpParseNumber(text, value)) << text;
    EXPECT_EQ(value, expected);
  }
  for (const std::string text :
       {"", " ", "+", "-", "+-1", "1,5", "1 2", "0x10", "1e", "one", "1.5.2", "1e999", "--1"}) {
    EXPECT_FALSE(vpParseNumber(text, value)) << text;
  }
}

TEST(NumberText, ShownStaysOneShortLine)
{
  EXPECT_EQ(vpShown("a\nb\t"), "a\\x0ab\\x09");
  EXPECT_EQ(vpShown(std::string(1000, 'x')).size(), 83u);
}

TEST(NumberText, ShownCutsBetweenCharacters)
{
  const std::string before(79, 'x'), umlaut = "\xC3\xBC";
  EXPECT_EQ(vpShown(before + umlaut), before + "...");
  EXPECT_EQ(vpShown(before.substr(1) + umlaut), before.substr(1) + umlaut);
}

TEST(Printable, KeepsTextAndEscapesWhatIsNone)
{
  const std::string text = "lamp 1, L\xC3\xBC"
                           "fter, \xE7\x81\xAF, \xF0\x9F\x92\xA1 \\x";
  EXPECT_EQ(vpPrintable(text), text);
  EXPECT_EQ(vpPrintable(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(vpPrintable("\x1b[2J\r\n\x7f"), "\\x1b[2J\\x0d\\x0a\\x7f");
  EXPECT_EQ(vpPrintable("\xC2\x9b"
                        "31m"),
            "\\xc2\\x9b31m"); // CSI as one character
  EXPECT_EQ(vpPrintable("\x9b"
                        "31m"),
            "\\x9b31m");                                     // and as one byte
  EXPECT_EQ(vpPrintable("\xE2\x80\xAE"), "\\xe2\\x80\\xae"); // from right to left
  EXPECT_EQ(vpPrintable("\xE2\x80\xA8"), "\\xe2\\x80\\xa8"); // end of a line
  EXPECT_EQ(vpPrintable("\xC3"), "\\xc3");                   // cut short
  EXPECT_EQ(vpPrintable("\xC0\xAF"), "\\xc0\\xaf");          // longer than it has to be
  EXPECT_EQ(vpPrintable("\xED\xA0\x80"), "\\xed\\xa0\\x80"); // half a surrogate pair
}

TEST(Printable, NamesOfFilesInErrors)
{
  const vpTemporaryFolder folder;
  const std::string name = "a\n\x1b[2J\xff", shown = folder / "a\\x0a\\x1b[2J\\xff";
  vpExpectError([&] { vpReadFile(folder / name); }, {shown + ": cannot be opened"});
  vpExpectError([&] { vpAtomicFile file(folder / (name + "/b")); }, {shown + "/b: cannot be written"});
  const std::string file = folder.write(name, "none");
  vpExpectError([&] { vpCsvTable::load(file, {"x"}); }, {shown + ":1: header"});
  vpExpectError([&] { vpYamlNode::load(file).text("id"); }, {shown});
  vpExpectError([&] { vpTrajectory::load(file); }, {shown + ":1: 1 field"});
  vpExpectError([&] { vpCameraXml::load(file, "camera"); }, {shown + ":1: not XML"});
}

TEST(Printable, NamesOfCamerasAreRefusedThatXmlCannotHold)
{
  const vpTemporaryFolder folder;
  vpCameraXml xml;
  xml.name = "a\x1b";
  vpExpectError([&] { xml.save(folder / "camera.xml"); }, {"camera.name: a\\x1b, expected text on one line"});
  EXPECT_EQ(folder.count(), 0u);
}

TEST(AtomicFile, AppearsWholeOrNotAtAll)
{
  const vpTemporaryFolder folder;
  folder.write("out.txt", "before");
  {
    vpAtomicFile file(folder / "out.txt");
    file.stream() << "half";
    file.stream().flush();
    EXPECT_EQ(folder.read("out.txt"), "before");
    EXPECT_EQ(folder.count(), 2u);
  }
  EXPECT_EQ(folder.read("out.txt"), "before");
  EXPECT_EQ(folder.count(), 1u);

  vpAtomicFile file(folder / "out.txt"), other(folder / "out.txt");
  file.stream() << "first\n";
  other.stream() << "second\n";
  file.commit();
  EXPECT_EQ(folder.read("out.txt"), "first\n");
  other.commit();
  EXPECT_EQ(folder.read("out.txt"), "second\n");
  EXPECT_EQ(folder.count(), 1u);
  vpExpectError([&] { file.commit(); }, {folder / "out.txt: committed twice"});
}

TEST(AtomicFile, FollowsALink)
{
  const vpTemporaryFolder folder;
  folder.write("real.txt", "before");
  std::filesystem::create_symlink("real.txt", folder / "link.txt");
  vpAtomicFile file(folder / "link.txt");
  file.stream() << "after";
  file.commit();
  EXPECT_EQ(folder.read("real.txt"), "after");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
}

TEST(AtomicFile, SaysWhatWentWrong)
{
  const vpTemporaryFolder folder;
  vpExpectError([&] { vpAtomicFile file(folder.path()); },
                {folder.path() + ": cannot be written: Is a directory"});
  vpExpectError([&] { vpAtomicFile file(folder / "a/b.txt"); },
                {folder / "a/b.txt: cannot be written: No such file or directory"});
  if (std::filesystem::exists("/dev/full")) {
    vpExpectError(
        [] {
          vpAtomicFile file("/dev/full");
          file.stream() << "text";
          file.commit();
        },
        {"/dev/full: cannot be written: No space left on device"});
    vpExpectError(
        [] {
          vpAtomicFile file("/dev/full");
          file.stream() << std::string(100000, 'x'); // which fails at once, not at the end
          file.commit();
        },
        {"/dev/full: cannot be written: No space left on device"});
  }
}

TEST(CsvTable, ReadsWhatTheFileSays)
{
  const vpTemporaryFolder folder;
  const vpCsvTable table = vpCsvTable::load(
      folder.write("frames.csv", "timestamp_s,file\r\n0.5,a.png\r\n 1e-3 ,\"b,\"\"c\"\".png\"\r\n\n"),
      {"timestamp_s", "file"});
  ASSERT_EQ(table.rows(), 2u);
  EXPECT_EQ(table.number(0, 0), 0.5);
  EXPECT_EQ(table.text(0, 1), "a.png");
  EXPECT_EQ(table.number(1, 0), 1e-3);
  EXPECT_EQ(table.text(1, 1), "b,\"c\".png");
  EXPECT_EQ(vpCsvTable::field("b,\"c\".png"), "\"b,\"\"c\"\".png\"");
  EXPECT_EQ(vpCsvTable::field("plain"), "plain");
  EXPECT_EQ(vpCsvTable::field("a\nb\x1b[2J"), "\"a b [2J\"");
  EXPECT_EQ(vpCsvTable::load(folder.write("empty.csv", "\xEF\xBB\xBFx,y"), {"x", "y"}).rows(), 0u);
}

TEST(CsvTable, BadFilesAreRefusedWithFileLineAndColumn)
{
  struct Bad {
    std::string text, part;
  };
  const std::string head = "timestamp_s,v_m_s\n0,1\n";
  const std::vector<Bad> all = {
      {"", ":1: header: nothing, expected timestamp_s,v_m_s"},
      {"0,1\n", ":1: header: 0,1, expected timestamp_s,v_m_s"},
      {"v_m_s,timestamp_s\n", ":1: header: v_m_s,timestamp_s, expected timestamp_s,v_m_s"},
      {head + "1\n", ":3: 1 field, expected 2: timestamp_s,v_m_s"},
      {head + "1,2,3\n", ":3: 3 fields, expected 2"},
      {head + "\n1,2\n", ":3: 1 field, expected 2"},
      {head + "1,abc\n", ":3: v_m_s: abc, expected a finite number"},
      {head + "1,\n", ":3: v_m_s: nothing, expected a finite number"},
      {head + "nan,1\n", ":3: timestamp_s: nan, expected a finite number"},
      {head + "1,-inf\n", ":3: v_m_s: -inf, expected a finite number"},
      {head + "1,\"2\n", ":3: misplaced quote: 1,\"2, expected"},
      {head + "1,a\"2\"\n", ":3: misplaced quote"},
      {head + "1,\"2\"3\n", ":3: misplaced quote"},
      {head + "1;2\n", ":3: 1 field, expected 2"},
  };
  for (const Bad &bad : all) {
    SCOPED_TRACE(bad.text);
    const vpTemporaryFolder folder;
    const std::string file = folder.write("odometry.csv", bad.text);
    vpExpectError(
        [&] {
          const vpCsvTable table = vpCsvTable::load(file, {"timestamp_s", "v_m_s"});
          for (size_t row = 0; row < table.rows(); ++row) {
            table.number(row, 0);
            table.number(row, 1);
          }
        },
        {file + bad.part});
  }
  vpExpectError([] { vpCsvTable::load("/none.csv", {"x"}); }, {"/none.csv: cannot be opened: No such file"});
}

TEST(YamlNode, ReadsEachKind)
{
  const vpTemporaryFolder folder;
  const vpYamlNode top = vpYamlNode::load(folder.write(
      "a.yaml",
      "n: -3.5\nb: true\nt: some text\nw: 12\nlist: [1, 2]\nmap: {x: 1}\nmaps: [{x: 1}, {x: 2}]\nc: two\n"));
  EXPECT_TRUE(top.has("n"));
  EXPECT_FALSE(top.has("m"));
  EXPECT_EQ(top.number("n"), -3.5);
  EXPECT_EQ(top.number("m", vpYamlNode::Range::any, 7), 7);
  EXPECT_TRUE(top.boolean("b"));
  EXPECT_EQ(top.text("t"), "some text");
  EXPECT_EQ(top.text("m", "left out"), "left out");
  EXPECT_EQ(top.wholeNumber("w"), 12u);
  EXPECT_EQ(top.numbers("list", 2), (std::vector<double>{1, 2}));
  EXPECT_EQ(top.mapping("map").number("x"), 1);
  EXPECT_EQ(top.mappings("maps").at(1).number("x"), 2);
  EXPECT_EQ(top.choice("c", {"one", "two"}), 1u);
  top.finish();
  vpExpectError([&] { top.wholeNumber("w", 13); }, {":4: w: 12, expected a whole number of 13 or more"});
  vpExpectError([&] { top.wholeNumber("n"); }, {":1: n: -3.5, expected a whole number of 0 or more"});
  vpExpectError([&] { top.mapping("map").fail("x", "too small"); }, {folder / "a.yaml:6: map.x: too small"});
  vpExpectError([&] { top.mapping("map").fail("", "no good"); }, {folder / "a.yaml:6: map: no good"});
}
