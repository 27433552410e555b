/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// The Camshift-Kalman tracker and its peers on the same made video.

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include <opencv2/video/tracking.hpp>
#include <visp3/core/vpException.h>
#include <visp3/core/vpImageConvert.h>
#include <visp3/vlp_tracking/vpTargetTracker.h>

#include "common/vpTargetScene.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
//! What a tracker is given: the same frame in the form that it takes.
struct Frame {
  vpImage<unsigned char> grey;
  vpImage<vpRGBa> colour;
  cv::Mat_<unsigned char> greyMat;
  cv::Mat_<cv::Vec3b> colourMat; // blue, green, red
  bool isColour = false;
};

class Tracker
{
public:
  virtual ~Tracker() = default;
  virtual void begin(const Frame &frame, const vpRect &window) = 0;
  virtual Eigen::Vector2d track(const Frame &frame) = 0;
};

class Ours : public Tracker
{
public:
  Ours(vpTargetTracker::Method method, bool colours)
      : m_tracker(vpTargetTracker::make(method)), m_colours(colours)
  {
  }
  void begin(const Frame &frame, const vpRect &window) override
  {
    if (m_colours && frame.isColour)
      m_tracker->initTracking(frame.colour, window);
    else
      m_tracker->initTracking(frame.grey, window);
  }
  Eigen::Vector2d track(const Frame &frame) override
  {
    if (m_colours && frame.isColour)
      m_tracker->track(frame.colour);
    else
      m_tracker->track(frame.grey);
    return {m_tracker->center().get_u(), m_tracker->center().get_v()};
  }

private:
  std::unique_ptr<vpTargetTracker> m_tracker;
  bool m_colours;
};

//! As OpenCV's example has it: a histogram of the first window (grey values, or the hue of what has colour),
//! back projected onto the whole frame, and the window widened where it has shrunk to nothing.
class PlainCamShift : public Tracker
{
public:
  void begin(const Frame &frame, const vpRect &window) override
  {
    m_window = cv::Rect(cvRound(window.getLeft()), cvRound(window.getTop()), cvRound(window.getWidth()),
                        cvRound(window.getHeight()));
    const cv::Mat feature = featureOf(frame);
    const cv::Mat part = feature(m_window), mask = frame.isColour ? cv::Mat(m_mask(m_window)) : cv::Mat();
    cv::calcHist(&part, 1, &m_channel, mask, m_histogram, 1, &m_bins, ranges(frame));
    cv::normalize(m_histogram, m_histogram, 0, 255, cv::NORM_MINMAX);
  }
  Eigen::Vector2d track(const Frame &frame) override
  {
    const cv::Mat feature = featureOf(frame);
    cv::calcBackProject(&feature, 1, &m_channel, m_histogram, m_projection, ranges(frame));
    if (frame.isColour)
      m_projection &= m_mask;
    const cv::TermCriteria until(cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 10, 1);
    const cv::RotatedRect found = cv::CamShift(m_projection, m_window, until);
    if (m_window.area() <= 1) {
      const int more = (std::min(feature.cols, feature.rows) + 5) / 6;
      m_window = cv::Rect(m_window.x - more, m_window.y - more, 2 * more, 2 * more) &
                 cv::Rect(0, 0, feature.cols, feature.rows);
      if (m_window.area() <= 0)
        m_window = cv::Rect(0, 0, feature.cols, feature.rows);
      return {m_window.x + 0.5 * (m_window.width - 1), m_window.y + 0.5 * (m_window.height - 1)};
    }
    return {found.center.x, found.center.y};
  }

private:
  cv::Mat featureOf(const Frame &frame)
  {
    if (!frame.isColour)
      return frame.greyMat;
    cv::cvtColor(frame.colourMat, m_hsv, cv::COLOR_BGR2HSV);
    cv::inRange(m_hsv, cv::Scalar(0, 30, 10), cv::Scalar(180, 256, 256), m_mask);
    cv::extractChannel(m_hsv, m_hue, 0);
    return m_hue;
  }
  const float **ranges(const Frame &frame)
  {
    m_ranges = frame.isColour ? m_hues : m_greys;
    return &m_ranges;
  }

