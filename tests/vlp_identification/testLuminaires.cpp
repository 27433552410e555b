/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Luminaires of any emission pattern: what their columns agree on, and which light is one lamp.

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>
#include <visp3/vlp_identification/vpLedDetector.h>

#include "common/vpPwmLamps.h"
#include "common/vpUpwardRig.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
const int columns = 420, lines = 320;  // px
const double luminaireRowTime = 40e-6; // s

using Pattern = std::function<double(double u, double v)>; // grey levels, px from the lamp's middle

struct Luminaire {
  Eigen::Vector2d middle;
  Pattern light;
  double frequency, duty, phase;
};

//! Share of a line's exposure, of one row time, in which a pulse of each period is lit.
double litShare(const Luminaire &lamp, int line)
{
  static const int moments = 64;
  int lit = 0;
  for (int k = 0; k < moments; ++k) {
    const double turns = lamp.frequency * luminaireRowTime * (line + (k + 0.5) / moments) + lamp.phase;
    lit += turns - std::floor(turns) < lamp.duty ? 1 : 0;
  }
  return static_cast<double>(lit) / moments;
}

vpImage<unsigned char> pictureOf(const std::vector<Luminaire> &lamps, double noise = 1)
{
  cv::Mat_<double> grey(lines, columns, 6.0);
  for (const Luminaire &lamp : lamps) {
    cv::Mat_<double> light(lines, columns, 0.0);
    static const int cells = 4; // of a pixel, along each side
    for (int v = 0; v < lines; ++v) {
      for (int u = 0; u < columns; ++u) {
        for (int cell = 0; cell < cells * cells; ++cell) {
          const double du = (cell % cells + 0.5) / cells - 0.5, dv = (cell / cells + 0.5) / cells - 0.5;
          light(v, u) += lamp.light(u + du - lamp.middle.x(), v + dv - lamp.middle.y()) / (cells * cells);
        }
      }
    }
    cv::GaussianBlur(light, light, cv::Size(0, 0), 0.8);
    for (int v = 0; v < lines; ++v) {
      grey.row(v) += litShare(lamp, v) * light.row(v);
    }
  }
  std::mt19937 generator(5);
  std::normal_distribution<double> normal(0, noise);
  vpImage<unsigned char> I(lines, columns);
  for (int v = 0; v < lines; ++v) {
    for (int u = 0; u < columns; ++u) {
      I[v][u] = cv::saturate_cast<unsigned char>(grey(v, u) + normal(generator));
    }
  }
  return I;
}

vpLampMap luminaireMap()
{
  return vpPwmLamps({450, 1500, 2000, 2600});
}

std::vector<vpLampObservation> seenIn(const std::vector<Luminaire> &lamps)
{
  vpLedDetector detector(vpUpwardRig(columns, lines), luminaireMap());
  detector.detect(pictureOf(lamps));
  return detector.observations();
}

//! Squares of unlike brightness, one in four of them dark.
Pattern cracked(double radius, unsigned int seed)
{
  return [radius, seed](double u, double v) {
    const auto column = static_cast<unsigned int>(100 + std::floor(u / 9)),
               row = static_cast<unsigned int>(100 + std::floor(v / 7));
    const unsigned int draw =
        (seed * 2654435761u ^ column * 2246822519u ^ row * 3266489917u) * 374761393u >> 29;
    return std::hypot(u, v) > radius ? 0.0 : draw < 2 ? 8.0 : 20.0 * draw;
  };
}

Pattern hotSpot(double radius, double aside, double rest)
{
  return [=](double u, double v) {
    const double away = std::hypot(u - aside, v) / (0.25 * radius);
    return std::hypot(u, v) > radius ? 0 : 150 * (rest + (1 - rest) * std::exp(-0.5 * away * away));
  };
}

//! Its middle is twice as bright as white, its rim is not.
double twiceWhite(double u, double v)
{
  const double out = std::hypot(u, v) / 70;
  return out > 1 ? 0.0 : 510 * (1 - 0.7 * out * out);
}

double inSigmas(const vpLampObservation &seen, const Eigen::Vector2d &middle)
{
  const Eigen::Vector2d off = seen.point - middle;
  return std::sqrt(off.dot(seen.covariance.inverse() * off));
}
} // namespace

