/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// The detector as a whole: from a picture to named lamps.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <visp3/vlp_identification/vpLedDetector.h>

#include "common/vpExpectError.h"
#include "common/vpLampPicture.h"
#include "common/vpPwmLamps.h"
#include "common/vpUpwardRig.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{

vpLampMap fourLampMap()
{
  return vpPwmLamps({2000, 2600, 3500});
}

vpPaintedLamp lampAt(double u, double v, double frequency, double duty = 0.5)
{
  vpPaintedLamp lamp;
  lamp.centre = {u, v};
  lamp.a = lamp.b = 30;
  lamp.frequency = frequency;
  lamp.phase = 0.3;
  lamp.pwm(duty);
  return lamp;
}

vpLampPicture fourLampPicture()
{
  vpLampPicture picture;
  picture.width = 400;
  picture.height = 320;
  picture.rowTime = picture.exposure = 40e-6;
  picture.blur = 0.7;
  picture.lamps = {lampAt(80.3, 70.6, 2000), lampAt(300.7, 90.2, 2600), lampAt(120.4, 240.8, 3500),
                   lampAt(310, 250, 5000)};
  return picture;
}

const vpLampObservation *find(const vpLedDetector &detector, const std::string &id)
{
  for (const vpLampObservation &lamp : detector.observations()) {
    if (lamp.id == id) {
      return &lamp;
    }
  }
  return nullptr;
}
} // namespace

TEST(LedDetector, NamesKnownLampsAndReportsAnUnknownOne)
{
  vpLedDetector detector(vpUpwardRig(400, 320), fourLampMap());
  ASSERT_TRUE(detector.detect(fourLampPicture().render()));
  EXPECT_EQ(detector.getNbObjects(), 4u);
  ASSERT_EQ(detector.observations().size(), 4u);
  for (const char *id : {"L2000", "L2600", "L3500"}) {
    ASSERT_NE(find(detector, id), nullptr) << id;
    EXPECT_GT(find(detector, id)->confidence, 0.99);
    EXPECT_FALSE(find(detector, id)->cut);
  }
  const vpLampObservation *unknown = find(detector, "");
  ASSERT_NE(unknown, nullptr);
  EXPECT_NEAR(unknown->features.frequency, 5000, 10);
  EXPECT_FALSE(unknown->remark.empty());
  EXPECT_NEAR(find(detector, "L2000")->point.x(), 80.3, 0.05);
  EXPECT_NEAR(find(detector, "L2000")->point.y(), 70.6, 0.05);
  EXPECT_NEAR(find(detector, "L2000")->outline.diameter(), 60, 0.1);
}

TEST(LedDetector, MessagesAndPolygonsAsEveryVispDetector)
{
  vpLedDetector detector(vpUpwardRig(400, 320), fourLampMap());
  detector.detect(fourLampPicture().render());
  vpDetectorBase &base = detector;
  for (size_t i = 0; i < base.getNbObjects(); ++i) {
    EXPECT_EQ(base.getMessage(i), detector.observations()[i].id);
    EXPECT_EQ(base.getPolygon(i).size(), 4u);
    EXPECT_NEAR(base.getCog(i).get_u(), detector.observations()[i].point.x(), 1);
    EXPECT_NEAR(base.getCog(i).get_v(), detector.observations()[i].point.y(), 1);
    EXPECT_NEAR(base.getBBox(i).getWidth(), 60, 2);
  }
}

TEST(LedDetector, ColumnsSeeTheSameLampsAsRows)
{
  vpLampPicture painted = fourLampPicture();
  painted.columns = true;
  vpVlpRig columns = vpUpwardRig(400, 320);
  columns.shutter.readout = vpRollingShutter::Readout::columns;
  vpLedDetector detector(columns, fourLampMap());
  ASSERT_TRUE(detector.detect(painted.render()));
  for (const vpPaintedLamp &lamp : painted.lamps) {
    const bool known = lamp.frequency < 4000;
    const auto seen = find(detector, known ? "L" + std::to_string(static_cast<int>(lamp.frequency)) : "");
    ASSERT_NE(seen, nullptr) << lamp.frequency;
    EXPECT_LT((seen->point - lamp.centre).norm(), 0.05) << lamp.frequency;
    EXPECT_NEAR(seen->time, 40e-6 * lamp.centre.x() + 20e-6, 2e-6) << "lines are columns";
  }
}

