/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// The real pictures as other cameras would have taken them: brighter, darker, noisier, smaller, compressed,
// under four claims of the exposure. Which lamps have their ids? VLP_INPUT_IMAGE_PATH=FOLDER bench_altered

#include "../real/realSet.h"
#include "../real/vpAlteration.h"

#include <cstdio>
#include <utility>

namespace
{
vpAlteration altered(const std::string &name, double vpAlteration::*what, double value)
{
  vpAlteration alteration;
  alteration.name = name;
  alteration.*what = value;
  return alteration;
}

std::vector<vpAlteration> all()
{
  std::vector<vpAlteration> all{vpAlteration()};
  for (const vpAlteration &each : vpAlterations()) {
    all.push_back(each);
  }
  all.push_back(altered("0.5 times as bright", &vpAlteration::gain, 0.5));
  all.push_back(altered("0.6 times as large", &vpAlteration::scale, 0.6));
  all.push_back(altered("noise of 2 grey levels", &vpAlteration::noise, 2));
  all.push_back(altered("noise of 6 grey levels", &vpAlteration::noise, 6));
  all.push_back(altered("noise of 10 grey levels", &vpAlteration::noise, 10));
  vpAlteration jpeg;
  jpeg.name = "JPEG of quality 40";
  jpeg.jpeg = 40;
  all.push_back(jpeg);
  return all;
}
} // namespace

int main()
{
  if (!RealSet("ub300").present()) {
    std::fprintf(
        stderr, "bench_altered: VLP_INPUT_IMAGE_PATH is not set, expected the folder of the real pictures\n");
    return 2;
  }
  std::cout.setstate(std::ios::failbit);                     // sets tell which pictures they read
  const std::vector<std::pair<const char *, double>> sets = {// px, that middles are listed to
                                                             {"ub300", 3},
                                                             {"lumia-room", 30},
                                                             {"lumia-floor", 30},
                                                             {"lumia-floor-2", 30},
                                                             {"chandelier", 30}};
  std::printf("| pictures | lamps | right id | another id, or elsewhere |\n|---|---|---|---|\n");
  for (const vpAlteration &alteration : all()) {
    size_t lamps = 0, right = 0, named = 0;
    for (const auto &[name, within] : sets) {
      RealSet set(name);
      for (const YAML::Node &image : set.images()) {
        const vpVlpFrame frame = set.frame(image);
        const vpVlpFrame other{alteration.applied(frame.I), 0, frame.name};
        for (const double exposure : {10e-6, 30e-6, 60e-6, 120e-6}) {
          vpVlpLocalizer localizer(alteration.applied(set.rig(image, frame, exposure), other.I), set.map());
          const RealSet::Ids ids =
              set.idsOf(image, localizer.process(other).observations, within,
                        [&](const Eigen::Vector2d &middle) { return alteration.applied(middle, other.I); });
          lamps += set.lampsIn(image);
          right += ids.right;
          named += ids.named;
        }
      }
    }
    std::printf("| %s | %zu | %zu | %zu |\n", alteration.name.c_str(), lamps, right, named - right);
    std::fflush(stdout);
  }
  return 0;
}
