/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// The programs where system calls on their files fail or come short, or memory ends (shim/vpFaults.cpp): an
// error that names the file, and outputs that are whole or not there.

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/vpFaultyProcess.h"

namespace
{
namespace fs = std::filesystem;
using Files = std::map<std::string, std::string>; // what is in each

const std::string paperRoom = VLP_DATA_DIR "/paper-room", oldContent = "old\n";

//! All files below a folder, by their paths from there.
Files filesOf(const std::string &folder)
{
  Files files;
  for (const fs::directory_entry &entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = fs::relative(entry.path(), folder).string();
    if (entry.is_directory()) {
      files[name + "/"] = "";
    } else {
      std::ifstream file(entry.path(), std::ios::binary);
      files[name] = {std::istreambuf_iterator<char>(file), {}};
    }
  }
  return files;
}

/*!
  Whether \e bytes are a whole file like \e good, which the same program has written. They need not be the
  same: some say how long the program took.
*/
bool whole(const std::string &bytes, const std::string &good)
{
  const std::string endOfPng = "IEND\xAE\x42\x60\x82";
  if (good.find("PNG") == 1) {
    return bytes.size() > endOfPng.size() && bytes.substr(bytes.size() - endOfPng.size()) == endOfPng;
  }
  return std::count(bytes.begin(), bytes.end(), '\n') == std::count(good.begin(), good.end(), '\n') &&
         !bytes.empty() && bytes.back() == good.back();
}

//! A program that writes files into a folder.
struct Writer {
  std::string program;
  std::vector<std::string> arguments; // OUT stands for that folder
  bool newFolder = false;             // that it makes itself; else files of the same names are there already
};

class Faults : public testing::Test
{
protected:
  //! What the program writes where nothing fails.
  Files good(const Writer &writer)
  {
    const vpTemporaryFolder folder;
    vpProcess process(writer.program, argumentsOf(writer, folder));
    EXPECT_EQ(process.wait(), 0) << process.err();
    return filesOf(folder.path());
  }

  static std::vector<std::string> argumentsOf(const Writer &writer, const vpTemporaryFolder &folder)
  {
    std::vector<std::string> arguments = writer.arguments;
    for (std::string &argument : arguments) {
      if (argument.rfind("OUT", 0) == 0) {
        argument = folder.path() + argument.substr(3);
      }
    }
    return arguments;
  }

  /*!
    Files under their names are as before or whole, and there is nothing else. \param fails Whether the
    program has to give up. \return Whether the fault was hit.
  */
  static bool tryFault(const Writer &writer, const vpFault &fault, const Files &good, bool fails)
  {
    SCOPED_TRACE(writer.program + ": " + testing::PrintToString(fault));
    const vpTemporaryFolder folder;
    for (const auto &[name, bytes] : good) {
      const bool read = name.find(".xml") != std::string::npos; // other cameras in it are kept
      if (!writer.newFolder && !read) {
        folder.write(name, oldContent);
      }
    }
    const vpEnding ending = vpRunWith(fault, folder.path(), writer.program, argumentsOf(writer, folder));
    const bool thrownAway = fault.call == "close" && ending.code == 0; // a file that was only tried
    if (!ending.hit || !fails || thrownAway) {
      EXPECT_EQ(ending.code, 0) << ending.err;
    } else {
      EXPECT_EQ(ending.code, 2) << ending.err;
      expectOneError(ending.err, writer.program, folder.path());
    }
    const Files files = filesOf(folder.path());
    for (const auto &[name, bytes] : files) {
      if (good.count(name) == 0) {
        ADD_FAILURE() << name << " is left";
      } else if (name.back() != '/' && (ending.code == 0 || bytes != oldContent)) {
        EXPECT_TRUE(whole(bytes, good.at(name))) << name << ": " << bytes.substr(0, 1000);
      }
      EXPECT_TRUE(ending.code == 0 || !writer.newFolder) << name << " of a folder that failed";
    }
    EXPECT_TRUE(ending.code != 0 || files.size() == good.size());
    return ending.hit;
  }

