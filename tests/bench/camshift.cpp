/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// The Camshift-Kalman tracker and its peers on the same made video.

#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <string>

#include <opencv2/core/utility.hpp>
#include <visp3/core/vpException.h>
#include <visp3/core/vpImageConvert.h>
#include <visp3/vlp_tracking/vpTargetTracker.h>

#include "common/vpTargetScene.h"
#include "vpPlainCamShift.h"

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

//! Of grey values, or of the hue of what has colour. \e share: of the window that the histogram is of, as a
//! careful user takes it who sees that corners are background.
class PlainCamShift : public Tracker
{
public:
  explicit PlainCamShift(double share = 1) { m_tracker.share = share; }
  void begin(const Frame &frame, const vpRect &window) override
  {
    const cv::Mat feature = featureOf(frame);
    m_tracker.begin(feature, m_mask, frame.isColour ? 180 : 256,
                    cv::Rect(cvRound(window.getLeft()), cvRound(window.getTop()), cvRound(window.getWidth()),
                             cvRound(window.getHeight())));
  }
  Eigen::Vector2d track(const Frame &frame) override
  {
    const cv::Mat feature = featureOf(frame);
    return m_tracker.track(feature, m_mask);
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

  vpPlainCamShift m_tracker;
  cv::Mat m_hsv, m_hue, m_mask; // the mask is empty for grey frames
};

struct Scene {
  const char *name;
  std::function<vpTargetScene(unsigned int)> make;
  bool colour = false;
};

//! One of a video's figures, 0 to 1, drawn by its seed.
double drawn(unsigned int seed, unsigned int figure)
{
  std::mt19937 generator(seed * 7 + figure);
  generator.discard(10); // the first ones of neighbouring seeds are alike
  return std::uniform_real_distribution<double>()(generator);
}

vpTargetScene weaving(unsigned int seed)
{
  vpTargetScene scene(seed);
  const double slant = 2 * M_PI * drawn(seed, 0);
  scene.path = [slant](int k) {
    return Eigen::Vector2d(400 + 280 * std::sin(0.03 * k + slant),
                           300 + 190 * std::sin(0.041 * k + 2 * slant));
  };
  return scene;
}

vpTargetScene straight(unsigned int seed)
{
  vpTargetScene scene(seed);
  const double x = 60 + drawn(seed, 1), y = 220 + 80 * drawn(seed, 2);
  scene.path = [x, y](int k) { return Eigen::Vector2d(x + 5.6 * k, y + 0.7 * k); };
  return scene;
}

vpTargetScene circling(unsigned int seed)
{
  vpTargetScene scene(seed);
  const double first = 2 * M_PI * drawn(seed, 3);
  scene.path = [first](int k) { // from standstill to 55 px from frame to frame
    const double angle = first + (k < 20 ? 0.00625 * k * k : 2.5 + 0.25 * (k - 20));
    return Eigen::Vector2d(400 + 220 * std::cos(angle), 300 + 220 * std::sin(angle));
  };
  return scene;
}

vpTargetScene striped(vpTargetScene scene)
{
  scene.background.mean = cv::Scalar::all(12);
  scene.background.sigma = 2;
  scene.target = {cv::Scalar::all(200), 0, 8};
  scene.stripePeriod = 6.7 + 6.8 * drawn(scene.seed, 4);
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
             const double below = 40 * drawn(seed, 5);
             scene.other = [path, below](int k) { // meets it in the middle
               const Eigen::Vector2d met = path(60);
               return Eigen::Vector2d(met.x() - 5.1 * (k - 60), met.y() + below + 0.4 * (k - 60));
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
  double seconds = 0; // of one core
  int refused = 0;    // videos that it could not begin with

  std::string text()
  {
    if (errors.empty())
      return "cannot begin";
    std::sort(errors.begin(), errors.end());
    double sum = 0;
    for (double error : errors)
      sum += error;
    const double count = static_cast<double>(errors.size());
    std::array<char, 100> buffer{};
    std::snprintf(buffer.data(), buffer.size(), "%.2f / %.2f / %.1f; %.1f; %.2f", sum / count,
                  errors[static_cast<size_t>(0.95 * (count - 1))], errors.back(), 100 * lost / count,
                  1000 * seconds / count);
    return buffer.data() + (refused > 0 ? " (" + std::to_string(refused) + " not begun)" : std::string());
  }
};

const std::vector<std::pair<const char *, std::function<std::unique_ptr<Tracker>()>>> &trackers()
{
  using Method = vpTargetTracker::Method;
  static const std::vector<std::pair<const char *, std::function<std::unique_ptr<Tracker>()>>> all = {
      {"Camshift-Kalman", [] { return std::make_unique<Ours>(Method::camshiftKalman, true); }},
      {"cv::CamShift", [] { return std::make_unique<PlainCamShift>(); }},
      {"cv::CamShift, histogram of the window's middle half",
       [] { return std::make_unique<PlainCamShift>(0.5); }},
      {"vpDot2", [] { return std::make_unique<Ours>(Method::dot2, false); }},
      {"vpMeEllipse", [] { return std::make_unique<Ours>(Method::meEllipse, false); }}};
  return all;
}

void run(const Scene &scene, unsigned int firstSeed, int seeds, int frames)
{
  std::vector<Result> results(trackers().size());
  for (unsigned int seed = firstSeed; seed < firstSeed + static_cast<unsigned int>(seeds); ++seed) {
    const vpTargetScene video = scene.make(seed);
    std::vector<std::unique_ptr<Tracker>> running;
    const Frame first = frameOf(video, 0, scene.colour);
    for (size_t i = 0; i < trackers().size(); ++i) {
      running.push_back(trackers()[i].second());
      try {
        running[i]->begin(first, video.firstWindow());
      } catch (const vpException &) {
        running[i] = nullptr;
        ++results[i].refused;
      }
    }
    for (int k = 1; k < frames; ++k) {
      const Frame frame = frameOf(video, k, scene.colour);
      for (size_t i = 0; i < trackers().size(); ++i) {
        if (!running[i])
          continue;
        const std::clock_t start = std::clock();
        const Eigen::Vector2d found = running[i]->track(frame);
        results[i].seconds += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
        results[i].errors.push_back((found - video.path(k)).norm());
        results[i].lost += results[i].errors.back() > video.size / 2;
      }
    }
  }
  std::printf("| %s |", scene.name);
  for (Result &result : results)
    std::printf(" %s |", result.text().c_str());
  std::printf("\n");
  std::fflush(stdout);
}
} // namespace

int main(int argc, char **argv)
{
  const unsigned int first = argc > 1 ? static_cast<unsigned int>(std::atoi(argv[1])) : 1;
  const int seeds = argc > 2 ? std::atoi(argv[2]) : 5;
  const int frames = argc > 3 ? std::atoi(argv[3]) : 120;
  if (seeds < 1 || frames < 2) {
    std::fprintf(stderr, "usage: bench_camshift [FIRST_SEED [SEEDS [FRAMES]]]\n");
    return 2;
  }
  cv::setNumThreads(1); // as the others
  std::printf(
      "seeds %u to %u, videos of %d frames, 800 x 600, target 60 px. Error of the middle, px: mean / 95 %% / "
      "largest; frames with more than 30 px, %%; ms of one core a frame\n\n",
      first, first + static_cast<unsigned int>(seeds) - 1, frames);
  std::printf("| scene |");
  for (const auto &tracker : trackers())
    std::printf(" %s |", tracker.first);
  std::printf("\n|---|---|---|---|---|---|\n");
  for (const Scene &scene : scenes())
    run(scene, first, seeds, frames);
  return 0;
}
