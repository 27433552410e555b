/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// A few frames for callgrind to count instructions of, which no noise disturbs: instructions.sh runs it.
// bench_instructions WIDTHxHEIGHT whole|tracked [FRAMES [CEILING]]; from the top of the repository

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <opencv2/core/utility.hpp>
#include <visp3/vlp_localization/vpVlpLocalizer.h>

#include "vpSpeedScene.h"

/*!
  All that is counted: the toggle of callgrind names this function, which no namespace of ViSP changes, and
  which frames that warm up do not pass through. \return Frames with a position.
*/
extern "C" __attribute__((noinline)) size_t
vpCountedFrames(vpVlpLocalizer &localizer, const std::vector<vpVlpFrame> &frames, size_t first)
{
  size_t fixes = 0;
  for (size_t k = first; k < frames.size(); ++k) {
    fixes += localizer.process(frames[k]).fix.valid;
  }
  return fixes;
}

int main(int argc, char **argv)
{
  vpSpeedCase what;
  const std::string kind = argc > 2 ? argv[2] : "";
  const int frames = argc > 3 ? std::atoi(argv[3]) : 4;
  what.ceiling = argc > 4 ? argv[4] : what.ceiling;
  if (argc < 3 || argc > 5 || std::sscanf(argv[1], "%ux%u", &what.width, &what.height) != 2 || frames < 1 ||
      (kind != "whole" && kind != "tracked")) {
    std::fprintf(stderr, "usage: bench_instructions WIDTHxHEIGHT whole|tracked [FRAMES [CEILING]]\n");
    return 2;
  }
  cv::setNumThreads(1);
  const vpSpeedScene scene(what);
  const int warmUp = kind == "tracked" ? 6 : 1; // frames after which all lamps are followed
  std::vector<vpVlpFrame> all;
  for (int k = 0; k < warmUp + frames; ++k) {
    all.push_back(kind == "tracked" ? scene.loopFrame(k) : scene.stillFrame(k));
  }
  vpVlpLocalizer localizer(scene.rig(), scene.map());
  localizer.tracking = kind == "tracked";
  for (int k = 0; k < warmUp; ++k) {
    localizer.process(all[static_cast<size_t>(k)]);
  }
  const size_t fixes = vpCountedFrames(localizer, all, static_cast<size_t>(warmUp));
  std::printf("%s %s: %d frames, %zu with a position\n", argv[1], argv[2], frames, fixes);
  return 0;
}
