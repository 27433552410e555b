/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// What the overlay shows of a lamp that blinks and has no id.

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include "apps/vpLocateScene.h"
#include "common/vpLampChart.h"
#include "common/vpProcess.h"
#include "common/vpVlpColours.h"
#include "common/vpVlpOverlay.h"

namespace
{
using vpLocateScene::Lamp;

const double trueExposure = 43.1e-6; // s

vpVlpRig rigOf(double exposure)
{
  vpVlpRig rig;
  rig.width = 640;
  rig.height = 480;
  rig.camera.initPersProjWithoutDistortion(vpLocateScene::focal, vpLocateScene::focal, vpLocateScene::u0,
                                           vpLocateScene::v0);
  rig.shutter.rowTime = 43.1e-6;
  rig.shutter.rowTimeSigma = 2e-9;
  rig.shutter.exposure = rig.shutter.exposureSigma = exposure; // a factor of two
  rig.bMc = vpLocateScene::bMc;
  return rig;
}

vpLampMap mapOfLamps(const std::vector<Lamp> &lamps)
{
  vpLampMap map;
  for (const Lamp &lamp : lamps) {
    vpLamp known;
    known.id = lamp.id;
    known.position = {lamp.x, lamp.y, lamp.z};
    known.size = vpLocateScene::diameter;
    known.modulation.kind = vpModulation::Kind::pwm;
    known.modulation.frequency = lamp.frequency;
    known.modulation.duty = 0.5;
    map.lamps.push_back(known);
  }
  return map;
}

//! The map of the scene's lamps, the last of which it says to blink faster by 5 %.
std::vector<Lamp> lastOneWrong()
{
  std::vector<Lamp> lamps = vpLocateScene::lamps;
  lamps.back().frequency *= 1.05;
  return lamps;
}

vpImage<unsigned char> imageOf(const cv::Mat &grey)
{
  vpImage<unsigned char> I(static_cast<unsigned int>(grey.rows), static_cast<unsigned int>(grey.cols));
  std::copy(grey.data, grey.data + grey.total(), I.bitmap);
  return I;
}

//! Pixels of the colour that the fitted wave alone has, or of its edge against a dark ground.
int violetPixels(const cv::Mat &picture)
{
  const cv::Scalar &violet = vpVlpColours::violet;
  cv::Mat mask;
  cv::inRange(picture, 0.6 * violet - cv::Scalar::all(12), violet + cv::Scalar::all(3), mask);
  return cv::countNonZero(mask);
}

struct Seen {
  std::vector<vpLampObservation> observations;
  std::vector<vpLampChart> charts;
  cv::Mat overlay;

  Seen(const vpImage<unsigned char> &I, const vpVlpRig &rig, const vpLampMap &map)
  {
    vpLedDetector detector(rig, map);
    detector.detect(I);
    observations = detector.observations();
    charts = vpLampChartsOf(I, observations, detector);
    vpVlpLocation location;
    location.observations = observations;
    overlay = vpDrawVlpOverlay(I, location, charts);
  }
};

//! The first number behind a word.
double numberBehind(const std::string &word, const std::string &text)
{
  const size_t at = text.find(word);
  return at == std::string::npos ? NAN : std::strtod(text.c_str() + at + word.size(), nullptr);
}
} // namespace

TEST(LampChart, IsOfTheLampWithoutIdAndOfNoOther)
{
  const vpImage<unsigned char> I = imageOf(vpLocateScene::picture());
  const Seen all(I, rigOf(trueExposure), mapOfLamps(vpLocateScene::lamps));
  EXPECT_EQ(all.observations.size(), 3u);
  EXPECT_TRUE(all.charts.empty());
  EXPECT_EQ(violetPixels(all.overlay), 0);

  const Seen wrong(I, rigOf(trueExposure), mapOfLamps(lastOneWrong()));
  ASSERT_EQ(wrong.charts.size(), 1u);
  EXPECT_EQ(wrong.observations[wrong.charts[0].lamp].id, "");
  EXPECT_NEAR(wrong.observations[wrong.charts[0].lamp].features.frequency, 4100, 10);
  EXPECT_EQ(std::count_if(wrong.observations.begin(), wrong.observations.end(),
                          [](const vpLampObservation &lamp) { return lamp.id.empty(); }),
            1);
  EXPECT_GT(violetPixels(wrong.overlay), 100);
  EXPECT_EQ(wrong.overlay.size(), all.overlay.size());
}