  const int m_channel = 0, m_bins = 16;
  const float m_greys[2] = {0, 256}, m_hues[2] = {0, 180};
  const float *m_ranges = nullptr;
  cv::Rect m_window;
  cv::Mat m_histogram, m_projection, m_hsv, m_hue, m_mask;
};

struct Scene {
  const char *name;
  std::function<vpTargetScene(unsigned int)> make;
  bool colour = false;
};

vpTargetScene weaving(unsigned int seed)
{
  vpTargetScene scene(seed);
  const double slant = 0.3 * seed;
  scene.path = [slant](int k) {
    return Eigen::Vector2d(400 + 280 * std::sin(0.03 * k + slant),
                           300 + 190 * std::sin(0.041 * k + 2 * slant));
  };
  return scene;
}

vpTargetScene straight(unsigned int seed)
{
  vpTargetScene scene(seed);
  scene.path = [seed](int k) { return Eigen::Vector2d(60.3 + 5.6 * k, 200 + 20 * seed + 0.7 * k); };
  return scene;
}

vpTargetScene circling(unsigned int seed)
{
  vpTargetScene scene(seed);
  scene.path = [seed](int k) { // from standstill to 55 px from frame to frame
    const double angle = k < 20 ? 0.00625 * k * k : 2.5 + 0.25 * (k - 20);
    return Eigen::Vector2d(400 + 220 * std::cos(seed + angle), 300 + 220 * std::sin(seed + angle));
  };
  return scene;
}

vpTargetScene striped(vpTargetScene scene)
{
  scene.background.mean = cv::Scalar::all(12);
  scene.background.sigma = 2;
  scene.target = {cv::Scalar::all(200), 0, 8};
  scene.stripePeriod = 5 + 1.7 * scene.seed;
  return scene;
}

std::vector<Scene> scenes()
{
  return {{"plain motion", weaving},
          {"textured object",
           [](unsigned int seed) {
             vpTargetScene scene = weaving(seed);
             scene.square = true;
             scene.target = {cv::Scalar::all(150), 40, 6};
             return scene;
           }},
          {"partial occlusion",
           [](unsigned int seed) {
             vpTargetScene scene = straight(seed);
             scene.obstacles = [](int) {
               return std::vector<cv::Rect>{{200, 0, 30, 600}, {360, 0, 36, 600}, {520, 0, 42, 600}};
             };
             return scene;
           }},
          {"full occlusion, 1 s (30 frames)",
           [](unsigned int seed) {
             vpTargetScene scene = straight(seed);
             scene.obstacles = [](int) { return std::vector<cv::Rect>{{250, 0, 228, 600}}; };
             return scene;
           }},
          {"similar background",
           [](unsigned int seed) {
             vpTargetScene scene = weaving(seed);
             scene.background = {cv::Scalar::all(110), 35, 12};
             scene.target = {cv::Scalar::all(170), 25, 6};
             return scene;
           }},
          {"similar target crossing",
           [](unsigned int seed) {
             vpTargetScene scene = straight(seed);
             const vpTargetScene::Path path = scene.path;
             scene.other = [path, seed](int k) { // meets it in the middle, 0 to 40 px below
               const Eigen::Vector2d met = path(60);
               return Eigen::Vector2d(met.x() - 5.1 * (k - 60), met.y() + 10. * (seed - 1) + 0.4 * (k - 60));
             };
             return scene;
           }},
          {"turning robot (to 55 px a frame)", circling},
          {"striped lamp", [](unsigned int seed) { return striped(weaving(seed)); }},
          {"striped lamp, turning robot", [](unsigned int seed) { return striped(circling(seed)); }},
          {"colour, background of the same grey",
           [](unsigned int seed) {
             vpTargetScene scene = weaving(seed);
             scene.background = {cv::Scalar(110, 125, 120), 25, 12};
             scene.target = {cv::Scalar(200, 90, 70), 15, 6};
             return scene;
           },
           true}};
}

