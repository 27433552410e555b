/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Frame to pose, ours and its peers, side by side on one thread.
// bench_speed [--benchmark_filter=REGEX] ...: Google Benchmark's options; from the top of the repository

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/core/utility.hpp>
#include <visp3/vlp_localization/vpVlpLocalizer.h>
#include <visp3/vlp_tracking/vpCamshiftKalmanTracker.h>

#include "vpCeilingTags.h"
#include "vpPlainCamShift.h"
#include "vpSpeedReport.h"
#include "vpSpeedScene.h"
#include "vpSpeedStages.h"
#include "vpTextbookPipeline.h"

namespace
{
//! Frames of the last case only: those of all would fill the memory.
vpSpeedScene &sceneOf(const vpSpeedCase &what)
{
  static std::unique_ptr<vpSpeedScene> scene;
  if (!scene || scene->what().name() != what.name()) {
    scene = nullptr;
    scene = std::make_unique<vpSpeedScene>(what);
  }
  return *scene;
}

const std::vector<vpVlpFrame> &tagFramesOf(const vpSpeedCase &what)
{
  static std::string name;
  static std::vector<vpVlpFrame> frames;
  if (name != what.name()) {
    frames.clear();
    frames = vpCeilingTags(sceneOf(what)).stills();
    name = what.name();
  }
  return frames;
}

cv::Mat matOf(const vpImage<unsigned char> &I)
{
  return cv::Mat(static_cast<int>(I.getHeight()), static_cast<int>(I.getWidth()), CV_8U, I.bitmap);
}

/*!
  Measures \e process(k) over frames 0 to \e frames - 1, again and again. \return What each frame gave at
  last: all of them are done once at least, outside of the time if need be.
*/
template <class Process>
auto measure(benchmark::State &state, size_t frames, Process process)
{
  std::vector<decltype(process(size_t()))> outputs(frames);
  size_t done = 0;
  for (auto _ : state) {
    outputs[done % frames] = process(done % frames);
    ++done;
  }
  for (; done < frames; ++done) {
    outputs[done] = process(done);
  }
  return outputs;
}

vpSpeedResult resultOf(const vpVlpLocation &location)
{
  vpSpeedResult result;
  for (const vpLampObservation &lamp : location.observations) {
    if (!lamp.id.empty()) {
      result.seen.push_back({lamp.id, lamp.point});
    }
  }
  if (location.fix.valid) {
    result.wMb = location.fix.wMb;
  }
  return result;
}
const vpSpeedResult &resultOf(const vpSpeedResult &result)
{
  return result;
}

template <class Output>
void score(benchmark::State &state, const vpSpeedScene &scene, const std::vector<vpVlpFrame> &frames,
           const std::vector<Output> &outputs)
{
  vpSpeedScore score;
  for (size_t k = 0; k < frames.size(); ++k) {
    score.add(scene, scene.wMb(frames[k].timestamp), resultOf(outputs[k]));
  }
  state.counters["mean_mm"] = score.mean();
  state.counters["max_mm"] = score.largest;
  state.counters["wrong"] = static_cast<double>(score.wrong);
  state.counters["missing"] = static_cast<double>(score.missing);
  state.counters["no_fix"] = static_cast<double>(score.frames - score.fixes);
  state.counters["frames"] = static_cast<double>(score.frames);
}

void countNonZero(benchmark::State &state, const vpSpeedCase &what)
{
  const std::vector<vpVlpFrame> &frames = sceneOf(what).stills();
  measure(state, frames.size(), [&](size_t k) { return cv::countNonZero(matOf(frames[k].I)); });
}

//! The same of the frames that are tracked, which are three times as many: at 2048x1536 more than caches
//! hold, as those of a camera are.
void countNonZeroOfLoop(benchmark::State &state, const vpSpeedCase &what)
{
  const std::vector<vpVlpFrame> &frames = sceneOf(what).loop();
  measure(state, frames.size(), [&](size_t k) { return cv::countNonZero(matOf(frames[k].I)); });
}

void copy(benchmark::State &state, const vpSpeedCase &what)
{
  const std::vector<vpVlpFrame> &frames = sceneOf(what).stills();
  std::vector<unsigned char> to(frames.front().I.getSize());
  measure(state, frames.size(), [&](size_t k) {
    std::memcpy(to.data(), frames[k].I.bitmap, to.size());
    benchmark::ClobberMemory();
    return 0;
  });
}

void whole(benchmark::State &state, const vpSpeedCase &what)
{
  vpSpeedScene &scene = sceneOf(what);
  const std::vector<vpVlpFrame> &frames = scene.stills();
  vpVlpLocalizer localizer(scene.rig(), scene.map());
  localizer.tracking = false;
  localizer.process(frames.front());
  score(state, scene, frames,
        measure(state, frames.size(), [&](size_t k) { return localizer.process(frames[k]); }));
}

void tracked(benchmark::State &state, const vpSpeedCase &what)
{
  vpSpeedScene &scene = sceneOf(what);
  std::vector<vpVlpFrame> &frames = scene.loop();
  vpVlpLocalizer localizer(scene.rig(), scene.map());
  size_t count = 0;
  auto next = [&](size_t k) {
    frames[k].timestamp = static_cast<double>(count++) / vpSpeedScene::frameRate;
    return localizer.process(frames[k]);
  };
  for (size_t k = 0; k < frames.size(); ++k) {
    next(k);
  }
  score(state, scene, frames, measure(state, frames.size(), next));
}

void textbook(benchmark::State &state, const vpSpeedCase &what)
{
  vpSpeedScene &scene = sceneOf(what);
  const std::vector<vpVlpFrame> &frames = scene.stills();
  vpTextbookPipeline pipeline(scene.rig(), scene.map());
  pipeline.process(frames.front().I);
  score(state, scene, frames,
        measure(state, frames.size(), [&](size_t k) { return pipeline.process(frames[k].I); }));
}

void tags(benchmark::State &state, const vpSpeedCase &what, float decimate, float blur)
{
  vpSpeedScene &scene = sceneOf(what);
  const std::vector<vpVlpFrame> &frames = tagFramesOf(what);
  vpTagLocalizer localizer(scene.rig(), scene.map(), decimate, blur);
  score(state, scene, frames,
        measure(state, frames.size(), [&](size_t k) { return localizer.process(frames[k].I); }));
}

void stages(benchmark::State &state, const vpSpeedCase &what)
{
  vpSpeedScene &scene = sceneOf(what);
  const std::vector<vpVlpFrame> &frames = scene.stills();
  vpSpeedStages stages(scene.rig(), scene.map());
  stages.process(frames.front().I);
  stages.spent = {};
  size_t done = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(stages.process(frames[done++ % frames.size()].I));
  }
  for (size_t i = 0; i < vpSpeedStages::names().size(); ++i) {
    state.counters[vpSpeedStages::names()[i]] = 1e6 * stages.spent[i] / static_cast<double>(done); // us
  }
}