TEST(LedDetector, NearestNeighbourResizeKeepsTheFrequencyNearHalfTheSamplingRate)
{
  // Sensor of 2.56 times the lines; every other line step is 2, the others 3: taken as even, 3500 Hz comes
  // out wrong.
  vpLampPicture sensor;
  sensor.width = 512;
  sensor.height = 512;
  sensor.rowTime = 45e-6;
  sensor.exposure = 60e-6;
  sensor.blur = 1;
  sensor.lamps = {lampAt(256.2, 255.7, 3500)};
  sensor.lamps[0].a = sensor.lamps[0].b = 150;
  const vpImage<unsigned char> full = sensor.render();
  vpImage<unsigned char> delivered(200, 200);
  for (unsigned int y = 0; y < 200; ++y) {
    for (unsigned int x = 0; x < 200; ++x) {
      delivered[y][x] = full[static_cast<unsigned int>(y * 2.56)][static_cast<unsigned int>(x * 2.56)];
    }
  }
  vpVlpRig resized = vpUpwardRig(200, 200);
  resized.shutter.rowTime = 45e-6;
  resized.shutter.exposure = 60e-6;
  resized.resize.method = vpPictureResize::Method::nearest;
  resized.resize.sourceWidth = resized.resize.sourceHeight = 512;
  vpLedDetector detector(resized, fourLampMap());
  ASSERT_TRUE(detector.detect(delivered));
  ASSERT_EQ(detector.observations().size(), 1u);
  EXPECT_EQ(detector.observations()[0].id, "L3500");
  EXPECT_NEAR(detector.observations()[0].features.frequency, 3500, 5);
}

TEST(LedDetector, LampCutByTheBorderIsFlagged)
{
  vpLampPicture painted = fourLampPicture();
  painted.lamps = {lampAt(8, 150, 2000)};
  vpLedDetector detector(vpUpwardRig(400, 320), fourLampMap());
  ASSERT_TRUE(detector.detect(painted.render()));
  ASSERT_EQ(detector.observations().size(), 1u);
  EXPECT_TRUE(detector.observations()[0].cut);
  EXPECT_EQ(detector.observations()[0].id, "L2000");
}

// What the border hides of a lamp, it may hide in a dark stripe. A glow about the lamp is no part of it.
TEST(LedDetector, WhereTheBorderCutsALampItsMiddleIsAsUncertainAsItIsSaidToBe)
{
  int named = 0;
  for (const double beyond : {-20, -3, 4, 12, 16}) // px, of the middle, as seen from the border
    for (const double frequency : {2000, 2600})
      for (int k = 0; k < 10; ++k) {
        vpLampPicture painted = fourLampPicture();
        painted.lamps = {lampAt(120.4, -beyond, frequency), lampAt(120.4, -beyond, frequency)};
        painted.lamps[0].phase = painted.lamps[1].phase = (k + 0.5) / 10;
        painted.lamps[1].a = painted.lamps[1].b = 70;
        painted.lamps[1].amplitude = 1.5;
        vpLedDetector detector(vpUpwardRig(400, 320), fourLampMap());
        detector.detect(painted.render());
        for (const vpLampObservation &seen : detector.observations()) {
          if (!seen.id.empty()) {
            const Eigen::Vector2d error = seen.point - painted.lamps[0].centre;
            EXPECT_LT(error.dot(seen.covariance.inverse() * error), 5 * 5)
                << beyond << " " << frequency << " " << k << ": " << error.transpose() << " +- "
                << seen.covariance.diagonal().cwiseSqrt().transpose();
            ++named;
          }
        }
      }
  EXPECT_GT(named, 60);
}