Frame frameOf(const vpTargetScene &scene, int k, bool colour)
{
  Frame frame;
  frame.isColour = colour;
  if (colour) {
    frame.colour = scene.colour(k);
    vpImageConvert::convert(frame.colour, frame.grey);
    vpImageConvert::convert(frame.colour, frame.colourMat);
  } else {
    frame.grey = scene.grey(k);
  }
  frame.greyMat = cv::Mat_<unsigned char>(static_cast<int>(frame.grey.getHeight()),
                                          static_cast<int>(frame.grey.getWidth()), frame.grey.bitmap);
  return frame;
}

//! Over all seeds.
struct Result {
  std::vector<double> errors; // px
  int lost = 0;
  double seconds = 0;
  int refused = 0; // videos that it could not begin with

  void print(const char *name, const char *tracker)
  {
    std::sort(errors.begin(), errors.end());
    double sum = 0;
    for (double error : errors)
      sum += error;
    const double count = std::max<size_t>(errors.size(), 1);
    if (errors.empty())
      std::printf("| %s | %s | cannot begin | | | |\n", name, tracker);
    else
      std::printf("| %s | %s%s | %.2f | %.2f | %.1f | %.3f |\n", name, tracker,
                  refused > 0 ? (" (" + std::to_string(refused) + " not begun)").c_str() : "", sum / count,
                  errors[static_cast<size_t>(0.95 * (errors.size() - 1))], 100 * lost / count,
                  1000 * seconds / count);
    std::fflush(stdout);
  }
};

void run(const Scene &scene, int seeds, int frames)
{
  using Method = vpTargetTracker::Method;
  const std::vector<std::pair<const char *, std::function<std::unique_ptr<Tracker>()>>> trackers = {
      {"Camshift-Kalman", [] { return std::make_unique<Ours>(Method::camshiftKalman, true); }},
      {"cv::CamShift", [] { return std::make_unique<PlainCamShift>(); }},
      {"vpDot2", [] { return std::make_unique<Ours>(Method::dot2, false); }},
      {"vpMeEllipse", [] { return std::make_unique<Ours>(Method::meEllipse, false); }}};
  std::vector<Result> results(trackers.size());
  for (int seed = 1; seed <= seeds; ++seed) {
    const vpTargetScene video = scene.make(seed);
    std::vector<std::unique_ptr<Tracker>> running;
    const Frame first = frameOf(video, 0, scene.colour);
    for (size_t i = 0; i < trackers.size(); ++i) {
      running.push_back(trackers[i].second());
      try {
        running[i]->begin(first, video.firstWindow());
      } catch (const vpException &) {
        running[i] = nullptr;
        ++results[i].refused;
      }
    }
    for (int k = 1; k < frames; ++k) {
      const Frame frame = frameOf(video, k, scene.colour);
      for (size_t i = 0; i < trackers.size(); ++i) {
        if (!running[i])
          continue;
        const auto start = std::chrono::steady_clock::now();
        const Eigen::Vector2d found = running[i]->track(frame);
        results[i].seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        results[i].errors.push_back((found - video.path(k)).norm());
        results[i].lost += results[i].errors.back() > video.size / 2;
      }
    }
  }
  for (size_t i = 0; i < trackers.size(); ++i)
    results[i].print(scene.name, trackers[i].first);
}
} // namespace

int main(int argc, char **argv)
{
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 5;
  const int frames = argc > 2 ? std::atoi(argv[2]) : 120;
  std::printf("%d videos of %d frames for each scene, 800 x 600, target 60 px; lost: centre off by more than "
              "30 px\n\n",
              seeds, frames);
  std::printf("| scene | tracker | mean error, px | 95 %%, px | lost, %% of frames | ms a frame |\n");
  std::printf("|---|---|---|---|---|---|\n");
  for (const Scene &scene : scenes())
    run(scene, seeds, frames);
  return 0;
}
