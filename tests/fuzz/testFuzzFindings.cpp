/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// What fuzzing has found stays mended: each target runs its folder of findings/, and seeds cut short.

#include <filesystem>
#include <set>

#include <gtest/gtest.h>
#include <visp3/vlp_core/vpReadFile.h>

#include "fuzz/vpFuzzTarget.h"

namespace
{
namespace fs = std::filesystem;

void run(const vpFuzzTarget &target, const std::string &bytes)
{
  target.function(reinterpret_cast<const std::uint8_t *>(bytes.data()), bytes.size());
}

std::vector<std::string> filesOf(const fs::path &folder)
{
  std::vector<std::string> files;
  if (fs::exists(folder)) {
    for (const fs::directory_entry &entry : fs::directory_iterator(folder)) {
      files.push_back(entry.path().string());
    }
  }
  std::sort(files.begin(), files.end()); // the same order everywhere
  return files;
}
} // namespace

// A target that breaks ends the process: the last line names what it ran.
TEST(FuzzFindings, StayMended)
{
  std::set<std::string> names;
  for (const vpFuzzTarget &target : vpFuzzTarget::all()) {
    names.insert(target.name);
    for (const std::string &file : filesOf("tests/fuzz/findings/" + target.name)) {
      std::cerr << file << "\n";
      run(target, vpReadFile(file));
    }
  }
  for (const std::string &folder : filesOf("tests/fuzz/findings")) {
    EXPECT_EQ(names.count(fs::path(folder).filename().string()), 1u) << folder << ": of no target";
  }
}

TEST(FuzzFindings, NoTargetMindsNothingOrAnything)
{
  for (const vpFuzzTarget &target : vpFuzzTarget::all()) {
    std::cerr << target.name << "\n";
    run(target, "");
    std::string bytes;
    for (unsigned int i = 0, state = 1; i < 200; ++i, state = 1664525 * state + 1013904223) {
      bytes += static_cast<char>(state >> 24);
    }
    run(target, bytes);
  }
}

TEST(FuzzFindings, FilesThatAreCutShortAreReadOrRefused)
{
  const std::vector<std::pair<std::string, std::string>> seeds = {
      {"lamps", "data/lamps/paper.yaml"},        {"path", "data/paths/square.yaml"},
      {"rig", "data/rigs/ub300-800x600.yaml"},   {"cameraXml", "data/rigs/ub300-800x600.xml"},
      {"scenario", "data/scenarios/servo.yaml"}, {"trajectory", "data/paper-room/truth.tum"},
      {"frames", "data/paper-room/frames.csv"},  {"places", "data/lamps/paper.yaml"}};
  for (const auto &[name, file] : seeds) {
    const std::vector<vpFuzzTarget> &targets = vpFuzzTarget::all();
    const auto target =
        std::find_if(targets.begin(), targets.end(),
                     [&wanted = name](const vpFuzzTarget &one) { return one.name == wanted; });
    ASSERT_NE(target, targets.end()) << name;
    std::cerr << name << ", " << file << "\n";
    const std::string bytes = vpReadFile(file);
    for (size_t size = 0; size <= bytes.size(); size += 1 + bytes.size() / 40) {
      run(*target, bytes.substr(0, size));
    }
  }
}
