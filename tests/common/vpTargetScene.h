/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpTargetScene_h
#define vpTargetScene_h

/*!
  \file vpTargetScene.h
  Made video of one moving target, with the truth: a background that stands, the target, whatever hides it or
  looks like it, and noise. The same seed makes the same pictures.
*/

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include <Eigen/Core>
#include <opencv2/imgproc.hpp>
#include <visp3/core/vpImage.h>
#include <visp3/core/vpRGBa.h>
#include <visp3/core/vpRect.h>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! Of a mottled thing: grey values (or those of each colour) with this mean and standard deviation.
struct vpMottle {
  cv::Scalar mean = cv::Scalar::all(60); // red, green, blue
  double sigma = 15;
  double grain = 8; // px
};

struct vpTargetScene {
  using Path = std::function<Eigen::Vector2d(int frame)>; // px, of the middle

  int width = 800, height = 600; // px
  double size = 60;              // px, diameter of the target
  bool square = false;
  vpMottle background;
  vpMottle target = {cv::Scalar::all(190), 10, 6};
  Path path;
  Path other; // of a second target that looks the same; none if empty
  std::function<std::vector<cv::Rect>(int)> obstacles; // of each frame, before the target; none if empty
  vpMottle obstacle = {cv::Scalar::all(90), 10, 10};
  double stripePeriod = 0; // lines; 0: no stripes
  double stripeDuty = 0.5;
  double scalePerFrame = 1; // of its size
  double noise = 3;         // grey levels
  unsigned int seed = 1;

  explicit vpTargetScene(unsigned int theSeed = 1) : seed(theSeed)
  {
    path = [](int frame) { return Eigen::Vector2d(150 + 5 * frame, 300); };
  }

  double sizeAt(int frame) const { return size * std::pow(scalePerFrame, frame); }

  //! Tight around the target.
  vpRect window(int frame) const
  {
    vpRect rect(0, 0, sizeAt(frame), sizeAt(frame));
    const Eigen::Vector2d middle = path(frame);
    rect.moveCenter(middle.x(), middle.y());
    return rect;
  }

  //! Rounded to pixels, and clipped to the picture, as a user gives it.
  vpRect firstWindow() const
  {
    const vpRect exact = window(0);
    const double left = std::max(0.0, std::round(exact.getLeft()));
    const double top = std::max(0.0, std::round(exact.getTop()));
    return vpRect(left, top, std::min(std::round(exact.getWidth()), width - left),
                  std::min(std::round(exact.getHeight()), height - top));
  }

  //! Red, green, blue.
  cv::Mat_<cv::Vec3b> render(int frame) const
  {
    if (m_background.empty()) {
      m_background = mottled(background, cv::Size(width, height), seed);
      m_target = mottled(target, cv::Size(cvCeil(3 * size), cvCeil(3 * size)), seed + 1000);
      m_obstacle = mottled(obstacle, cv::Size(width, height), seed + 2000);
      m_noise.resize(1 << 16);
      std::mt19937 generator(seed + 3000);
      std::normal_distribution<double> normal;
      for (double &value : m_noise)
        value = normal(generator);
    }
    cv::Mat_<cv::Vec3f> picture = m_background.clone();
    std::mt19937 generator(seed * 7919 + frame);
    const double phase = std::uniform_real_distribution<double>()(generator);
    if (other)
      paint(picture, other(frame), sizeAt(frame), phase);
    paint(picture, path(frame), sizeAt(frame), phase);
    if (obstacles)
      for (const cv::Rect &rect : obstacles(frame)) {
        const cv::Rect part = rect & cv::Rect(0, 0, width, height);
        if (!part.empty())
          m_obstacle(part).copyTo(picture(part));
      }
    return noisy(picture, generator);
  }

  vpImage<unsigned char> grey(int frame) const
  {
    const cv::Mat_<cv::Vec3b> picture = render(frame);
    vpImage<unsigned char> I(picture.rows, picture.cols);
    for (int y = 0; y < picture.rows; ++y)
      for (int x = 0; x < picture.cols; ++x)
        I[y][x] = picture(y, x)[0];
    return I;
  }

