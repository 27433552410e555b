/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef slowRollingShutter_h
#define slowRollingShutter_h

/*!
  \file slowRollingShutter.h
  What a rolling-shutter camera sees, by brute force and without any formula of the library: time in steps of
  0.1 us, areas by 16 x 16 points a pixel, the blur as a sum over those points.
*/

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <visp3/vlp_simulation/vpRollingShutterRenderer.h>

struct SlowRollingShutter {
  vpSimulatedCamera camera;
  vpSimulatedScene scene;
  vpRollingShutterRenderer::Poses wMc;
  double frameTime = 0;      // s
  bool moving = false;       // the pose changes during an exposure
  std::vector<double> phase; // periods, of each lamp at time 0

  static constexpr int cells = 16;         // of a pixel, along each side
  static constexpr double step = 1e-7;     // s
  static constexpr double together = 5e-6; // s, that a moving lamp is drawn in one place for

  //! Whether a lamp shines at a time, straight from the words of vpModulation.
  static bool lit(const vpModulation &modulation, double phase, double t)
  {
    if (modulation.kind == vpModulation::Kind::unmodulated)
      return true;
    const std::string chips = modulation.chips();
    const double rate = chips.empty() ? modulation.frequency : modulation.chipRate / double(chips.size());
    double x = std::fmod(t * rate + phase, 1.0);
    x += x < 0 ? 1 : 0;
    const double duty = modulation.duty.value_or(0.5), k = modulation.phaseDifference;
    if (modulation.kind == vpModulation::Kind::word)
      return chips[std::min(chips.size() - 1, size_t(x * double(chips.size())))] == '1';
    if (modulation.kind == vpModulation::Kind::pwm)
      return x < duty;
    return x < duty / 2 || (x >= k && x < k + duty / 2);
  }

  //! Normalised coordinates of a point of the sensor, the distortion undone by bisection.
  Eigen::Vector2d ray(double u, double v) const
  {
    const vpCameraParameters &c = camera.rig.camera;
    const Eigen::Vector2d bent((u - c.get_u0()) / c.get_px(), (v - c.get_v0()) / c.get_py());
    if (c.get_projModel() == vpCameraParameters::perspectiveProjWithoutDistortion || bent.norm() == 0)
      return bent;
    double low = 0, high = 2 * bent.norm();
    for (int i = 0; i < 60; ++i) {
      const double r = 0.5 * (low + high);
      (r * (1 + c.get_kud() * r * r) < bent.norm() ? low : high) = r;
    }
    return bent * (low / bent.norm());
  }

  //! What a point of the sensor sees of a lamp, where the camera stands at time t: place in the lamp's own
  //! axes (m), cosine.
  Eigen::Vector2d inLamp(const vpLamp &lamp, const vpHomogeneousMatrix &M, const Eigen::Vector2d &ray,
                         double &cosine) const
  {
    Eigen::Vector3d d, from;
    for (int i = 0; i < 3; ++i) {
      d(i) = M[i][0] * ray.x() + M[i][1] * ray.y() + M[i][2];
      from(i) = M[i][3];
    }
    const Eigen::Vector3d hit = from + d * ((lamp.position.z() - from.z()) / d.z()) - lamp.position;
    cosine = d.z() / d.norm();
    const double c = std::cos(lamp.yaw), s = std::sin(lamp.yaw);
    return {c * hit.x() + s * hit.y(), -s * hit.x() + c * hit.y()};
  }

  double brightness(const vpSimulatedLamp &lamp, const vpHomogeneousMatrix &M,
                    const Eigen::Vector2d &ray) const
  {
    double cosine;
    const Eigen::Vector2d at = inLamp(lamp.lamp, M, ray, cosine);
    const double half = 0.5 * lamp.lamp.size;
    const bool disc = lamp.lamp.shape == vpLamp::Shape::disk;
    if (disc ? at.norm() > half : at.cwiseAbs().maxCoeff() > half)
      return 0;
    const double order = -std::log(2) / std::log(std::cos(lamp.halfPower));
    const double rim = lamp.emission.even() && disc ? 1 - lamp.rim * at.squaredNorm() / (half * half) : 1;
    return lamp.level * rim * lamp.emission.at(at / half) * std::pow(cosine, order - 1);
  }