TEST(LedDetector, UnmodulatedLampAndWindowAreNoLampsOfTheMap)
{
  vpLampPicture painted = fourLampPicture();
  vpPaintedLamp window = lampAt(300, 240, 0);
  window.rectangle(120, 90);
  window.pulses = {{0, 1}};
  vpPaintedLamp steady = lampAt(80, 80, 0);
  steady.pulses = {{0, 1}};
  painted.lamps = {window, steady};
  vpLedDetector detector(vpUpwardRig(400, 320), fourLampMap());
  ASSERT_TRUE(detector.detect(painted.render()));
  EXPECT_EQ(detector.observations().size(), 2u);
  for (const vpLampObservation &seen : detector.observations()) {
    EXPECT_TRUE(seen.id.empty());
    EXPECT_EQ(seen.features.signal, vpStripeFeatures::Signal::unmodulated);
  }
}

// At a first look what shines steadily is told from what blinks, whatever its shape; lamps are found as ever.
TEST(LedDetector, SteadyLightNeedsNoOutline)
{
  vpLampPicture made = fourLampPicture();
  made.width = 700;
  vpPaintedLamp bulb = lampAt(450.4, 165.2, 0), panel = lampAt(560.1, 162.3, 0), tube = lampAt(660, 164, 0);
  panel.angle = 0.2;
  panel.rectangle(74, 70);
  bulb.a = bulb.b = 36;
  tube.rectangle(30, 84);
  for (vpPaintedLamp *steady : {&bulb, &panel, &tube}) {
    steady->pulses = {{0, 1}};
    made.lamps.push_back(*steady);
  }
  const vpImage<unsigned char> I = made.render();
  vpLedDetector detector(vpUpwardRig(700, 320), fourLampMap()), alone(vpUpwardRig(400, 320), fourLampMap());
  ASSERT_TRUE(detector.detect(I));
  ASSERT_TRUE(alone.detect(fourLampPicture().render()));
  int boxes = 0;
  for (const vpLampObservation &seen : detector.observations()) {
    const bool steady = seen.features.signal == vpStripeFeatures::Signal::unmodulated;
    boxes += steady ? 1 : 0;
    EXPECT_TRUE(steady || seen.outline.shape != vpLampOutline::Shape::region);
  }
  EXPECT_EQ(boxes, 3);
  for (const char *id : {"L2000", "L2600", "L3500"}) {
    EXPECT_EQ(find(detector, id) != nullptr, find(alone, id) != nullptr) << id;
  }
}

// Stripes that hardly show, as of an exposure of nearly a period: no first look may take them for steady
// light.
// Light on end is steady where each lamp of the map would show it its dark time, longer than a line and an
// exposure (40 us each, the latter known to a factor of two or exactly).
TEST(LedDetector, LongestPeriodIsKnownWhereEachLampShowsItsDark)
{
  auto longest = [](double frequency, double duty, vpModulation::Kind kind, double exposureSigma) {
    vpVlpRig rig = vpUpwardRig(400, 320);
    rig.shutter.exposureSigma = exposureSigma;
    vpLampMap map = vpPwmLamps({frequency});
    map.lamps[0].modulation.kind = kind;
    map.lamps[0].modulation.duty = duty;
    return vpLedDetector(rig, map).longestPeriod;
  };
  const vpModulation::Kind pwm = vpModulation::Kind::pwm, two = vpModulation::Kind::twoPulse;
  EXPECT_GE(longest(5000, 0.5, pwm, 0), 200e-6); // dark for 100 us
  EXPECT_LT(longest(5000, 0.5, pwm, 0), 300e-6);
  EXPECT_TRUE(std::isinf(longest(7000, 0.5, pwm, 0)));     // for 71 us
  EXPECT_TRUE(std::isinf(longest(5000, 0.5, two, 0)));     // for 50 us
  EXPECT_TRUE(std::isinf(longest(5000, 0.5, pwm, 40e-6))); // an exposure of 80 us may hide it
  vpVlpRig untimed = vpUpwardRig(400, 320);
  untimed.shutter.rowTime = 0;
  EXPECT_TRUE(std::isinf(vpLedDetector(untimed, vpPwmLamps({1000})).longestPeriod));
}

TEST(LedDetector, FaintStripesAreNoSteadyLight)
{
  for (const double amplitude : {60.0, 150.0}) {
    vpLampPicture made = fourLampPicture();
    made.exposure = 0.85 / 2000;
    made.lamps = {lampAt(80.3, 70.6, 2000)};
    made.lamps[0].amplitude = amplitude;
    vpLedDetector detector(vpUpwardRig(400, 320), fourLampMap());
    ASSERT_TRUE(detector.detect(made.render()));
    ASSERT_EQ(detector.observations().size(), 1u);
    EXPECT_NE(detector.observations()[0].features.signal, vpStripeFeatures::Signal::unmodulated) << amplitude;
  }
}

