/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <cmath>
#include <functional>
#include <random>

#include <opencv2/imgproc.hpp>

#include "luminaires/vpEmissionPattern.h"

BEGIN_VISP_NAMESPACE
namespace
{
constexpr int cells = 4;                                 // of a pixel, along each side
constexpr int side = 460;                                // px of a pattern
constexpr double size = 400;                             // px, diameter of a disc, side of a square
using Light = std::function<double(double x, double y)>; // share, at (-1, -1) to (1, 1) of the outline's box
using Random = std::mt19937_64;

double even(double from, double to, Random &generator)
{
  return from + (to - from) * std::uniform_real_distribution<double>(0, 1)(generator);
}

//! A pattern whose pixels are the means of 4 x 4 points; nothing is lit outside the outline.
vpEmissionPattern draw(const std::string &name, bool square, const Light &light)
{
  cv::Mat_<float> fine(side * cells, side * cells, 0.f);
  for (int j = 0; j < fine.rows; ++j) {
    for (int i = 0; i < fine.cols; ++i) {
      const double x = 2 * ((i + 0.5) / cells - 0.5 * side) / size;
      const double y = 2 * ((j + 0.5) / cells - 0.5 * side) / size;
      if (square ? std::max(std::abs(x), std::abs(y)) < 1 : x * x + y * y < 1) {
        fine(j, i) = static_cast<float>(light(x, y));
      }
    }
  }
  vpEmissionPattern pattern;
  pattern.name = name;
  cv::resize(fine, pattern.light, cv::Size(side, side), 0, 0, cv::INTER_AREA);
  double most = 0;
  cv::minMaxLoc(pattern.light, nullptr, &most);
  pattern.light /= static_cast<float>(most);
  pattern.middle = Eigen::Vector2d::Constant(0.5 * (side - 1));
  pattern.square = square;
  const cv::Rect lit = cv::boundingRect(fine > 0);
  pattern.lit = Eigen::Vector2d(lit.width, lit.height) / cells;
  pattern.diameter = square ? size * std::sqrt(4 / M_PI) : size;
  return pattern;
}

double bump(double x, double y, double width)
{
  return std::exp(-0.5 * (x * x + y * y) / (width * width));
}

Light evenDisc(Random &)
{
  return [](double, double) { return 1; };
}

Light hotSpot(Random &generator)
{
  const double r = even(0.2, 0.6, generator), to = even(-M_PI, M_PI, generator);
  const double width = even(0.15, 0.4, generator), rest = even(0.05, 0.4, generator);
  return [=](double x, double y) {
    return rest + (1 - rest) * bump(x - r * std::cos(to), y - r * std::sin(to), width);
  };
}

Light ringOfDies(Random &generator)
{
  const auto dies = static_cast<int>(even(5, 13, generator));
  const double r = even(0.45, 0.75, generator), width = even(0.07, 0.16, generator);
  const double rest = even(0.03, 0.25, generator);
  return [=](double x, double y) {
    double sum = rest;
    for (int k = 0; k < dies; ++k) {
      const double to = 2 * M_PI * k / dies;
      sum += bump(x - r * std::cos(to), y - r * std::sin(to), width);
    }
    return sum;
  };
}

Light gridOfDies(Random &generator)
{
  const auto across = static_cast<int>(even(3, 7, generator));
  const double width = even(0.15, 0.3, generator) * 2 / across, rest = even(0.05, 0.25, generator);
  return [=](double x, double y) {
    auto off = [across](double at) { // from the nearest die
      const double cell = 0.5 * (at + 1) * across;
      return (cell - std::floor(cell) - 0.5) * 2 / across;
    };
    return rest + (1 - rest) * bump(off(x), off(y), width);
  };
}

Light dome(Random &generator)
{
  const double rim = even(0, 0.3, generator), power = even(0.5, 2, generator);
  return [=](double x, double y) {
    return rim + (1 - rim) * std::pow(std::max(0., 1 - x * x - y * y), 0.5 * power);
  };
}

Light edgeLit(Random &generator)
{
  const double depth = even(0.2, 0.6, generator), rest = even(0.2, 0.6, generator);
  const double other = even(0.5, 1, generator); // how bright the second of the lit edges is
  return [=](double x, double) {
    return rest + (1 - rest) * (std::exp((x - 1) / depth) + other * std::exp((-1 - x) / depth));
  };
}

//! Voronoi cells, each of a brightness of its own.
Light cracked(Random &generator)
{
  std::vector<Eigen::Vector3d> patches; // x, y, light
  std::lognormal_distribution<double> brightness(0, 0.8);
  for (auto n = static_cast<int>(even(8, 40, generator)); n > 0; --n) {
    patches.emplace_back(even(-1, 1, generator), even(-1, 1, generator), brightness(generator));
  }
  return [patches](double x, double y) {
    double nearest = 1e9, light = 0;
    for (const Eigen::Vector3d &patch : patches) {
      const double away = std::hypot(patch.x() - x, patch.y() - y);
      if (away < nearest) {
        nearest = away;
        light = patch.z();
      }
    }
    return light;
  };
}

//! A tube with its bright line along the middle; its length is that of the square's side.
Light tube(Random &generator)
{
  const double half = even(0.2, 0.35, generator), power = even(0, 1, generator);
  return [=](double, double y) {
    return std::abs(y) < half ? std::pow(1 - y * y / (half * half), 0.5 * power) : 0;
  };
}

struct Kind {
  const char *name;
  bool square;
  Light (*draw)(Random &generator);
};
const Kind kinds[] = {
    {"even-disc", false, evenDisc},     {"hot-spot", false, hotSpot}, {"ring-of-dies", false, ringOfDies},
    {"grid-of-dies", true, gridOfDies}, {"dome", false, dome},        {"edge-lit-panel", true, edgeLit},
    {"cracked", false, cracked},        {"tube", true, tube}};
} // namespace

std::vector<vpLuminaireFamily> vpDrawnFamilies(int count, uint64_t seed)
{
  std::vector<vpLuminaireFamily> families;
  Random generator(seed);
  for (const Kind &kind : kinds) {
    vpLuminaireFamily family{kind.name, {}};
    for (int i = 0; i < count; ++i) {
      const std::string name = std::string(kind.name) + "-" + std::to_string(i);
      family.patterns.push_back(draw(name, kind.square, kind.draw(generator)));
    }
    families.push_back(family);
  }
  return families;
}

END_VISP_NAMESPACE
