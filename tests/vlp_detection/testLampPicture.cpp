/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <gtest/gtest.h>

#include "common/vpLampPicture.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

// The yardstick itself, held against what is known of a disc and of a square wave.

namespace
{
vpLampPicture still(double blur)
{
  vpLampPicture picture;
  picture.width = 90;
  picture.height = 80;
  picture.blur = blur;
  picture.lamps.resize(1);
  picture.lamps[0].centre = {41.3, 38.7};
  picture.lamps[0].a = 28;
  picture.lamps[0].b = 20;
  picture.lamps[0].angle = 0.4;
  return picture;
}

Eigen::Vector2d middleOf(const cv::Mat_<float> &share)
{
  const cv::Moments m = cv::moments(share);
  return {m.m10 / m.m00, m.m01 / m.m00};
}
} // namespace

TEST(LampPicture, AreaAndMiddleAreTheEllipses)
{
  for (const double blur : {0.0, 0.7, 2.0}) {
    const vpLampPicture picture = still(blur);
    const cv::Mat_<float> share = picture.coverage(picture.lamps[0]);
    EXPECT_NEAR(cv::sum(share)[0], M_PI * 28 * 20, 0.1) << blur;
    EXPECT_LT((middleOf(share) - picture.lamps[0].centre).norm(), 1e-3) << blur;
  }
}

TEST(LampPicture, EdgeIsAGaussianAsWideAsTheBlur)
{
  vpLampPicture picture;
  picture.width = picture.height = 60;
  picture.blur = 1.5;
  picture.lamps.resize(1);
  picture.lamps[0].centre = {30.2, 30};
  picture.lamps[0].rectangle(40, 40);
  const cv::Mat_<float> share = picture.coverage(picture.lamps[0]);
  const double spread = std::sqrt(1.5 * 1.5 + 1.0 / 12); // a pixel averages over its own width
  for (int u = 0; u < 30; ++u)
    EXPECT_NEAR(share(30, u), 0.5 * std::erfc((10.2 - u) / spread / std::sqrt(2)), 1e-3) << u;
}

TEST(LampPicture, LightIsTheMeanOverTheExposure)
{
  vpPaintedLamp lamp;
  lamp.frequency = 100;
  lamp.phase = 0.3;
  for (int kind = 0; kind < 3; ++kind) {
    if (kind == 0)
      lamp.pwm(0.37);
    else if (kind == 1)
      lamp.twoPulse(0.5, 0.4);
    else
      lamp.chips("0110100111");
    for (const double t : {0.0, 0.0013, 0.0077, 5.002}) {
      double lit = 0;
      for (int k = 0; k < 20000; ++k) {
        const double x = (t + (k + 0.5) / 20000 * 0.004) * lamp.frequency + lamp.phase, y = x - std::floor(x);
        for (const vpPaintedLamp::Pulse &pulse : lamp.pulses)
          lit += y >= pulse.start && y < pulse.start + pulse.length;
      }
      EXPECT_NEAR(lamp.light(t, 0.004), lit / 20000, 2e-4) << kind << " " << t;
    }
  }
}

TEST(LampPicture, StripesRunAlongTheReadout)
{
  vpLampPicture picture = still(0);
  picture.lamps[0].frequency = 1 / (8 * picture.rowTime);
  picture.lamps[0].pwm(0.5);
  picture.noise = 0;
  for (const bool reversed : {false, true}) {
    picture.reversed = reversed;
    picture.columns = false;
    const vpImage<unsigned char> rows = picture.render();
    picture.columns = true;
    const vpImage<unsigned char> columns = picture.render();
    for (unsigned int k = 30; k < 50; ++k) {
      EXPECT_EQ(rows[k][41], reversed ? (79 - k) % 8 < 4 ? 160 : 10 : k % 8 < 4 ? 160 : 10) << k;
      EXPECT_EQ(columns[38][k], reversed ? (89 - k) % 8 < 4 ? 160 : 10 : k % 8 < 4 ? 160 : 10) << k;
    }
  }
}