TEST(LedDetector, SaturatedLampKeepsIdAndPlace)
{
  vpLampPicture painted = fourLampPicture();
  for (vpPaintedLamp &lamp : painted.lamps) {
    lamp.amplitude = 900; // lit lines clip at 255
  }
  vpLedDetector detector(vpUpwardRig(400, 320), fourLampMap());
  ASSERT_TRUE(detector.detect(painted.render()));
  const vpLampObservation *seen = find(detector, "L2000");
  ASSERT_NE(seen, nullptr);
  EXPECT_GT(seen->features.dutyClipped, 0);
  EXPECT_LT((seen->point - painted.lamps[0].centre).norm(), 0.5);
}

//! Clipped stripes seem longer and lie elsewhere; what is said of them is as uncertain as that.
TEST(LedDetector, ClippedStripesAreAsUncertainAsTheyAre)
{
  double frequency = 0, duty = 0, most = 0; // squares of normalised errors
  int count = 0;
  for (int phase = 0; phase < 40; ++phase) {
    vpLampPicture painted = fourLampPicture();
    painted.exposure = 100e-6;
    painted.lamps.resize(1);
    painted.lamps[0].frequency = 2000 + 61.7 * phase;
    painted.lamps[0].phase = phase / 40.0;
    painted.lamps[0].amplitude = 700;
    vpLedDetector detector(vpUpwardRig(400, 320), fourLampMap());
    detector.detect(painted.render());
    if (detector.observations().size() != 1 || !(detector.observations()[0].features.dutyClipped > 0) ||
        !std::isfinite(detector.observations()[0].features.frequency)) {
      continue;
    }
    const vpStripeFeatures &seen = detector.observations()[0].features;
    ++count;
    const double off = (seen.frequency - painted.lamps[0].frequency) / seen.frequencySigma;
    frequency += off * off;
    most = std::max(most, std::abs(off));
    duty += std::pow((seen.duty - 0.5) / seen.dutySigma, 2);
  }
  ASSERT_GT(count, 20);
  EXPECT_LT(std::sqrt(frequency / count), 1.5);
  EXPECT_LT(most, 5);
  EXPECT_LT(std::sqrt(duty / count), 2);
}

//! Two periods of two pulses have the edges of four: more than enough for a frequency.
TEST(LedDetector, TwoPeriodsOfTwoPulsesTellTheirFrequency)
{
  vpLampMap two = fourLampMap();
  two.lamps[0].modulation.kind = vpModulation::Kind::twoPulse;
  two.lamps[0].modulation.frequency = 330;
  two.lamps[0].modulation.duty = 0.25;
  two.lamps[0].modulation.phaseDifference = 0.34;
  two.lamps.resize(1);
  for (int phase = 0; phase < 20; ++phase) {
    vpLampPicture painted = fourLampPicture();
    painted.lamps.resize(1);
    painted.lamps[0].centre = {200.3, 160.6};
    painted.lamps[0].a = painted.lamps[0].b = 75;
    painted.lamps[0].frequency = 330;
    painted.lamps[0].phase = phase / 20.0;
    painted.lamps[0].twoPulse(0.25, 0.34);
    vpLedDetector detector(vpUpwardRig(400, 320), two);
    detector.detect(painted.render());
    ASSERT_EQ(detector.observations().size(), 1u);
    EXPECT_EQ(detector.observations()[0].id, two.lamps[0].id) << phase;
    EXPECT_NEAR(detector.observations()[0].features.frequency, 330, 1) << phase;
  }
}

