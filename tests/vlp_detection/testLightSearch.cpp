/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Where a window shows other light than that of known lamps.

#include <algorithm>
#include <cmath>

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

std::vector<vpRect> lightIn(const vpImage<unsigned char> &I, const vpRect &window,
                            const std::vector<vpRect> &known)
{
  std::vector<vpRect> found;
  vpLedRoiDetector::otherLight(I, window, known, 1, found);
  return found;
}

bool shows(const vpImage<unsigned char> &I, const vpRect &window, const std::vector<vpRect> &known)
{
  return !lightIn(I, window, known).empty();
}

TEST(LightSearch, ShowsWhatKnownLampsDoNot)
{
  const vpImage<unsigned char> dark = picture({}).render(), one = picture({lamp()}).render();
  const vpRect all(0, 0, 320, 240), box(80, 70, 80, 80);
  EXPECT_FALSE(shows(dark, all, {}));
  EXPECT_TRUE(shows(one, all, {}));
  EXPECT_FALSE(shows(one, all, {box}));
  EXPECT_FALSE(shows(one, vpRect(0, 160, 320, 80), {}));
  vpPaintedLamp dim = lamp(250, 170);
  dim.amplitude = 14;
  const vpImage<unsigned char> both = picture({lamp(), dim}).render();
  EXPECT_TRUE(shows(both, all, {box}));
  EXPECT_FALSE(shows(both, all, {box, vpRect(210, 130, 80, 80)}));
  EXPECT_FALSE(shows(both, vpRect(400, 300, 50, 50), {})); // outside
}

TEST(LightSearch, EverySampleOfALineCounts)
{
  for (unsigned int first = 0; first + 3 <= 200; ++first) {
    vpImage<unsigned char> I(4, 200, 10);
    I[2][first] = I[2][first + 1] = I[2][first + 2] = 60;
    EXPECT_TRUE(shows(I, vpRect(0, 0, 200, 4), {})) << first;
    I[2][first + 1] = 10;
    EXPECT_FALSE(shows(I, vpRect(0, 0, 200, 4), {})) << first;
  }
}

TEST(LightSearch, BoxesHoldTheirLamps)
{
  const vpImage<unsigned char> I = picture({lamp(60, 60), lamp(250, 170)}).render();
  const std::vector<vpRect> boxes = lightIn(I, vpRect(0, 0, 320, 240), {});
  ASSERT_EQ(2u, boxes.size());
  for (const double u : {60., 250.}) {
    const double v = u < 100 ? 60 : 170;
    EXPECT_TRUE(std::any_of(boxes.begin(), boxes.end(), [&](const vpRect &box) {
      return box.getLeft() < u - 33 && box.getRight() > u + 33 && std::abs(box.getCenter().get_v() - v) < 10;
    })) << u;
  }
}
} // namespace