  //! Weight of each cell about a pixel: its own square, blurred. The first cell lies \e margin pixels before
  //! it.
  std::vector<double> weights(int margin) const
  {
    std::vector<double> weight(size_t((2 * margin + 1) * cells), 0.0);
    for (int k = 0; k < int(weight.size()); ++k)
      for (int own = margin * cells; own < (margin + 1) * cells; ++own) {
        const double d = double(k - own) / cells;
        weight[size_t(k)] +=
            camera.blur > 0 ? std::exp(-0.5 * d * d / (camera.blur * camera.blur)) : (k == own);
      }
    double sum = 0;
    for (double w : weight)
      sum += w;
    for (double &w : weight)
      w /= sum;
    return weight;
  }

  //! Brightness of each cell from sensor point (u, v) on: that of its middle, of 8 x 8 points where its
  //! corners differ.
  cv::Mat_<double> fineLight(const vpSimulatedLamp &lamp, const vpHomogeneousMatrix &M, double u, double v,
                             int rows, int columns) const
  {
    auto at = [&](double x, double y) { return brightness(lamp, M, ray(u + x / cells, v + y / cells)); };
    cv::Mat_<double> corner(rows + 1, columns + 1), fine(rows, columns);
    for (int y = 0; y <= rows; ++y)
      for (int x = 0; x <= columns; ++x)
        corner(y, x) = at(x, y);
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < columns; ++x) {
        const int in =
            (corner(y, x) > 0) + (corner(y, x + 1) > 0) + (corner(y + 1, x) > 0) + (corner(y + 1, x + 1) > 0);
        fine(y, x) = 0;
        for (int k = 0; k < 64 && in > 0 && in < 4; ++k)
          fine(y, x) += at(x + (k % 8 + 0.5) / 8, y + (k / 8 + 0.5) / 8) / 64;
        if (in == 4)
          fine(y, x) = at(x + 0.5, y + 0.5);
      }
    return fine;
  }

  //! A lamp's light on the pixels of rows \e first to \e last, the camera standing still.
  cv::Mat_<double> still(const vpSimulatedLamp &lamp, const vpHomogeneousMatrix &M, int first, int last) const
  {
    const int width = int(camera.rig.width), margin = int(std::ceil(5 * camera.blur));
    const std::vector<double> weight = weights(margin);
    const cv::Mat_<double> fine =
        fineLight(lamp, M, -margin - 0.5, first - margin - 0.5, (last - first + 1 + 2 * margin) * cells,
                  (width + 2 * margin) * cells);
    cv::Mat_<double> light(last - first + 1, width, 0.0);
    for (int v = 0; v < light.rows; ++v) {
      std::vector<double> column(size_t(fine.cols), 0.0);
      for (size_t k = 0; k < weight.size(); ++k)
        for (int x = 0; x < fine.cols; ++x)
          column[size_t(x)] += weight[k] * fine(v * cells + int(k), x);
      for (int u = 0; u < width; ++u)
        for (size_t k = 0; k < weight.size(); ++k)
          light(v, u) += weight[k] * column[size_t(u * cells) + k];
    }
    return light;
  }

  //! Start of the exposure of a row or column, s.
  double start(int line) const
  {
    const vpRollingShutter &shutter = camera.rig.shutter;
    const int lines = int(shutter.alongColumns() ? camera.rig.width : camera.rig.height);
    return frameTime + shutter.rowTime * (shutter.reversed() ? lines - 1 - line : line);
  }

  //! Share of the exposure from \e t on during which lamp \e k shines.
  double litShare(size_t k, double t, double exposure) const
  {
    const auto steps = long(std::lround(exposure / step));
    long count = 0;
    for (long i = 0; i < steps; ++i)
      count += lit(scene.lamps[k].lamp.modulation, phase[k], t + (i + 0.5) * exposure / double(steps));
    return double(count) / double(steps);
  }

  //! Points of the sensor, four a pixel, that see a lamp; those beside the picture, too. The third number is
  //! the brightness of its emission pattern there.
  std::vector<Eigen::Vector3d> pointsOf(const vpSimulatedLamp &lamp, const vpHomogeneousMatrix &M) const
  {
    static const double beside = 100; // px
    double cosine;
    std::vector<Eigen::Vector3d> points;
    for (double y = -beside; y < camera.rig.height + beside; y += 0.5)
      for (double x = -beside; x < camera.rig.width + beside; x += 0.5)
        if (brightness(lamp, M, ray(x, y)) > 0)
          points.emplace_back(
              x, y, lamp.emission.at(inLamp(lamp.lamp, M, ray(x, y), cosine) / (0.5 * lamp.lamp.size)));
    return points;
  }

  //! Halo of the lens and glow of the ceiling on each pixel, the camera standing still.
  cv::Mat_<double> scattered(const vpSimulatedLamp &lamp, const vpHomogeneousMatrix &M) const
  {
    cv::Mat_<double> light(int(camera.rig.height), int(camera.rig.width), 0.0);
    if (camera.haloShare <= 0 && scene.ceilingShare <= 0)
      return light;
    const std::vector<Eigen::Vector3d> points = pointsOf(lamp, M);
    const double sigma = camera.haloRadius;
    for (int v = 0; v < light.rows; ++v)
      for (int u = 0; u < light.cols; ++u) {
        double sum = 0, cosine;
        for (const Eigen::Vector3d &point : points) {
          const double square = (point.head<2>() - Eigen::Vector2d(u, v)).squaredNorm();
          sum += 0.25 * point.z() * std::exp(-0.5 * square / (sigma * sigma));
        }
        sum *= camera.haloShare / (2 * M_PI * sigma * sigma);
        const double d = inLamp(lamp.lamp, M, ray(u, v), cosine).norm() / scene.ceilingRadius;
        light(v, u) = lamp.level * (sum + scene.ceilingShare / std::pow(1 + d * d, 2));
      }
    return light;
  }

  //! Grey values before noise, saturation and rounding, of a picture that is not resized.
  cv::Mat_<double> exact() const
  {
    const int width = int(camera.rig.width), height = int(camera.rig.height);
    const double exposure = camera.rig.shutter.exposure;
    const bool columns = camera.rig.shutter.alongColumns();
    cv::Mat_<double> grey(height, width, scene.ambient);
    for (size_t k = 0; k < scene.lamps.size(); ++k) {
      const vpSimulatedLamp &lamp = scene.lamps[k];
      if (moving) { // read out along rows
        for (int v = 0; v < height; ++v)
          for (double t = 0; t < exposure - step / 2; t += together) {
            const double length = std::min(together, exposure - t);
            const double share = litShare(k, start(v) + t, length) * length / exposure;
            if (share > 0)
              grey.row(v) += share * still(lamp, wMc(start(v) + t + length / 2), v, v);
          }
        continue;
      }
      const vpHomogeneousMatrix M = wMc(frameTime);
      const cv::Mat_<double> light = still(lamp, M, 0, height - 1) + scattered(lamp, M);
      std::vector<double> shares;
      for (int line = 0; line < (columns ? width : height); ++line)
        shares.push_back(litShare(k, start(line), exposure));
      for (int v = 0; v < height; ++v)
        for (int u = 0; u < width; ++u)
          grey(v, u) += light(v, u) * shares[size_t(columns ? u : v)];
    }
    for (int v = 0; v < height; ++v)
      for (int u = 0; u < width; ++u)
        grey(v, u) *= std::pow(1 / std::sqrt(1 + ray(u, v).squaredNorm()), camera.vignetting);
    return grey;
  }
};

#endif
