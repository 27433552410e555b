/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_simulation/vpEmission.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

#include "vpNormalNoise.h"

BEGIN_VISP_NAMESPACE

namespace
{
void expect(const char *name, double value, double least, double most)
{
  if (!(value >= least && value <= most)) {
    throw vpException(vpException::badValue, std::string(name) + ": " + vpNumberText(value) +
                                                 ", expected a number from " + vpNumberText(least) + " to " +
                                                 vpNumberText(most));
  }
}

void expectWidthAndRest(double width, double rest)
{
  expect("width", width, vpEmission::narrowest, vpEmission::widest);
  expect("rest", rest, 0, 1);
}

double bump(const Eigen::Vector2d &offset, double width)
{
  return std::exp(-0.5 * offset.squaredNorm() / (width * width));
}
} // namespace

vpEmission vpEmission::hotSpot(const Eigen::Vector2d &place, double width, double rest)
{
  if (!(place.norm() <= 1)) {
    throw vpException(vpException::badValue, "place: " + vpNumberText(place.x()) + ", " +
                                                 vpNumberText(place.y()) +
                                                 ", expected a place within the unit circle");
  }
  expectWidthAndRest(width, rest);
  return vpEmission([=](const Eigen::Vector2d &p) { return rest + (1 - rest) * bump(p - place, width); });
}

vpEmission vpEmission::ringOfDies(unsigned int dies, double radius, double width, double rest)
{
  expect("dies", dies, 1, mostDies);
  expect("radius", radius, 0.05, 0.95);
  expectWidthAndRest(width, rest);
  std::vector<Eigen::Vector2d> places;
  for (unsigned int k = 0; k < dies; ++k) {
    const double angle = 2 * M_PI * k / dies;
    places.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  const auto sum = [places, width](const Eigen::Vector2d &p) {
    double light = 0;
    for (const Eigen::Vector2d &place : places) {
      light += bump(p - place, width);
    }
    return light;
  };
  // On each circle about the middle, the sum is brightest in the direction of a die: its Fourier coefficients
  // over the angle are modified Bessel functions, all of them positive. Steps of a tenth of the narrowest
  // width are 0.1 % off at most.
  double most = 0;
  static const double step = 0.1 * narrowest;
  for (double r = 0; r <= 1; r += step) {
    most = std::max(most, sum({r, 0}));
  }
  most = std::max(most, sum({radius, 0})); // exact where the dies stand apart
  return vpEmission(
      [=](const Eigen::Vector2d &p) { return std::min(1.0, rest + (1 - rest) * sum(p) / most); });
}

vpEmission vpEmission::gridOfDies(unsigned int across, double width, double rest)
{
  expect("across", across, 1, mostAcross);
  expectWidthAndRest(width, rest);
  const auto fromNearest = [across](double at) {
    const double cell = 0.5 * (at + 1) * across;
    return (cell - std::floor(cell) - 0.5) * 2 / across;
  };
  return vpEmission([=](const Eigen::Vector2d &p) {
    return rest + (1 - rest) * bump({fromNearest(p.x()), fromNearest(p.y())}, width);
  });
}

vpEmission vpEmission::dome(double rim, double power)
{
  expect("rim", rim, 0, 1);
  expect("power", power, 0, 10);
  return vpEmission([=](const Eigen::Vector2d &p) {
    return rim + (1 - rim) * std::pow(std::max(0.0, 1 - p.squaredNorm()), 0.5 * power);
  });
}

vpEmission vpEmission::edgeLit(double depth, double rest, double other)
{
  expect("depth", depth, narrowest, widest);
  expect("rest", rest, 0, 1);
  expect("other", other, 0, 1);
  const auto sum = [=](double x) { return std::exp((x - 1) / depth) + other * std::exp((-1 - x) / depth); };
  const double most = sum(1); // the sum is convex and the edge x = 1 no darker than the other
  return vpEmission(
      [=](const Eigen::Vector2d &p) { return rest + (1 - rest) * sum(std::clamp(p.x(), -1.0, 1.0)) / most; });
}

vpEmission vpEmission::cracked(unsigned int patches, double spread, std::uint64_t seed)
{
  expect("patches", patches, 1, mostPatches);
  expect("spread", spread, 0, 3);
  vpNormalNoise random(seed, 0);
  std::vector<std::pair<Eigen::Vector2d, double>> cells;
  double most = 0;
  for (unsigned int k = 0; k < patches; ++k) {
    // Within the unit circle, so that the brightest is part of the lamp whatever its shape.
    const double angle = 2 * M_PI * random.uniform(), r = std::sqrt(random.uniform());
    cells.emplace_back(Eigen::Vector2d(r * std::cos(angle), r * std::sin(angle)),
                       std::exp(spread * random()));
    most = std::max(most, cells.back().second);
  }
  return vpEmission([cells, most](const Eigen::Vector2d &p) {
    double nearest = 1e9, light = 0;
    for (const auto &[place, brightness] : cells) {
      const double away = (place - p).squaredNorm();
      if (away < nearest) {
        nearest = away;
        light = brightness;
      }
    }
    return light / most;
  });
}

vpEmission vpEmission::tube(double width)
{
  expect("width", width, 0.01, 1);
  vpEmission strip;
  strip.m_strip = width;
  return strip;
}

vpEmission vpEmission::mirrored() const
{
  vpEmission image = *this;
  if (m_pattern) {
    image.m_pattern = [pattern = m_pattern](const Eigen::Vector2d &p) { return pattern({p.x(), -p.y()}); };
  }
  return image;
}

END_VISP_NAMESPACE