//! One lamp of the loop. \e begin gets its first window, \e track gives its middle in the next frame.
template <class Begin, class Track>
void follow(benchmark::State &state, const vpSpeedCase &what, Begin begin, Track track)
{
  vpSpeedScene &scene = sceneOf(what);
  const std::vector<vpVlpFrame> &frames = scene.loop();
  const vpLamp &lamp = scene.map().lamps.front();
  auto middle = [&](size_t k) {
    return scene.lampAt(lamp, static_cast<double>(k) / vpSpeedScene::frameRate);
  };
  const int size = cvRound(scene.diameterOf(lamp));
  const Eigen::Vector2d first = middle(0);
  begin(frames.front().I,
        cv::Rect(cvRound(first.x() - 0.5 * size), cvRound(first.y() - 0.5 * size), size, size));
  for (size_t k = 1; k < frames.size(); ++k) {
    track(frames[k].I);
  }
  const std::vector<Eigen::Vector2d> found =
      measure(state, frames.size(), [&](size_t k) -> Eigen::Vector2d { return track(frames[k].I); });
  double sum = 0, largest = 0;
  for (size_t k = 0; k < found.size(); ++k) {
    const double error = (found[k] - middle(k)).norm();
    sum += error;
    largest = std::max(largest, error);
  }
  state.counters["mean_px"] = sum / static_cast<double>(found.size());
  state.counters["max_px"] = largest;
}

void ourTracker(benchmark::State &state, const vpSpeedCase &what)
{
  vpCamshiftKalmanTracker tracker;
  follow(
      state, what,
      [&](const vpImage<unsigned char> &I, const cv::Rect &window) {
        tracker.initTracking(I, vpRect(window.x, window.y, window.width, window.height));
      },
      [&](const vpImage<unsigned char> &I) {
        tracker.track(I);
        return Eigen::Vector2d(tracker.center().get_u(), tracker.center().get_v());
      });
}