  static void expectOneError(const std::string &err, const std::string &program, const std::string &path)
  {
    const size_t at = err.find(program + ": error: ");
    ASSERT_NE(at, std::string::npos) << err;
    EXPECT_EQ(err.find(": error: ", at + program.size() + 2), std::string::npos) << err;
    EXPECT_NE(err.substr(at, err.find('\n', at) - at).find(path), std::string::npos) << err;
    EXPECT_EQ(err.find("unexpected"), std::string::npos) << err;
  }

  //! Each of the first \e most calls fails, once for each of \e kinds.
  static void failEach(const Writer &writer, const Files &good, const std::string &call,
                       const std::vector<std::string> &kinds, int most)
  {
    bool hit = true;
    for (int i = 1; i <= most && hit; ++i) {
      hit = tryFault(writer, {call, kinds[static_cast<size_t>(i) % kinds.size()], std::to_string(i)}, good,
                     true);
      EXPECT_TRUE(hit || i > 1) << call << " was not called";
    }
  }

  //! The first \e most calls of each kind fail, each once; the disk is full for good; writing comes in
  //! pieces.
  void tryAll(const Writer &writer, int most)
  {
    const Files all = good(writer);
    ASSERT_FALSE(all.empty());
    failEach(writer, all, "write", {"EIO", "ENOSPC"}, most);
    failEach(writer, all, "open", {"EIO", "ENOSPC"}, most);
    failEach(writer, all, "close", {"ENOSPC", "EIO"}, most);
    failEach(writer, all, "rename", {"EIO", "ENOSPC"}, most);
    EXPECT_TRUE(tryFault(writer, {"write", "EINTR", "odd"}, all, false));
    if (writer.newFolder) {
      EXPECT_TRUE(tryFault(writer, {"mkdir", "ENOSPC", "1"}, all, true));
    }
    if (most > 1) {
      EXPECT_TRUE(tryFault(writer, {"write", "ENOSPC", "1+"}, all, true));
      EXPECT_TRUE(tryFault(writer, {"write", "short", "odd"}, all, false));
    }
  }

  /*!
    One of the first \e most large blocks of memory after the other, the later the sparser, is not there: an
    error, or no matter. No file is left that is not whole. GDAL, which OpenCV asks of each format, ends the
    program itself.
  */
  void endMemory(const Writer &writer, int most)
  {
    const Files all = good(writer);
    bool hit = true;
    for (int i = 1; i <= most && hit; i += 1 + i / 8) {
      SCOPED_TRACE(writer.program + ": block " + std::to_string(i));
      const vpTemporaryFolder folder;
      const vpEnding ending = vpRunWith({"memory", "", std::to_string(i)}, VLP_DATA_DIR, writer.program,
                                        argumentsOf(writer, folder));
      hit = ending.hit;
      EXPECT_TRUE(hit || i > 1) << "no large block";
      if (ending.err.find("CPLMalloc(): Out of memory") != std::string::npos) {
        continue;
      }
      const bool told = ending.err.find(writer.program + ": error: ") != std::string::npos;
      EXPECT_TRUE(ending.code == 0 || (ending.code == 2 && told)) << ending.code << ": " << ending.err;
      EXPECT_EQ(ending.err.find("unexpected"), std::string::npos) << ending.err;
      if (ending.code == 0 && told) {
        continue; // without a picture that could not be read
      }
      for (const auto &[name, bytes] : filesOf(folder.path())) {
        EXPECT_TRUE(all.count(name) > 0 && (name.back() == '/' || whole(bytes, all.at(name)))) << name;
      }
    }
  }

  Writer simulate() const
  {
    return {"vlp-simulate",
            {"--scenario", VLP_DATA_DIR "/scenarios/straight.yaml", "--frames", "1", "--out", "OUT/run"},
            true};
  }

  Writer locate() const
  {
    return {"vlp-locate",
            {"--run", paperRoom, "--frames", "2", "--poses", "OUT/poses.tum", "--fixes", "OUT/fixes.csv",
             "--seen", "OUT/seen.csv"}};
  }

  Writer overlay() const { return {"vlp-locate", {"--run", paperRoom, "--frames", "2", "--overlay", "OUT"}}; }

  Writer evaluate() const
  {
    return {"vlp-evaluate",
            {"--truth", paperRoom + "/truth.tum", "--estimate", paperRoom + "/truth.tum", "--out", "OUT"}};
  }