// A lamp slower than any of the map may fall into its stripes; none of these is a lamp of the map.
TEST(LedDetector, SlowerLampHasNoName)
{
  for (const double frequency : {100.0, 150.0, 300.0, 700.0}) {
    for (unsigned int phase = 0; phase < 20; ++phase) {
      vpLampPicture slow = fourLampPicture();
      slow.lamps = {lampAt(200.4, 160.2, frequency)};
      slow.lamps[0].a = slow.lamps[0].b = 73;
      slow.lamps[0].phase = phase / 20.0;
      slow.seed = phase;
      vpLedDetector detector(vpUpwardRig(400, 320), fourLampMap());
      detector.detect(slow.render());
      for (const vpLampObservation &seen : detector.observations()) {
        EXPECT_EQ(seen.id, "") << frequency << " Hz, phase " << slow.lamps[0].phase;
      }
    }
  }
}

// Tubes in rows, as long as a lamp's stripes and farther apart than any lamp is dark: no stripes of a lamp.
TEST(LedDetector, LampsBetweenRowsOfTubesKeepTheirNames)
{
  for (const double apart : {17.0, 21.0, 26.0, 40.0}) {
    vpLampPicture rows = fourLampPicture();
    const vpLampPicture lamps = rows;
    for (double v = 4; v < 316; v += apart) {
      for (const double u : {20.0, 200.0, 380.0}) {
        vpPaintedLamp tube = lampAt(u, v, 0);
        tube.pulses = {{0, 1}};
        tube.rectangle(100, 6);
        const bool free =
            std::none_of(lamps.lamps.begin(), lamps.lamps.end(), [&](const vpPaintedLamp &lamp) {
              return std::abs(lamp.centre.x() - u) < 60 + lamp.a &&
                     std::abs(lamp.centre.y() - v) < 6 + lamp.b;
            });
        if (free) {
          rows.lamps.push_back(tube);
        }
      }
    }
    vpLedDetector detector(vpUpwardRig(400, 320), fourLampMap()), alone = detector;
    detector.detect(rows.render());
    alone.detect(lamps.render());
    for (const char *id : {"L2000", "L2600", "L3500"}) {
      ASSERT_NE(find(alone, id), nullptr) << id;
      ASSERT_NE(find(detector, id), nullptr) << id << ", tubes " << apart << " px apart";
      EXPECT_LT((find(detector, id)->point - find(alone, id)->point).norm(), 0.02);
    }
  }
}

TEST(LedDetector, LampsThatPassEachOtherAreSeenOnce)
{
  vpLampPicture passing = fourLampPicture();
  int named = 0;
  for (int step = 0; step < 120; ++step) {
    passing.lamps = {lampAt(180, 150, 2000), lampAt(222 + 0.2 * step, 120 + 0.5 * step, 2600)};
    passing.lamps[0].phase = 0.083 * step;
    passing.lamps[1].phase = 0.047 * step;
    vpLedDetector detector(vpUpwardRig(passing.width, passing.height), fourLampMap());
    detector.detect(passing.render());
    std::vector<std::string> ids;
    for (const vpLampObservation &seen : detector.observations()) {
      if (!seen.id.empty()) {
        ids.push_back(seen.id);
      }
    }
    named += static_cast<int>(ids.size());
    std::sort(ids.begin(), ids.end());
    EXPECT_EQ(std::adjacent_find(ids.begin(), ids.end()), ids.end()) << "step " << step;
  }
  EXPECT_GT(named, 120);
}

TEST(LedDetector, RefusesAPictureOfAnotherSize)
{
  vpLedDetector detector(vpUpwardRig(400, 320), fourLampMap());
  const vpImage<unsigned char> I(320, 402);
  vpExpectError([&] { detector.detect(I); }, {"402 x 320", "400 x 320"});
  vpExpectError([&] { vpLedDetector(vpUpwardRig(0, 0), fourLampMap()); }, {"size"});
}

TEST(LedDetector, DarkWhiteAndTinyPicturesHoldNoKnownLamp)
{
  for (const auto &[width, height] : {std::pair{400u, 320u}, {1u, 1u}, {400u, 1u}, {1u, 320u}}) {
    for (unsigned char grey : {0, 128, 255}) {
      vpLedDetector detector(vpUpwardRig(width, height), fourLampMap());
      detector.detect(vpImage<unsigned char>(height, width, grey));
      for (const vpLampObservation &seen : detector.observations()) {
        EXPECT_TRUE(seen.id.empty()) << width << " x " << height << ", grey " << static_cast<int>(grey);
      }
    }
  }
}