void camShift(benchmark::State &state, const vpSpeedCase &what, bool windowed)
{
  vpPlainCamShift tracker;
  tracker.share = 0.5;
  tracker.darkest = 32; // else dark stripes make the dark ceiling part of the target
  if (windowed) {
    tracker.reach = 0.5;
  }
  follow(
      state, what,
      [&](const vpImage<unsigned char> &I, const cv::Rect &window) {
        tracker.begin(matOf(I), cv::Mat(), 256, window);
      },
      [&](const vpImage<unsigned char> &I) { return tracker.track(matOf(I), cv::Mat()); });
}

//! A case like the others but for what \e change does.
template <class Change>
vpSpeedCase but(Change change)
{
  vpSpeedCase what;
  change(what);
  return what;
}

std::vector<vpSpeedCase> cases()
{
  std::vector<vpSpeedCase> all;
  const std::vector<std::pair<unsigned int, unsigned int>> sizes = {
      {640, 480}, {800, 600}, {1280, 960}, {2048, 1536}, {6592, 4944}};
  for (const auto &[width, height] : sizes) {
    all.push_back(vpSpeedCase());
    all.back().width = width;
    all.back().height = height;
  }
  all.push_back(but([](vpSpeedCase &what) { what.sigma = 0; }));
  all.push_back(but([](vpSpeedCase &what) { what.sigma = 3; }));
  for (const std::string &ceiling : vpSpeedCeiling::kinds()) {
    if (ceiling != vpSpeedCase().ceiling) {
      all.push_back(but([&ceiling](vpSpeedCase &what) { what.ceiling = ceiling; }));
    }
  }
  all.push_back(but([](vpSpeedCase &what) { what.lamps = 2; }));
  all.push_back(but([](vpSpeedCase &what) { what.lamps = 30; }));
  return all;
}

template <class... Arguments>
void add(const vpSpeedCase &what, const char *name, Arguments... arguments)
{
  benchmark::RegisterBenchmark((what.name() + "/" + name).c_str(), arguments...)
      ->Unit(benchmark::kMillisecond)
      ->MinTime(0.3);
}

void addAll()
{
  for (const vpSpeedCase &what : cases()) {
    add(what, "countNonZero", countNonZero, what);
    add(what, "countNonZeroOfLoop", countNonZeroOfLoop, what);
    add(what, "memcpy", copy, what);
    add(what, "whole", whole, what);
    add(what, "stages", stages, what);
    add(what, "tracked", tracked, what);
    add(what, "textbook", textbook, what);
    add(what, "tags", tags, what, 1.f, 0.f);
    add(what, "tags2", tags, what, 2.f, 0.f);
    add(what, "tags2blurred", tags, what, 2.f, 0.8f); // its makers' advice for noise, which it else segments
    if (what.name() == vpSpeedCase().name()) {
      add(what, "camshiftKalman", ourTracker, what);
      add(what, "camShift", camShift, what, false);
      add(what, "camShiftWindow", camShift, what, true);
    }
  }
}
} // namespace

int main(int argc, char **argv)
{
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
    return 2;
  }
  cv::setNumThreads(1);
  addAll();
  vpSpeedReport report;
  if (benchmark::RunSpecifiedBenchmarks(&report) == 0) {
    return 3;
  }
  using Column = vpSpeedReport::Column;
  const Column unit = {"countNonZero", "cv::countNonZero"}, ours = {"whole", "ours, whole frame"},
               following = {"tracked", "ours, tracked"}, book = {"textbook", "textbook"},
               tags1 = {"tags", "AprilTags"}, tags2 = {"tags2", "AprilTags, decimate 2"},
               blurred = {"tags2blurred", "AprilTags, decimate 2, blur 0.8"},
               tracker = {"camshiftKalman", "ours"};
  report.printRatios(unit,
                     {{"countNonZeroOfLoop", "of the frames tracked"},
                      {"memcpy", "memcpy"},
                      ours,
                      following,
                      book,
                      tags1,
                      tags2,
                      blurred},
                     {{book, ours}, {tags1, ours}, {tags2, ours}, {blurred, ours}});
  report.printAccuracy({ours, following, book, tags1, tags2, blurred});
  report.printShares({"stages", "stages"}, ours, vpSpeedStages::names());
  report.printTrackers(unit,
                       {tracker,
                        {"camShift", "cv::CamShift, projection of the whole frame"},
                        {"camShiftWindow", "cv::CamShift, projection of a window"}},
                       tracker);
  return 0;
}
