/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPlainRenderer_h
#define vpPlainRenderer_h

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <visp3/core/vpImage.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

/*!
  A second renderer, which shares no code with modules/vlp_simulation: a level camera of 2048x1536 pixels
  looks up at discs, and every 2.56th pixel of its picture is kept (nearest neighbour). Of each pixel 8 x 8
  points are looked at, and a line's light is the integral over its exposure of a pulse train. Noise is of
  photons and of the readout.
*/
struct vpPlainRenderer {
  struct Disc {
    double x, y, z;         // m, in the map
    double frequency, duty; // Hz, lit share
    double phase;           // periods since a pulse began, at time 0
  };

  static constexpr int width = 800, height = 600, sensorWidth = 2048, sensorHeight = 1536;
  double focal = 1250, u0 = 1023.5, v0 = 767.5; // px of the sensor
  double cameraHeight = 0.19, diameter = 0.175; // m
  double rowTime = 43.1e-6, exposure = 43.1e-6; // s
  bool columns = false;                         // the sensor reads out column by column
  double lit = 150, ceiling = 8;                // grey levels
  double electrons = 40, readNoise = 1;         // electrons of a grey level; grey levels

  //! A disc's middle and radius, px of the sensor. The camera's x axis points backwards, its y axis
  //! rightwards turned about the vertical: as the rig's mount, turned by 180 degrees.
  struct Spot {
    double u, v, radius;
  };
  Spot spotOf(const Disc &disc, double x, double y, double yaw) const
  {
    const double dx = disc.x - x, dy = disc.y - y, up = disc.z - cameraHeight;
    const double ahead = std::cos(yaw) * dx + std::sin(yaw) * dy,
                 left = std::cos(yaw) * dy - std::sin(yaw) * dx;
    return {u0 - focal * ahead / up, v0 - focal * left / up, 0.5 * focal * diameter / up};
  }

  //! Share of a spot's area within the picture.
  static double shareInside(const Spot &spot)
  {
    static const int points = 100;
    int inside = 0, all = 0;
    for (int i = 0; i < points; ++i)
      for (int j = 0; j < points; ++j) {
        const double a = (2 * i + 1.0) / points - 1, b = (2 * j + 1.0) / points - 1;
        if (a * a + b * b < 1) {
          const double u = spot.u + a * spot.radius, v = spot.v + b * spot.radius;
          ++all;
          inside += u > -0.5 && u < sensorWidth - 0.5 && v > -0.5 && v < sensorHeight - 0.5;
        }
      }
    return static_cast<double>(inside) / all;
  }

  void render(const std::vector<Disc> &discs, double x, double y, double yaw, std::mt19937_64 &generator,
              vpImage<unsigned char> &picture) const
  {
    std::vector<Spot> spots;
    for (const Disc &disc : discs) {
      spots.push_back(spotOf(disc, x, y, yaw));
    }
    std::normal_distribution<double> normal;
    picture.resize(height, width);
    for (int row = 0; row < height; ++row) {
      const int v = row * sensorHeight / height;
      for (int column = 0; column < width; ++column) {
        const int u = column * sensorWidth / width;
        double grey = ceiling;
        for (size_t i = 0; i < discs.size(); ++i) {
          const double covered = shareCovered(spots[i], u, v);
          if (covered > 0) {
            grey += lit * covered * litShare(discs[i], (columns ? u : v) * rowTime);
          }
        }
        const double noise = std::sqrt(grey / electrons + readNoise * readNoise);
        picture[row][column] =
            static_cast<unsigned char>(std::clamp(std::round(grey + noise * normal(generator)), 0.0, 255.0));
      }
    }
  }

private:
  //! Share of a pixel that a spot covers.
  static double shareCovered(const Spot &spot, int u, int v)
  {
    const double away = std::hypot(u - spot.u, v - spot.v);
    if (away > spot.radius + 1) {
      return 0;
    }
    if (away < spot.radius - 1) {
      return 1;
    }
    static const int points = 8;
    int inside = 0;
    for (int i = 0; i < points; ++i)
      for (int j = 0; j < points; ++j) {
        const double du = u - 0.5 + (i + 0.5) / points - spot.u, dv = v - 0.5 + (j + 0.5) / points - spot.v;
        inside += du * du + dv * dv < spot.radius * spot.radius;
      }
    return static_cast<double>(inside) / (points * points);
  }

  //! Share of the exposure from \e start on during which a disc is lit: pulse by pulse.
  double litShare(const Disc &disc, double start) const
  {
    const double from = disc.frequency * start + disc.phase, to = from + disc.frequency * exposure;
    double sum = 0;
    for (double pulse = std::floor(from); pulse < to; ++pulse) {
      sum += std::max(0.0, std::min(to, pulse + disc.duty) - std::max(from, pulse));
    }
    return sum / (to - from);
  }
};

#endif