TEST(LampChart, WaveLiesOnTheLight)
{
  const Seen seen(imageOf(vpLocateScene::picture()), rigOf(trueExposure), mapOfLamps(lastOneWrong()));
  ASSERT_EQ(seen.charts.size(), 1u);
  const vpLampChart &chart = seen.charts[0];
  ASSERT_GT(chart.light.size(), 30u);
  ASSERT_EQ(chart.time.size(), chart.light.size());
  ASSERT_EQ(chart.fitted.size(), chart.light.size());
  double square = 0;
  for (size_t i = 0; i < chart.light.size(); ++i) {
    square += (chart.light[i] - chart.fitted[i]) * (chart.light[i] - chart.fitted[i]);
  }
  const double most = *std::max_element(chart.light.begin(), chart.light.end());
  EXPECT_LT(std::sqrt(square / static_cast<double>(chart.light.size())), 0.05 * most);
}

TEST(LampChart, SaysTheExposureThatTheRigClaimsAndTheOneThatTheStripesShow)
{
  const Seen seen(imageOf(vpLocateScene::picture()), rigOf(4 * trueExposure), mapOfLamps(lastOneWrong()));
  ASSERT_EQ(seen.charts.size(), 1u);
  const std::vector<std::string> &caption = seen.charts[0].caption;
  ASSERT_EQ(caption.size(), 2u);
  EXPECT_NEAR(numberBehind("rig says ", caption[0]), 4e6 * trueExposure, 1) << caption[0];
  EXPECT_NEAR(numberBehind("stripes say ", caption[1]), 1e6 * trueExposure, 10) << caption[1];
}

TEST(LampChart, ThreeLargestOnly)
{
  std::vector<Lamp> lamps = vpLocateScene::lamps;
  lamps.push_back({"D", -0.3, 0.25, 1.2, 2500}); // nearer, so larger
  const vpImage<unsigned char> I = imageOf(vpLocateScene::picture(vpLocateScene::robot(0, 0, 0), lamps));
  const Seen seen(I, rigOf(trueExposure), mapOfLamps({{"E", 0, 0, 1.6, 700}})); // slower than these
  ASSERT_EQ(seen.observations.size(), 4u);
  ASSERT_EQ(seen.charts.size(), 3u);
  EXPECT_NEAR(seen.observations[seen.charts[0].lamp].features.frequency, 2500, 10);
}

TEST(LampChart, ARegionWithoutAnythingToShowHasNone)
{
  const vpImage<unsigned char> I = imageOf(vpLocateScene::picture());
  const vpLedDetector detector(rigOf(trueExposure), mapOfLamps(vpLocateScene::lamps));
  vpLampObservation steady, outside, nowhere;
  outside.features.signal = nowhere.features.signal = vpStripeFeatures::Signal::coded;
  outside.outline.shape = nowhere.outline.shape = vpLampOutline::Shape::ellipse;
  outside.outline.centre = {-1e6, 200};
  nowhere.outline.centre = {NAN, NAN};
  outside.outline.a = outside.outline.b = nowhere.outline.a = nowhere.outline.b = 30;
  EXPECT_TRUE(vpLampChartsOf(I, {steady, outside, nowhere}, detector).empty());
  EXPECT_FALSE(vpLampChart().draw(1).empty());
}

TEST(LampChart, VlpLocateDrawsIt)
{
  const vpTemporaryFolder folder;
  auto rig = vpLocateScene::writeRig(folder);
  const std::string picture = folder.write("a.png", vpLocateScene::encoded(".png", vpLocateScene::picture()));
  const auto violet = [&](const std::string &out) {
    vpProcess locate("vlp-locate", vpLocateScene::with(rig, {"--image", picture, "--overlay", folder / out}));
    EXPECT_EQ(locate.wait(), 0) << locate.err();
    const cv::Mat all = cv::imread(folder / out + "/000000-a.png", cv::IMREAD_COLOR);
    return all.empty() ? -1 : violetPixels(all(cv::Rect(0, 0, 1280, 960))); // without the map
  };
  EXPECT_EQ(violet("known"), 0);
  folder.write("lamps.yaml", vpLocateScene::lampsText(lastOneWrong()));
  EXPECT_GT(violet("unknown"), 100);
}