TEST(Luminaires, PatchesDoNotHideTheStripes)
{
  for (const double duty : {0.3, 0.6})
    for (unsigned int seed = 1; seed <= 5; ++seed) {
      const Luminaire lamp{{210.3, 160.2}, cracked(70, seed), 2000, duty, 0.2 * seed};
      const std::vector<vpLampObservation> seen = seenIn({lamp});
      ASSERT_EQ(seen.size(), 1u) << "seed " << seed;
      const vpStripeFeatures &features = seen[0].features;
      EXPECT_EQ(seen[0].id, "L2000") << seen[0].remark << ", seed " << seed;
      EXPECT_NEAR(features.frequency, 2000, 6 * features.frequencySigma + 2) << "seed " << seed;
      EXPECT_NEAR(features.duty, duty, 0.03) << "seed " << seed;
      EXPECT_LT(inSigmas(seen[0], lamp.middle), 4) << "seed " << seed;
    }
}

// The middle of a lamp is clipped at half its light, edges of stripes included; its rim is not.
TEST(Luminaires, ClippingMovesNoEdgeOfAStripe)
{
  double squares = 0, mostDuty = 0;
  static const int phases = 20;
  for (int k = 0; k < phases; ++k) {
    const Luminaire lamp{{209.7, 160.4}, twiceWhite, 520, 0.4, static_cast<double>(k) / phases};
    const std::vector<vpLampObservation> seen = seenIn({lamp});
    ASSERT_EQ(seen.size(), 1u) << "phase " << lamp.phase;
    squares += std::pow(seen[0].features.frequency - lamp.frequency, 2);
    mostDuty = std::max(mostDuty, std::abs(seen[0].features.duty - lamp.duty));
  }
  EXPECT_LT(std::sqrt(squares / phases), 0.04); // Hz; the dimmest tenth alone is off by 0.05, all by 0.5
  EXPECT_LT(mostDuty, 0.0004);
}

// Where white clips the light, the edge of a brighter side seems to lie farther out. Lines that are dim
// enough show how uneven the light is.
TEST(Luminaires, ClippingDoesNotHideThatLightIsUneven)
{
  const auto sigmaOf = [](double slope, double phase) { // of the middle, px
    const Pattern slanted = [slope](double u, double v) {
      return std::hypot(u, v) > 60 ? 0.0 : 255 * (1.5 + slope * (0.7 * u + 0.3 * v) / 60);
    };
    const std::vector<vpLampObservation> seen = seenIn({{{209.6, 160.7}, slanted, 2000, 0.5, phase}});
    return seen.size() == 1 && seen[0].id == "L2000" ? std::sqrt(seen[0].covariance.trace()) : NAN;
  };
  for (int k = 0; k < 5; ++k) {
    EXPECT_GT(sigmaOf(1, 0.2 * k), 3 * sigmaOf(0, 0.2 * k)) << k;
  }
}

// Hardly a line tells how even the light is; what an edge may be off by is a lens's blur at most.
TEST(Luminaires, GlareLeavesAMiddleOfSomeSigma)
{
  const Pattern glaring = [](double u, double v) { return std::hypot(u, v) > 60 ? 0.0 : 20 * 255.0; };
  for (int k = 0; k < 5; ++k) {
    const std::vector<vpLampObservation> seen = seenIn({{{209.6, 160.7}, glaring, 2000, 0.5, 0.2 * k}});
    ASSERT_EQ(seen.size(), 1u) << k;
    const double sigma = std::sqrt(seen[0].covariance.trace());
    EXPECT_GT(sigma, 0.004) << k; // px
    EXPECT_LT(sigma, 2) << k;
  }
}

// A lamp that was seen before is looked at in another way, and is as uneven as it was.
TEST(Luminaires, UnevenLightIsAsUncertainInTheNextFrame)
{
  const Pattern slanted = [](double u, double v) {
    return std::hypot(u, v) > 60 ? 0.0 : 255 * (1.5 + (0.7 * u + 0.3 * v) / 60);
  };
  for (const Pattern &pattern : {Pattern(slanted), hotSpot(60, 20, 0.6)}) {
    vpLedDetector detector(vpUpwardRig(columns, lines), luminaireMap());
    const vpImage<unsigned char> I = pictureOf({{{209.6, 160.7}, pattern, 2000, 0.5, 0.3}});
    detector.detect(I);
    ASSERT_EQ(detector.observations().size(), 1u);
    const vpLampObservation before = detector.observations().front();
    vpLampObservation now = before;
    ASSERT_TRUE(detector.reacquire(I, now));
    EXPECT_NEAR(std::sqrt(now.covariance.trace() / before.covariance.trace()), 1, 0.2);
  }
}

