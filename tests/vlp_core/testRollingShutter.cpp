/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>
#include <visp3/core/vpException.h>
#include <visp3/core/vpMeterPixelConversion.h>
#include <visp3/vlp_core/vpRollingShutter.h>

#include "common/vpExpectError.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
using Method = vpPictureResize::Method;
using Readout = vpRollingShutter::Readout;

//! 1 x n picture whose pixels are their own coordinate.
cv::Mat ramp(unsigned int n)
{
  cv::Mat line(1, static_cast<int>(n), CV_32F);
  for (int i = 0; i < line.cols; ++i) {
    line.at<float>(i) = static_cast<float>(i);
  }
  return line;
}

cv::Mat resized(unsigned int source, unsigned int delivered, int interpolation)
{
  cv::Mat target;
  cv::resize(ramp(source), target, cv::Size(static_cast<int>(delivered), 1), 0, 0, interpolation);
  return target;
}

vpPictureResize resize(Method method, unsigned int width = 0, unsigned int height = 0)
{
  return {method, width, height};
}

vpRollingShutter shutter(Readout readout)
{
  vpRollingShutter shutter;
  shutter.rowTime = 40e-6;
  shutter.exposure = 100e-6;
  shutter.readout = readout;
  return shutter;
}
} // namespace

TEST(PictureResize, NearestTakesThePixelsThatOpenCVTakes)
{
  const vpPictureResize nearest = resize(Method::nearest);
  for (const unsigned int source : {2048u, 1536u, 1280u, 1000u, 997u, 640u, 7u, 1u}) {
    for (const unsigned int delivered : {2047u, 1000u, 800u, 600u, 480u, 333u, 320u, 123u, 7u, 3u, 1u}) {
      if (delivered > source) {
        continue;
      }
      const cv::Mat expected = resized(source, delivered, cv::INTER_NEAREST);
      for (unsigned int k = 0; k < delivered; ++k) {
        ASSERT_EQ(nearest.sensorPosition(k, delivered, source), expected.at<float>(static_cast<int>(k)))
            << source << " to " << delivered << ", pixel " << k;
      }
    }
  }
}

TEST(PictureResize, AreaTakesTheMeanThatOpenCVTakes)
{
  const vpPictureResize area = resize(Method::area);
  for (const auto &[source, delivered] :
       {std::pair{2048u, 800u}, {1536u, 600u}, {640u, 320u}, {1000u, 333u}, {5u, 5u}}) {
    const cv::Mat expected = resized(source, delivered, cv::INTER_AREA);
    for (unsigned int k = 0; k < delivered; ++k) {
      ASSERT_NEAR(area.sensorPosition(k, delivered, source), expected.at<float>(static_cast<int>(k)), 2e-3)
          << source << " to " << delivered << ", pixel " << k;
    }
  }
}

TEST(PictureResize, AffineRuleIsTheMeanOfThePositions)
{
  for (const Method method : {Method::none, Method::nearest, Method::area}) {
    for (const auto &[source, delivered] :
         {std::pair{2048u, 800u}, {1536u, 600u}, {640u, 320u}, {1000u, 300u}}) {
      double scale, offset;
      resize(method).sensorAxis(delivered, source, scale, offset);
      EXPECT_DOUBLE_EQ(scale, method == Method::none ? 1 : static_cast<double>(source) / delivered);
      double mean = 0, worst = 0;
      for (unsigned int k = 0; k < delivered; ++k) {
        const double off = resize(method).sensorPosition(k, delivered, source) - (scale * k + offset);
        mean += off / delivered;
        worst = std::max(worst, std::abs(off));
      }
      EXPECT_NEAR(mean, 0, 1e-9);
      EXPECT_LE(worst, method == Method::nearest ? 0.5 : 0.1); // sensor pixels
    }
  }
}

