/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// A window shows more light than that of known lamps, or does not.

#include <visp3/vlp_detection/vpLedRoiDetector.h>

#include "common/vpLampPicture.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
vpPaintedLamp lamp(double u = 120.3, double v = 110.6)
{
  vpPaintedLamp lamp;
  lamp.centre = {u, v};
  lamp.a = lamp.b = 36;
  lamp.frequency = 2000;
  lamp.pwm(0.5);
  return lamp;
}

vpLampPicture picture(const std::vector<vpPaintedLamp> &lamps)
{
  vpLampPicture picture;
  picture.width = 320;
  picture.height = 240;
  picture.noise = 1;
  picture.lamps = lamps;
  return picture;
}

TEST(LightSearch, ShowsWhatKnownLampsDoNot)
{
  const vpImage<unsigned char> dark = picture({}).render(), one = picture({lamp()}).render();
  const vpRect all(0, 0, 320, 240), box(80, 70, 80, 80);
  EXPECT_FALSE(vpLedRoiDetector::showsMore(dark, all, {}, 1));
  EXPECT_TRUE(vpLedRoiDetector::showsMore(one, all, {}, 1));
  EXPECT_FALSE(vpLedRoiDetector::showsMore(one, all, {box}, 1));
  EXPECT_FALSE(vpLedRoiDetector::showsMore(one, vpRect(0, 160, 320, 80), {}, 1));
  vpPaintedLamp dim = lamp(250, 170);
  dim.amplitude = 14;
  const vpImage<unsigned char> both = picture({lamp(), dim}).render();
  EXPECT_TRUE(vpLedRoiDetector::showsMore(both, all, {box}, 1));
  EXPECT_FALSE(vpLedRoiDetector::showsMore(both, all, {box, vpRect(210, 130, 80, 80)}, 1));
  EXPECT_FALSE(vpLedRoiDetector::showsMore(both, vpRect(400, 300, 50, 50), {}, 1)); // outside
}

TEST(LightSearch, EverySampleOfALineCounts)
{
  for (unsigned int first = 0; first + 3 <= 200; ++first) {
    vpImage<unsigned char> I(4, 200, 10);
    I[2][first] = I[2][first + 1] = I[2][first + 2] = 60;
    EXPECT_TRUE(vpLedRoiDetector::showsMore(I, vpRect(0, 0, 200, 4), {}, 1)) << first;
    I[2][first + 1] = 10;
    EXPECT_FALSE(vpLedRoiDetector::showsMore(I, vpRect(0, 0, 200, 4), {}, 1)) << first;
  }
}
} // namespace
