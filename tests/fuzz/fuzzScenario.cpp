/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <cmath>
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
  vpFuzzReads([&] {
    const vpScenario scenario = vpScenario::load(file);
    vpFuzzExpect(scenario.frames > 0, "a frame");
    const std::unique_ptr<vpRobotMotion> motion = scenario.makeMotion();
    for (const double time : {0.0, 0.1, 0.5}) {
      const vpHomogeneousMatrix wMb = motion->wMb(time);
      vpFuzzExpect(std::all_of(wMb.data, wMb.data + 16, [](double value) { return std::isfinite(value); }),
                   "a finite pose");
    }
  });
}