  vpImage<vpRGBa> colour(int frame) const
  {
    const cv::Mat_<cv::Vec3b> picture = render(frame);
    vpImage<vpRGBa> I(picture.rows, picture.cols);
    for (int y = 0; y < picture.rows; ++y)
      for (int x = 0; x < picture.cols; ++x)
        I[y][x] = vpRGBa(picture(y, x)[0], picture(y, x)[1], picture(y, x)[2]);
    return I;
  }

  //! The same shade in all channels: white noise, low-passed to the grain and brought back to its sigma.
  static cv::Mat_<cv::Vec3f> mottled(const vpMottle &mottle, cv::Size size, unsigned int seed)
  {
    cv::Mat_<float> shade(size);
    std::mt19937 generator(seed);
    std::normal_distribution<float> normal;
    for (float &value : shade)
      value = normal(generator);
    cv::GaussianBlur(shade, shade, cv::Size(), mottle.grain / 2);
    cv::Scalar mean, sigma;
    cv::meanStdDev(shade, mean, sigma);
    shade = (shade - mean[0]) * (mottle.sigma / std::max(sigma[0], 1e-9));
    cv::Mat_<cv::Vec3f> all;
    cv::merge(std::vector<cv::Mat>{shade, shade, shade}, all);
    return cv::Mat_<cv::Vec3f>(all + mottle.mean);
  }

private:
  void paint(cv::Mat_<cv::Vec3f> &picture, const Eigen::Vector2d &middle, double diameter, double phase) const
  {
    const double radius = diameter / 2, scale = size / diameter;
    const cv::Point2d inTexture(m_target.cols / 2, m_target.rows / 2);
    const cv::Rect box = cv::Rect(cvFloor(middle.x() - radius) - 1, cvFloor(middle.y() - radius) - 1,
                                  cvCeil(diameter) + 3, cvCeil(diameter) + 3) &
                         cv::Rect(0, 0, width, height);
    for (int y = box.y; y < box.y + box.height; ++y) {
      double lit = 1;
      if (stripePeriod > 0) {
        // Exposure of one line: the overlap of its span with the lit ones.
        auto light = [this](double t) {
          return std::floor(t) * stripeDuty + std::min(t - std::floor(t), stripeDuty);
        };
        const double t = y / stripePeriod + phase;
        lit = (light(t + 1 / stripePeriod) - light(t)) * stripePeriod;
      }
      for (int x = box.x; x < box.x + box.width; ++x) {
        const double du = x - middle.x(), dv = y - middle.y();
        const double off = square ? std::max(std::abs(du), std::abs(dv)) : std::hypot(du, dv);
        const float share = static_cast<float>(std::clamp(radius - off + 0.5, 0.0, 1.0) * lit);
        const cv::Vec3f shade = bilinear(inTexture.x + du * scale, inTexture.y + dv * scale);
        picture(y, x) = picture(y, x) * (1 - share) + shade * share;
      }
    }
  }

  cv::Vec3f bilinear(double x, double y) const
  {
    const int u = cvFloor(x), v = cvFloor(y);
    const float a = static_cast<float>(x - u), b = static_cast<float>(y - v);
    return (m_target(v, u) * (1 - a) + m_target(v, u + 1) * a) * (1 - b) +
           (m_target(v + 1, u) * (1 - a) + m_target(v + 1, u + 1) * a) * b;
  }

  cv::Mat_<cv::Vec3b> noisy(const cv::Mat_<cv::Vec3f> &picture, std::mt19937 &generator) const
  {
    cv::Mat_<cv::Vec3b> result(picture.size());
    for (int y = 0; y < picture.rows; ++y) {
      size_t at = generator();
      for (int x = 0; x < picture.cols; ++x) {
        const float more = static_cast<float>(noise * m_noise[++at % m_noise.size()]);
        for (int channel = 0; channel < 3; ++channel)
          result(y, x)[channel] = cv::saturate_cast<unsigned char>(picture(y, x)[channel] + more);
      }
    }
    return result;
  }

  mutable cv::Mat_<cv::Vec3f> m_background, m_target, m_obstacle;
  mutable std::vector<double> m_noise;
};

END_VISP_NAMESPACE

#endif
