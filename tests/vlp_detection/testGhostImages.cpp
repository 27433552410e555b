/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Dimmer light that blinks with a lamp: its ghost in a pane of glass, a rim or a plate that it lights.

#include <cmath>

#include <gtest/gtest.h>

#include "common/paintedLamps.h"

using namespace paintedLamps;

namespace
{
const double radius = 32;
const double ghostPhases[] = {0, 0.29, 0.57, 0.83};

vpPaintedLamp lampInPhase(double phase)
{
  return disc(95.3, 94.8, radius, 170, 8, 0.5, phase);
}

//! Of all regions in the picture, that whose outline's middle is nearest to the lamp's.
vpLampOutline outlineOf(const vpLampPicture &picture)
{
  const Eigen::Vector2d centre = picture.lamps[0].centre;
  vpLampOutline nearest;
  for (const vpLampOutline &outline : outlinesIn(picture))
    if (nearest.shape == vpLampOutline::Shape::region ||
        (outline.centre - centre).norm() < (nearest.centre - centre).norm())
      nearest = outline;
  return nearest;
}

//! Whether the outline is the lamp's; or, with a \e bright ghost image, states how far from it it may be.
void expectTheLamp(const vpLampOutline &outline, const vpPaintedLamp &lamp, bool bright)
{
  const Eigen::Vector2d error = outline.centre - lamp.centre;
  const double sigmas = std::sqrt(error.dot(outline.centreCovariance.inverse() * error));
  static const double little = 0.06; // px: an edge a pixel beside the lamp's is no edge of its own
  EXPECT_TRUE(sigmas < 5 || error.norm() < little)
      << "off by " << error.transpose() << ", " << sigmas << " sigma";
  if (!bright) {
    EXPECT_LT(error.norm(), 0.15);
    EXPECT_NEAR(outline.diameter(), 2 * radius, 0.5);
  }
}
} // namespace

TEST(GhostImages, GhostOfALampDoesNotMoveIt)
{
  for (const double share : {0.04, 0.1, 0.2, 0.3})
    for (const double apart : {0.25, 0.5, 1.0}) // radii
      for (const double angle : {0.4, 2.0, 4.1})
        for (const double phase : ghostPhases) {
          vpPaintedLamp ghost = lampInPhase(phase);
          ghost.amplitude *= share;
          ghost.centre += apart * radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
          SCOPED_TRACE(testing::Message() << "share " << share << ", " << apart << " radii towards " << angle
                                          << ", phase " << phase);
          const vpLampPicture picture = pictureOf({lampInPhase(phase), ghost}, 190, 190);
          expectTheLamp(outlineOf(picture), picture.lamps[0], share > 0.25);
        }
}

TEST(GhostImages, RimThatALampLightsIsNoPartOfIt)
{
  for (const double share : {0.05, 0.1, 0.2})
    for (const double aside : {0.0, 0.1, 0.17}) // radii
      for (const double phase : ghostPhases) {
        vpPaintedLamp rim = lampInPhase(phase);
        rim.a = rim.b = 1.2 * radius;
        rim.amplitude *= share;
        rim.centre.x() += aside * radius;
        SCOPED_TRACE(testing::Message()
                     << "share " << share << ", " << aside << " radii aside, phase " << phase);
        const vpLampPicture picture = pictureOf({lampInPhase(phase), rim}, 190, 190);
        expectTheLamp(outlineOf(picture), picture.lamps[0], false);
      }
}