// Short gaps leave no line dark: what the lamp has on its darkest lines is its own light, too.
TEST(Luminaires, ALampThatIsNeverDarkIsWhole)
{
  for (int k = 0; k < 10; ++k) {
    const Luminaire lamp{{209.7, 160.4}, twiceWhite, 9500, 0.8, 0.1 * k};
    const std::vector<vpLampObservation> seen = seenIn({lamp});
    ASSERT_EQ(seen.size(), 1u) << "phase " << lamp.phase;
    EXPECT_NEAR(seen[0].features.frequency, lamp.frequency, 5) << "phase " << lamp.phase;
    EXPECT_NEAR(seen[0].outline.diameter(), 140, 5) << "phase " << lamp.phase;
    EXPECT_LT((seen[0].point - lamp.middle).norm(), 0.3) << "phase " << lamp.phase;
  }
}

TEST(Luminaires, HotSpotHasTheOutlineOfItsRim)
{
  for (const double aside : {0.0, 15.0, 30.0})
    for (const double rest : {0.06, 0.2, 0.5}) {
      const Luminaire lamp{{209.6, 160.7}, hotSpot(60, aside, rest), 2000, 0.5, 0.4};
      const std::vector<vpLampObservation> seen = seenIn({lamp});
      ASSERT_EQ(seen.size(), 1u);
      EXPECT_EQ(seen[0].id, "L2000") << seen[0].remark;
      EXPECT_NEAR(seen[0].outline.diameter(), 120, 6) << "aside " << aside << ", rest " << rest;
      EXPECT_LT(inSigmas(seen[0], lamp.middle), 4) << "aside " << aside << ", rest " << rest;
    }
}

TEST(Luminaires, WhatADarkBarDividesIsOneLamp)
{
  const Pattern disc = hotSpot(60, 0, 0.9);
  for (const double angle : {0.0, 0.6, 1.2}) {
    const Pattern divided = [disc, angle](double u, double v) {
      return std::abs(u * std::cos(angle) + v * std::sin(angle)) < 5 ? 0 : disc(u, v);
    };
    const Luminaire lamp{{210, 160.4}, divided, 2000, 0.5, 0.1};
    const std::vector<vpLampObservation> seen = seenIn({lamp});
    const auto named = std::count_if(seen.begin(), seen.end(),
                                     [](const vpLampObservation &one) { return one.id == "L2000"; });
    EXPECT_EQ(named, 1) << "angle " << angle;
    for (const vpLampObservation &one : seen)
      if (!one.id.empty()) {
        EXPECT_LT(inSigmas(one, lamp.middle), 4) << "angle " << angle;
      }
  }
}

TEST(Luminaires, NeighbourThatBlinksOtherwiseIsNoPart)
{
  for (unsigned int seed = 1; seed <= 3; ++seed) {
    const Luminaire one{{120, 160}, cracked(60, seed), 1500, 0.5, 0.1},
        other{{260, 160}, cracked(60, seed + 10), 2600, 0.4, 0.7};
    std::vector<std::string> ids;
    for (const vpLampObservation &seen : seenIn({one, other}))
      if (!seen.id.empty()) {
        ids.push_back(seen.id);
        const Eigen::Vector2d &middle = seen.id == "L1500" ? one.middle : other.middle;
        EXPECT_LT((seen.point - middle).norm(), 6) << seen.id << ", seed " << seed;
      }
    std::sort(ids.begin(), ids.end());
    EXPECT_EQ(ids, (std::vector<std::string>{"L1500", "L2600"})) << "seed " << seed;
  }
}

TEST(Luminaires, GlowWithoutAnEdgeIsAsUncertainAsItIsSoft)
{
  const Pattern glow = [](double u, double v) { return 180 * std::exp(-0.5 * (u * u + v * v) / (25 * 25)); };
  const std::vector<vpLampObservation> seen = seenIn({{{210.4, 160.3}, glow, 2000, 0.5, 0.3}});
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_EQ(seen[0].id, "L2000") << seen[0].remark;
  EXPECT_GT(std::sqrt(seen[0].covariance(0, 0)), 0.02 * 25);
  EXPECT_LT(inSigmas(seen[0], {210.4, 160.3}), 4);
}

TEST(Luminaires, PhaseIsThatOfTheLampAtTheStartOfTheFrame)
{
  for (const double phase : {0.05, 0.4, 0.85}) {
    const Luminaire lamp{{210, 160}, hotSpot(60, 0, 1), 2000, 0.5, phase};
    const std::vector<vpLampObservation> seen = seenIn({lamp});
    ASSERT_EQ(seen.size(), 1u);
    EXPECT_NEAR(std::remainder(seen[0].features.phase - phase, 1), 0, 0.03) << phase;
  }
}
