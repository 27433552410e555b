/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpSpeedCeiling_h
#define vpSpeedCeiling_h

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <visp3/core/vpException.h>
#include <visp3/core/vpImage.h>
#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_simulation/vpRollingShutterRenderer.h>

#include "luminaires/vpHalfRealPicture.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

/*!
  What hangs at the ceiling beside the map's lamps. None of it blinks, but for the lamps in the photograph.
  - plain: nothing;
  - mixed: a panel, a tube, a skylight, two steady lamps, and a ceiling that glimmers about the lamps;
  - panels: square panels in a grid;
  - tubes: rows of bright tubes;
  - windows: four of them with crossbars, brighter than white;
  - luminaires: steady lamps with the emission patterns of real ones;
  - photograph: a real dark hall with a lit door, reflections, and lamps that are no others' business.
  The last two read VLP_INPUT_IMAGE_PATH.
*/
class vpSpeedCeiling
{
public:
  static const std::vector<std::string> &kinds()
  {
    static const std::vector<std::string> all = {"plain",   "mixed",      "panels",    "tubes",
                                                 "windows", "luminaires", "photograph"};
    return all;
  }

  //! \param map Lamps, around which nothing else hangs. \throw vpException (badValue) where there is no such
  //! kind.
  vpSpeedCeiling(const std::string &kind, const vpLampMap &map) : m_kind(kind), m_map(map)
  {
    if (std::find(kinds().begin(), kinds().end(), kind) == kinds().end()) {
      throw vpException(vpException::badValue, "ceiling: '" + kind + "', expected one of vpSpeedCeiling");
    }
  }

  //! All that the renderer draws. \param focal px.
  void hang(vpSimulatedScene &scene, vpSimulatedCamera &camera, double focal) const
  {
    if (m_kind == "mixed") {
      scene.ceilingShare = 0.03;
      camera.haloShare = 0.01;
      camera.haloRadius = 0.032 * focal;
      for (const Eigen::Vector2d &at : {Eigen::Vector2d(0.05, 0.2), Eigen::Vector2d(-0.7, 0.05)}) {
        vpSimulatedLamp bulb;
        bulb.lamp.id = "bulb";
        bulb.lamp.position = {at.x(), at.y(), height};
        bulb.lamp.size = 0.15;
        scene.lamps.push_back(bulb);
      }
      scene.windows = {{{-0.05, -0.25, 1.6}, {0.3, 0, 0}, {0, 0.02, 0}, 220, {}},    // a tube
                       {{0.9, 0, 1.7}, {0.15, 0, 0}, {0, 0.2, 0}, 400, {}},          // a skylight
                       {{-0.02, 0.65, height}, {0.2, 0, 0}, {0, 0.12, 0}, 150, {}}}; // a panel
    } else if (m_kind == "panels") {
      grid({0.08, 0.08}, {0.28, 0.28}, 150, 300, scene);
    } else if (m_kind == "tubes") {
      grid({0.25, 0.015}, {0.56, 0.13}, 200, 300, scene);
    } else if (m_kind == "windows") {
      for (const double x : {-0.75, -0.25, 0.25, 0.75}) {
        pane({x, 0.02}, {0.2, 0.22}, scene);
      }
    }
  }

  //! Adds what real pictures show to a frame. \param focal px. \param middle px, where it shows the point of
  //! the ceiling above the map's origin.
  void add(double focal, const Eigen::Vector2d &middle, vpImage<unsigned char> &I)
  {
    if (m_kind != "luminaires" && m_kind != "photograph") {
      return;
    }
    if (m_light.empty()) {
      const cv::Size size(static_cast<int>(I.getWidth()) + 2 * border(focal),
                          static_cast<int>(I.getHeight()) + 2 * border(focal));
      m_light = m_kind == "photograph" ? photograph(size) : luminaires(size, focal);
    }
    const cv::Rect part(m_light.cols / 2 - cvRound(middle.x()), m_light.rows / 2 - cvRound(middle.y()),
                        static_cast<int>(I.getWidth()), static_cast<int>(I.getHeight()));
    cv::Mat_<unsigned char> picture(part.height, part.width, I.bitmap);
    cv::add(picture, m_light(part & cv::Rect({}, m_light.size())), picture);
  }

private:
  static constexpr double height = 1.5; // m, of the lamps

  static int border(double focal) { return cvRound(0.2 * focal); } // px, farther than the robot moves