  Writer plan() const
  {
    return {"vlp-plan",
            {"--rig", VLP_DATA_DIR "/rigs/ub300-800x600.yaml", "--heights", "1.2:1.5", "--diameter", "0.175",
             "--lamps", "2", "--words", "--out", "OUT/lamps.yaml"}};
  }

  Writer shutter() const
  {
    return {"vlp-calibrate", {"shutter", "--run", paperRoom, "--frames", "1", "--out", "OUT"}};
  }

  Writer board() const { return {"vlp-calibrate", {"camera", "--print", "OUT/board.pdf"}}; }

  Writer servo() const
  {
    const std::string path = m_inputs.write("path.yaml", "{type: polyline, points_m: [[0, 0], [0.01, 0]]}\n");
    return {"vlp-servo",
            {"--robot", "sim", "--scenario", VLP_DATA_DIR "/scenarios/servo.yaml", "--path", path, "--log",
             "OUT/log"},
            true};
  }

  std::vector<Writer> writers() const
  {
    return {simulate(), locate(), overlay(), evaluate(), plan(), shutter(), board(), servo()};
  }

private:
  vpTemporaryFolder m_inputs;
};
} // namespace

TEST_F(Faults, FirstCallOfEachProgram)
{
  for (const Writer &writer : writers()) {
    tryAll(writer, 1);
  }
}

TEST_F(Faults, MemoryThatEnds)
{
  for (const Writer &writer : {simulate(), locate(), overlay(), shutter()}) {
    endMemory(writer, 4);
  }
}

TEST_F(Faults, MemoryThatEndsLaterSlow)
{
  for (const Writer &writer : {simulate(), locate(), overlay(), evaluate(), shutter()}) {
    endMemory(writer, 40);
  }
}

TEST_F(Faults, EachCallOfEachProgramSlow)
{
  constexpr int more = 8; // than most of them make of a kind; a program runs once for each
  for (const Writer &writer : writers()) {
    tryAll(writer, more);
  }
}

//! Inputs are read as they are, however the system hands them out.
TEST_F(Faults, InterruptedAndShortReads)
{
  vpProcess undisturbed("vlp-locate", {"--run", paperRoom, "--frames", "2"});
  ASSERT_EQ(undisturbed.wait(), 0);
  for (const char *as : {"EINTR", "short"}) {
    const vpTemporaryFolder outputs;
    const vpEnding ending =
        vpRunWith({"read", as, "odd"}, paperRoom, "vlp-locate",
                  {"--run", paperRoom, "--frames", "2", "--poses", outputs / "poses.tum"});
    EXPECT_TRUE(ending.hit);
    EXPECT_EQ(ending.code, 0) << ending.err;
    EXPECT_EQ(outputs.read("poses.tum"), undisturbed.out());
  }
}

//! A disk that does not give back what it has.
TEST_F(Faults, InputsThatCannotBeRead)
{
  constexpr int inputs = 5; // rig, camera, lamps, list, a picture
  for (int i = 1; i <= inputs; ++i) {
    SCOPED_TRACE(i);
    const vpEnding ending = vpRunWith({"read", "EIO", std::to_string(i) + "+"}, paperRoom, "vlp-locate",
                                      {"--run", paperRoom, "--frames", "1"});
    EXPECT_TRUE(ending.hit);
    EXPECT_EQ(ending.code, 2) << ending.err;
    expectOneError(ending.err, "vlp-locate", paperRoom);
  }
}

//! The driver's end of a serial line; the board's is no part of it.
TEST_F(Faults, SerialLine)
{
  for (const vpFault &fault : std::vector<vpFault>{{"read", "EINTR", "odd"},
                                                   {"read", "short", "odd"},
                                                   {"write", "EINTR", "odd"},
                                                   {"write", "short", "odd"}}) {
    SCOPED_TRACE(testing::PrintToString(fault));
    const vpEnding ending = vpRunWith(fault, "/dev/pts/", "test_vlp_robot",
                                      {"--gtest_filter=SerialTransport.CarriesEveryByteBothWays"});
    EXPECT_TRUE(ending.hit);
    EXPECT_EQ(ending.code, 0) << ending.out << ending.err;
  }
}
