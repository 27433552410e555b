/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// vpLedDetector::profile(): what was read of a lamp.

#include <algorithm>

#include <gtest/gtest.h>
#include <visp3/core/vpException.h>
#include <visp3/vlp_identification/vpLedDetector.h>
#include <visp3/vlp_identification/vpLitShare.h>

#include "common/vpLampPicture.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
const double profileRowTime = 43.1e-6; // s

vpVlpRig rigOf(unsigned int width, unsigned int height, vpRollingShutter::Readout readout)
{
  vpVlpRig rig;
  rig.width = width;
  rig.height = height;
  rig.camera.initPersProjWithoutDistortion(600, 600, 0.5 * width, 0.5 * height);
  rig.shutter.rowTime = rig.shutter.exposure = profileRowTime;
  rig.shutter.rowTimeSigma = 2e-9;
  rig.shutter.exposureSigma = 0.4e-6;
  rig.shutter.readout = readout;
  return rig;
}

vpLampPicture scene()
{
  vpLampPicture scene;
  scene.background = 4;
  scene.noise = 1;
  vpPaintedLamp lamp;
  lamp.centre = {260.3, 170.8};
  lamp.a = 62;
  lamp.b = 55;
  lamp.angle = 0.4;
  lamp.frequency = 2000;
  lamp.pwm(0.5);
  scene.lamps = {lamp};
  return scene;
}

vpImage<unsigned char> transposed(const vpImage<unsigned char> &I)
{
  vpImage<unsigned char> turned(I.getWidth(), I.getHeight());
  for (unsigned int v = 0; v < I.getHeight(); ++v) {
    for (unsigned int u = 0; u < I.getWidth(); ++u) {
      turned[u][v] = I[v][u];
    }
  }
  return turned;
}

vpStripeProfile profileOf(const vpImage<unsigned char> &I, const vpVlpRig &rig)
{
  vpLedDetector detector(rig, vpLampMap());
  detector.detect(I);
  return detector.observations().size() == 1 ? detector.profile(I, detector.observations()[0])
                                             : vpStripeProfile();
}
} // namespace

TEST(LampProfile, IsThatOfTheLampsLight)
{
  const vpLampPicture painted = scene();
  const vpImage<unsigned char> I = painted.render();
  const vpVlpRig rig = rigOf(I.getWidth(), I.getHeight(), vpRollingShutter::Readout::rows);
  vpLedDetector detector(rig, vpLampMap());
  detector.detect(I);
  ASSERT_EQ(detector.observations().size(), 1u);
  const vpLampObservation &lamp = detector.observations()[0];
  const vpStripeProfile profile = detector.profile(I, lamp);
  ASSERT_GT(profile.light.size(), 90u); // of 113 lines that the lamp has
  ASSERT_LT(profile.light.size(), 114u);
  const std::vector<double> share = vpLitShareOf(lamp.features, profile.time);
  ASSERT_EQ(share.size(), profile.light.size());
  const double most = *std::max_element(profile.light.begin(), profile.light.end());
  for (size_t i = 0; i < share.size(); ++i) {
    EXPECT_NEAR(profile.light[i], most * share[i], 0.08 * most) << i;
  }
  EXPECT_DOUBLE_EQ(profile.exposure, detector.exposure().exposure());
}

TEST(LampProfile, ReadoutAlongColumnsGivesTheSame)
{
  const vpImage<unsigned char> rows = scene().render(), columns = transposed(rows);
  const vpStripeProfile one = profileOf(
                            rows, rigOf(rows.getWidth(), rows.getHeight(), vpRollingShutter::Readout::rows)),
                        other = profileOf(columns, rigOf(columns.getWidth(), columns.getHeight(),
                                                         vpRollingShutter::Readout::columns));
  ASSERT_FALSE(one.light.empty());
  ASSERT_EQ(one.light.size(), other.light.size());
  for (size_t i = 0; i < one.light.size(); ++i) {
    EXPECT_NEAR(one.time[i], other.time[i], 1e-9);
    EXPECT_NEAR(one.light[i], other.light[i], 0.5);
  }
}

TEST(LampProfile, NothingInThePictureGivesNothing)
{
  const vpImage<unsigned char> I = scene().render();
  const vpLedDetector detector(rigOf(I.getWidth(), I.getHeight(), vpRollingShutter::Readout::rows),
                               vpLampMap());
  vpLampObservation lamp;
  lamp.outline.shape = vpLampOutline::Shape::ellipse;
  lamp.outline.a = lamp.outline.b = 20;
  for (const Eigen::Vector2d &place :
       {Eigen::Vector2d(-1e9, 3), Eigen::Vector2d(3, 1e9), Eigen::Vector2d(NAN, 4)}) {
    lamp.outline.centre = place;
    EXPECT_TRUE(detector.profile(I, lamp).light.empty());
  }
  EXPECT_THROW(detector.profile(vpImage<unsigned char>(10, 10), lamp), vpException);
}