  static std::string folder()
  {
    const char *path = std::getenv("VLP_INPUT_IMAGE_PATH");
    if (path == nullptr) {
      throw vpException(vpException::ioError, "VLP_INPUT_IMAGE_PATH: not set, expected the real pictures");
    }
    return path;
  }

  //! Whether nothing of a rectangle about \e at is near a lamp.
  bool free(const Eigen::Vector2d &at, const Eigen::Vector2d &half) const
  {
    static const double apart = 0.03; // m
    return std::all_of(m_map.lamps.begin(), m_map.lamps.end(), [&](const vpLamp &lamp) {
      const Eigen::Vector2d off = (lamp.position.head<2>() - at).cwiseAbs() - half;
      return off.cwiseMax(0).norm() > 0.5 * lamp.size + apart;
    });
  }

  void grid(const Eigen::Vector2d &half, const Eigen::Vector2d &apart, double dimmest, double brightest,
            vpSimulatedScene &scene) const
  {
    std::mt19937_64 generator(7);
    std::uniform_real_distribution<double> level(dimmest, brightest);
    for (double x = -1.12; x < 1.13; x += apart.x()) {
      for (double y = -0.84; y < 0.85; y += apart.y()) {
        if (free({x, y}, half)) {
          scene.windows.push_back({{x, y, height}, {half.x(), 0, 0}, {0, half.y(), 0}, level(generator), {}});
        }
      }
    }
  }

  //! A window of two by three panes.
  static void pane(const Eigen::Vector2d &at, const Eigen::Vector2d &half, vpSimulatedScene &scene)
  {
    static const double bar = 0.008; // m, half of it
    for (int i = 0; i < 2; ++i) {
      for (int k = 0; k < 3; ++k) {
        scene.windows.push_back({{at.x() + (i - 0.5) * half.x(), at.y() + (k - 1) * half.y() * 2 / 3, height},
                                 {half.x() / 2 - bar, 0, 0},
                                 {0, half.y() / 3 - bar, 0},
                                 350,
                                 {}});
      }
    }
  }

  cv::Mat_<unsigned char> luminaires(const cv::Size &size, double focal) const
  {
    std::vector<vpEmissionPattern> patterns;
    for (const vpLuminaireFamily &family : vpRealFamilies(folder())) {
      patterns.insert(patterns.end(), family.patterns.begin(), family.patterns.end());
    }
    std::mt19937_64 generator(5);
    std::uniform_real_distribution<double> even(0, 1);
    cv::Mat_<float> light(size, 0.f);
    vpHalfRealPicture picture;
    for (double x = -1.05; x < 1.06; x += 0.3) {
      for (double y = -0.75; y < 0.76; y += 0.25) {
        vpHalfRealLamp lamp;
        lamp.pattern = &patterns[generator() % patterns.size()];
        const double diameter = 0.06 + 0.14 * even(generator); // m
        lamp.middle = Eigen::Vector2d(size.width, size.height) / 2 + focal / 1.31 * Eigen::Vector2d(x, y);
        lamp.diameter = focal / 1.31 * diameter;
        lamp.angle = 2 * M_PI * even(generator);
        lamp.level = 100 + 200 * even(generator);
        // The camera looks up with its x axis backwards: the map's axes are the picture's, both turned about.
        if (free({-x, -y}, Eigen::Vector2d::Constant(0.6 * diameter))) {
          cv::Rect box;
          const cv::Mat_<float> shines = picture.unstriped(lamp, box);
          const cv::Rect seen = box & cv::Rect({}, size);
          if (!seen.empty()) {
            light(seen) += shines(seen - box.tl());
          }
        }
      }
    }
    return light;
  }

  //! The lit part of a picture of 33 megapixels, as bright as a longer exposure makes it.
  cv::Mat_<unsigned char> photograph(const cv::Size &size) const
  {
    static const double brighter = 8;
    const std::string file = folder() + "/chandelier/2013-05-11--01-25-07-75.jpg";
    cv::Mat_<unsigned char> picture = cv::imread(file, cv::IMREAD_GRAYSCALE);
    if (picture.empty()) {
      throw vpException(vpException::ioError, file + ": cannot be read");
    }
    const int rows = picture.cols * size.height / size.width, first = picture.rows * 2 / 5 - rows / 2;
    cv::Mat_<unsigned char> part = picture.rowRange(first, first + rows); // of the same proportions
    cv::resize(part, part, size, 0, 0, cv::INTER_AREA);
    part.convertTo(part, CV_8U, brighter);
    return part;
  }

  std::string m_kind;
  vpLampMap m_map;
  cv::Mat_<unsigned char> m_light; // of the real ones
};

#endif