TEST(PictureResize, KnownOffsets)
{
  double scale, offset;
  resize(Method::nearest).sensorAxis(800, 2048, scale, offset); // 64/25
  EXPECT_DOUBLE_EQ(offset, -12.0 / 25);
  resize(Method::nearest).sensorAxis(320, 640, scale, offset); // pixel k is sensor pixel 2 k exactly
  EXPECT_DOUBLE_EQ(offset, 0);
  resize(Method::area).sensorAxis(320, 640, scale, offset);
  EXPECT_DOUBLE_EQ(offset, 0.5);
}

TEST(PictureResize, CameraOfTheDeliveredPictureSeesTheSamePoints)
{
  const std::vector<double> kb = {0.01, -0.002, 0.0005, 0.0001, 0};
  const vpCameraParameters sensors[] = {vpCameraParameters(1800, 1810, 1030, 760),
                                        vpCameraParameters(1800, 1810, 1030, 760, -0.1, 0.11),
                                        vpCameraParameters(1800, 1810, 1030, 760, kb)};
  for (const vpCameraParameters &sensor : sensors) {
    for (const Method method : {Method::nearest, Method::area}) {
      const vpPictureResize rule = resize(method, 2048, 1536);
      const vpCameraParameters camera = rule.delivered(sensor, 800, 600);
      EXPECT_EQ(camera.get_projModel(), sensor.get_projModel());
      double scaleU, offsetU, scaleV, offsetV;
      double u = 0, v = 0, sensorU = 0, sensorV = 0;
      rule.sensorAxis(800, 2048, scaleU, offsetU);
      rule.sensorAxis(600, 1536, scaleV, offsetV);
      for (const double x : {-0.4, 0.0, 0.3}) {
        for (const double y : {-0.3, 0.1}) {
          vpMeterPixelConversion::convertPoint(camera, x, y, u, v);
          vpMeterPixelConversion::convertPoint(sensor, x, y, sensorU, sensorV);
          EXPECT_NEAR(scaleU * u + offsetU, sensorU, 1e-9);
          EXPECT_NEAR(scaleV * v + offsetV, sensorV, 1e-9);
        }
      }
    }
  }
}

TEST(PictureResize, RefusesAnEnlargement)
{
  vpExpectError([] { resize(Method::nearest).sensorPosition(0, 800, 640); }, {"640", "800"});
  vpExpectError([] { vpLineTiming(shutter(Readout::rows), resize(Method::area, 640, 480), 640, 481); },
                {"480", "481"});
  vpExpectError([] { vpLineTiming(shutter(Readout::rows), {}, 640, 0); }, {"0 pixels"});
}

TEST(LineTiming, WithoutAResizeLinesFollowEachOtherByTheRowTime)
{
  const vpLineTiming rows(shutter(Readout::rows), {}, 640, 480);
  ASSERT_EQ(rows.lines(), 480u);
  EXPECT_DOUBLE_EQ(rows.middle(0), 50e-6);
  EXPECT_DOUBLE_EQ(rows.middle(479), 479 * 40e-6 + 50e-6);
  EXPECT_DOUBLE_EQ(rows.meanLineTime(), 40e-6);
  EXPECT_DOUBLE_EQ(rows.exposure(), 100e-6);
  EXPECT_EQ(rows.averaging(), 0);
  EXPECT_EQ(rows.samplePositions().size(), 640u);
  for (unsigned int k = 0; k < 480; ++k) {
    EXPECT_EQ(rows.linePositions()[k], k);
  }
  const vpLineTiming columns(shutter(Readout::columns), {}, 640, 480);
  EXPECT_EQ(columns.lines(), 640u);
  EXPECT_EQ(columns.samplePositions().size(), 480u);
}

