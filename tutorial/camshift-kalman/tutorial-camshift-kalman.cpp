/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
//! \example tutorial-camshift-kalman.cpp
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <random>
#include <string>

#include <visp3/core/vpException.h>
#include <visp3/core/vpImageConvert.h>
#include <visp3/core/vpImageDraw.h>
#include <visp3/gui/vpDisplayX.h>
#include <visp3/io/vpImageIo.h>
#include <visp3/vlp_sensor/vpVideoSource.h>
#include <visp3/vlp_tracking/vpCamshiftKalmanTracker.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

struct Options {
  std::string video; // none: a made sequence
  vpRect window;
  std::string picture;
  bool display = false;
};

bool parse(int argc, char **argv, Options &options)
{
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (name == "--display") {
      options.display = true;
      continue;
    }
    if (++i == argc)
      return false;
    double x = 0, y = 0, w = 0, h = 0;
    if (name == "--video")
      options.video = argv[i];
    else if (name == "--picture")
      options.picture = argv[i];
    else if (name == "--window" && std::sscanf(argv[i], "%lf,%lf,%lf,%lf", &x, &y, &w, &h) == 4)
      options.window.setRect(x, y, w, h);
    else
      return false;
  }
  return options.video.empty() == (options.window.getWidth() <= 0);
}

//! A lamp whose stripes have another phase in each frame; a beam that it passes behind; 60 frames.
class MadeSequence : public vpFrameSource
{
public:
  bool next(vpVlpFrame &frame) override
  {
    if (m_index == size())
      return false;
    std::normal_distribution<double> noise(0, 2); // grey levels
    const double phase = std::uniform_real_distribution<double>()(m_generator);
    frame.I.resize(240, 320);
    frame.timestamp = m_index / 30.0;
    for (int v = 0; v < 240; ++v)
      for (int u = 0; u < 320; ++u) {
        const bool lit = std::fmod(v / 7.0 + phase, 1) < 0.5;
        const bool inside = std::hypot(u - middleU(m_index), v - middleV(m_index)) < 20;
        const bool beam = u >= 170 && u < 214;
        const double grey = beam ? 45 : (inside && lit ? 200 : 15);
        frame.I[v][u] = static_cast<unsigned char>(std::max(0.0, grey + noise(m_generator)));
      }
    ++m_index;
    return true;
  }
  size_t size() const override { return 60; }

  static double middleU(size_t frame) { return 40 + 4.2 * frame; }
  static double middleV(size_t frame) { return 90 + 0.016 * frame * frame; }
  static vpRect window() { return vpRect(20, 70, 41, 41); } // around the lamp in the first frame

private:
  size_t m_index = 0;
  std::mt19937 m_generator{1};
};

//! What the tracker thought, drawn into the last picture.
struct Trail {
  vpImage<vpRGBa> picture;

  void draw(const vpImage<unsigned char> &I, const std::vector<vpImagePoint> &path,
            const std::vector<bool> &seen, const vpRect &window)
  {
    vpImageConvert::convert(I, picture);
    for (size_t k = 0; k < path.size(); ++k)
      vpImageDraw::drawCross(picture, path[k], 3, seen[k] ? vpColor::green : vpColor::red);
    if (window.getWidth() > 0)
      vpImageDraw::drawRectangle(picture, window, vpColor::green);
  }
};

int main(int argc, char **argv)
{
  Options options;
  if (!parse(argc, argv, options)) {
    std::cerr << "usage: " << argv[0] << " [--video FILE --window x,y,w,h] [--picture FILE] [--display]"
              << std::endl;
    return 2;
  }
  try {
    std::unique_ptr<vpFrameSource> source;
    if (options.video.empty())
      source = std::make_unique<MadeSequence>();
    else
      source = std::make_unique<vpVideoSource>(options.video);

    vpVlpFrame frame;
    if (!source->next(frame)) {
      std::cerr << options.video << ": no frame" << std::endl;
      return 3;
    }
    vpCamshiftKalmanTracker tracker;
    tracker.initTracking(frame.I, options.video.empty() ? MadeSequence::window() : options.window);

#ifdef VISP_HAVE_X11
    std::unique_ptr<vpDisplayX> display;
    if (options.display)
      display = std::make_unique<vpDisplayX>(frame.I, 0, 0, "Camshift-Kalman");
#endif

    std::vector<vpImagePoint> path;
    std::vector<bool> seen;
    double worst = 0; // px, of the made sequence
    while (source->next(frame)) {
      seen.push_back(tracker.track(frame.I));
      path.push_back(tracker.center());
      std::printf("%3zu: (%6.1f, %6.1f) px, similarity %.2f, sigma %5.1f px%s\n", path.size(),
                  path.back().get_u(), path.back().get_v(), tracker.similarity(), tracker.positionSigma(),
                  seen.back() ? "" : ", predicted");
      worst = std::max(worst, std::hypot(path.back().get_u() - MadeSequence::middleU(path.size()),
                                         path.back().get_v() - MadeSequence::middleV(path.size())));
      if (options.display) {
        vpDisplay::display(frame.I);
        tracker.display(frame.I, seen.back() ? vpColor::green : vpColor::red, 2);
        vpDisplay::flush(frame.I);
        if (vpDisplay::getClick(frame.I, false))
          break;
      }
    }

    if (!options.picture.empty()) {
      Trail trail;
      trail.draw(frame.I, path, seen, tracker.window());
      vpImageIo::write(trail.picture, options.picture);
    }
    if (!options.video.empty())
      return 0;
    std::printf("worst error %.1f px\n", worst);
    return worst < 20 && seen.back() ? 0 : 1;
  } catch (const vpException &error) {
    std::cerr << error.getStringMessage() << std::endl;
    return 2;
  }
}
