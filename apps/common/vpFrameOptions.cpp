/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "common/vpFrameOptions.h"

#include <algorithm>
#include <utility>

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>
#include <visp3/core/vpException.h>
#include <visp3/vlp_sensor/vpPictureSequence.h>
#include <visp3/vlp_sensor/vpVideoSource.h>

#include "common/vpCommandLine.h"
#include "common/vpInterrupt.h"
#include "common/vpProgressBar.h"

BEGIN_VISP_NAMESPACE

namespace
{
//! The first frames of a source.
class FirstFrames : public vpFrameSource
{
public:
  FirstFrames(std::unique_ptr<vpFrameSource> source, size_t most) : m_source(std::move(source)), m_most(most)
  {
  }

  bool next(vpVlpFrame &frame) override { return m_taken < m_most && (++m_taken, m_source->next(frame)); }
  size_t size() const override
  {
    const size_t all = m_source->size();
    return all > 0 ? std::min(all, m_most) : m_most;
  }
  std::string remark() const override { return m_source->remark(); }

private:
  std::unique_ptr<vpFrameSource> m_source;
  size_t m_most, m_taken = 0;
};
} // namespace

void vpFrameOptions::add(CLI::App &app)
{
  vpAddInputs(app, "--run", runs, manyRuns, "DIR",
              manyRuns ? "frames of recorded or simulated runs: DIR/frames.csv"
                       : "frames of a recorded or simulated run: DIR/frames.csv");
  vpAddName(app, "--images", pattern, "PATTERN", "frames from numbered pictures, as 'frames/%04d.png'");
  app.add_option("--image", files, "frames from these pictures, in this order")->type_name("FILE");
  vpAddName(app, "--video", video, "FILE", "frames from a video; a lossy one blurs fine stripes");
  camera.add(app);
  vpAddCount(app, "--frames", most,
             ofCamera > 0
                 ? "take as many frames at most (default: all; of a camera " + std::to_string(ofCamera) + ")"
                 : "end after as many frames; default: where they end, or at Ctrl-C");
}

void vpFrameOptions::check() const
{
  const int kinds = (runs.empty() ? 0 : 1) + (pattern.empty() ? 0 : 1) + (files.empty() ? 0 : 1) +
                    (video.empty() ? 0 : 1) + (camera.uri.empty() ? 0 : 1);
  camera.check();
  if (kinds != 1) {
    throw vpException(
        vpException::badValue,
        "frames: " + std::string(kinds == 0 ? "none" : "more than one source") +
            ", expected one of --run, --images, --image, --video and --camera (--help explains the options)");
  }
}

std::vector<std::unique_ptr<vpFrameSource>> vpFrameOptions::open(const vpVlpRig &rig) const
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
  if (!camera.uri.empty()) {
    sources.push_back(camera.open(rig));
  }
  if (const size_t taken = most > 0 || camera.uri.empty() ? most : ofCamera; taken > 0) {
    for (std::unique_ptr<vpFrameSource> &source : sources) {
      source = std::make_unique<FirstFrames>(std::move(source), taken);
    }
  }
  return sources;
}

std::string vpFrameOptions::name() const
{
  return !runs.empty()      ? runs.front()
         : !pattern.empty() ? pattern
         : !files.empty()   ? files.front()
         : !video.empty()   ? video
                            : camera.uri;
}

void vpForEachFrame(vpFrameSource &source, const std::string &name,
                    const std::function<void(const vpVlpFrame &)> &use)
{
  if (const std::string remark = source.remark(); !remark.empty()) {
    spdlog::warn(remark);
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
      spdlog::warn(error.getStringMessage());
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