TEST(LineTiming, ReversedReadoutCountsFromTheOtherEnd)
{
  for (const vpPictureResize &rule :
       {resize(Method::none), resize(Method::nearest, 2048, 1536), resize(Method::area, 2048, 1536)}) {
    for (const bool columns : {false, true}) {
      const vpLineTiming forward(shutter(columns ? Readout::columns : Readout::rows), rule, 800, 600);
      const vpLineTiming back(shutter(columns ? Readout::columnsReversed : Readout::rowsReversed), rule, 800,
                              600);
      const unsigned int sensorLines =
          rule.method == Method::none ? forward.lines() : (columns ? 2048u : 1536u);
      EXPECT_DOUBLE_EQ(back.meanLineTime(), -forward.meanLineTime());
      for (unsigned int k = 0; k < forward.lines(); ++k) {
        EXPECT_NEAR(back.middle(k) + forward.middle(k), (sensorLines - 1) * 40e-6 + 100e-6, 1e-12);
        if (k > 0) {
          EXPECT_GT(forward.middle(k), forward.middle(k - 1));
          EXPECT_LT(back.middle(k), back.middle(k - 1));
        }
      }
      EXPECT_EQ(back.linePositions(), forward.linePositions());
    }
  }
}

TEST(LineTiming, NearestKeepsTheUnevenTimesOfTheSensorsLines)
{
  const vpLineTiming timing(shutter(Readout::rows), resize(Method::nearest, 2048, 1536), 800, 600);
  EXPECT_DOUBLE_EQ(timing.meanLineTime(), 2.56 * 40e-6);
  EXPECT_EQ(timing.averaging(), 0);
  int twos = 0, threes = 0;
  for (unsigned int k = 1; k < timing.lines(); ++k) {
    const double steps = (timing.middle(k) - timing.middle(k - 1)) / 40e-6;
    EXPECT_NEAR(steps, std::round(steps), 1e-9);
    twos += std::lround(steps) == 2;
    threes += std::lround(steps) == 3;
  }
  EXPECT_EQ(twos + threes, 599);
  EXPECT_NEAR(threes / 599.0, 0.56, 0.01);
  double mean = 0;
  for (unsigned int k = 0; k < timing.lines(); ++k) {
    EXPECT_NEAR(timing.linePositions()[k], k, 0.5);
    mean += (timing.linePositions()[k] - k) / timing.lines();
    // the time is that of the position, affinely
    EXPECT_NEAR(timing.middle(k), (2.56 * timing.linePositions()[k] - 0.48) * 40e-6 + 50e-6, 1e-12);
  }
  EXPECT_NEAR(mean, 0, 1e-9);
}

TEST(LineTiming, AreaAveragesOverItsSensorLines)
{
  const vpLineTiming timing(shutter(Readout::columns), resize(Method::area, 1280, 960), 640, 480);
  EXPECT_DOUBLE_EQ(timing.middle(0), 0.5 * 40e-6 + 50e-6); // sensor lines 0 and 1
  EXPECT_DOUBLE_EQ(timing.averaging(),
                   std::sqrt(3) * 40e-6); // lines 0 and 40 us: variance (80^2 - 40^2) / 12
  EXPECT_EQ(vpLineTiming(shutter(Readout::rows), resize(Method::area, 640, 480), 640, 480).averaging(), 0);
}

TEST(LineTiming, BetweenLinesItInterpolatesAndOutsideItGoesOn)
{
  for (const Readout readout : {Readout::rows, Readout::rowsReversed}) {
    const vpLineTiming timing(shutter(readout), resize(Method::nearest, 2048, 1536), 800, 600);
    for (const unsigned int k : {0u, 1u, 300u, 599u}) {
      EXPECT_DOUBLE_EQ(timing.middleAt(k), timing.middle(k));
    }
    EXPECT_DOUBLE_EQ(timing.middleAt(10.25), 0.75 * timing.middle(10) + 0.25 * timing.middle(11));
    EXPECT_DOUBLE_EQ(timing.middleAt(-2), timing.middle(0) - 2 * timing.meanLineTime());
    EXPECT_DOUBLE_EQ(timing.middleAt(601), timing.middle(599) + 2 * timing.meanLineTime());
  }
  const vpLineTiming one(shutter(Readout::rows), {}, 640, 1);
  EXPECT_DOUBLE_EQ(one.middleAt(0.5), 20e-6 + 50e-6);
  vpExpectError([] { vpLineTiming().middleAt(0); }, {"no lines"});
}
