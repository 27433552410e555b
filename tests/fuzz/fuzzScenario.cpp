/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <filesystem>

#include <visp3/vlp_simulation/vpScenario.h>

#include "fuzz/vpFuzzTarget.h"

// Rig and lamps that it may name: those of data/, in folders beside its own.
VLP_FUZZ_TARGET(scenario)
{
  namespace fs = std::filesystem;
  static const vpTemporaryFolder folder;
  static const std::string name = [] {
    fs::create_directory(folder / "scenarios");
    for (const std::string other : {"rigs", "lamps"}) {
      fs::create_directory_symlink(fs::absolute(fs::path("data") / other), folder / other);
    }
    return std::string("scenarios/scenario.yaml");
  }();
  const std::string file = folder.write(name, std::string(reinterpret_cast<const char *>(data), size));
  vpFuzzReads([&] { vpScenario::load(file); });
}
