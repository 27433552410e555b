/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "common/vpFrameOptions.h"

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>
#include <visp3/core/vpException.h>
#include <visp3/vlp_sensor/vpPictureSequence.h>
#include <visp3/vlp_sensor/vpVideoSource.h>

#include "common/vpCommandLine.h"
#include "common/vpInterrupt.h"
#include "common/vpProgram.h"
#include "common/vpProgressBar.h"

BEGIN_VISP_NAMESPACE

void vpFrameOptions::add(CLI::App &app)
{
  app.add_option("--run", runs, "frames of recorded or simulated runs: DIR/frames.csv")->type_name("DIR");
  vpAddName(app, "--images", pattern, "PATTERN", "frames from numbered pictures, as 'frames/%04d.png'");
  app.add_option("--image", files, "frames from these pictures, in this order")->type_name("FILE");
  vpAddName(app, "--video", video, "FILE", "frames from a video; a lossy one blurs fine stripes");
}

void vpFrameOptions::check() const
{
  const int kinds =
      (runs.empty() ? 0 : 1) + (pattern.empty() ? 0 : 1) + (files.empty() ? 0 : 1) + (video.empty() ? 0 : 1);
  if (kinds != 1) {
    throw vpException(
        vpException::badValue,
        "frames: " + std::string(kinds == 0 ? "none" : "more than one source") +
            ", expected one of --run, --images, --image and --video (--help explains the options)");
  }
}

std::vector<std::unique_ptr<vpFrameSource>> vpFrameOptions::open() const
{
  std::vector<std::unique_ptr<vpFrameSource>> sources;
  for (const std::string &run : runs) {
    sources.push_back(std::make_unique<vpPictureSequence>(vpPictureSequence::fromRun(run)));
  }
  if (!pattern.empty()) {
    sources.push_back(std::make_unique<vpPictureSequence>(vpPictureSequence::fromPattern(pattern)));
  }
  if (!files.empty()) {
    sources.push_back(std::make_unique<vpPictureSequence>(files));
  }
  if (!video.empty()) {
    sources.push_back(std::make_unique<vpVideoSource>(video));
  }
  return sources;
}

std::string vpFrameOptions::name() const
{
  return !runs.empty() ? runs.front() : !pattern.empty() ? pattern : !files.empty() ? files.front() : video;
}

void vpForEachFrame(vpFrameSource &source, const std::string &name,
                    const std::function<void(const vpVlpFrame &)> &use)
{
  if (const std::string remark = source.remark(); !remark.empty()) {
    spdlog::warn(vpOneLine(remark));
  }
  vpProgressBar progress(source.size());
  size_t done = 0, used = 0;
  vpVlpFrame frame;
  for (bool more = true; more;) {
    if (vpInterrupt::requested()) {
      throw vpException(vpException::fatalError, "stopped, nothing was written");
    }
    try {
      more = source.next(frame);
    } catch (const vpException &error) { // about one frame; the rest is still to come
      progress.clear();
      spdlog::warn(vpOneLine(error.getStringMessage()));
      ++done;
      continue;
    }
    if (more) {
      try {
        use(frame);
      } catch (const vpException &error) { // knows no file
        throw vpException(error.getCode(), frame.name + ": " + error.getStringMessage());
      }
      ++used;
      progress.show(++done);
    }
  }
  if (used == 0) {
    throw vpException(vpException::badValue, name + ": no frames that can be read, expected one or more");
  }
}

END_VISP_NAMESPACE
