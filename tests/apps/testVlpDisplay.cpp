/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// What vlp-locate draws beside the picture, and --display where there is no screen.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <gtest/gtest.h>
#include <visp3/vlp_core/vpPoseText.h>

#include "apps/vpLocateScene.h"
#include "common/vpMapPanel.h"
#include "common/vpProcess.h"
#include "common/vpVlpColours.h"
#include "common/vpVlpDashboard.h"
#include "common/vpVlpOverlay.h"

namespace
{
using vpLocateScene::encoded;
using vpLocateScene::with;

const cv::Size size(400, 450);
const double notANumber = std::numeric_limits<double>::quiet_NaN();

vpLamp lampAt(const std::string &id, double x, double y)
{
  vpLamp lamp;
  lamp.id = id;
  lamp.position = {x, y, 2};
  lamp.size = 0.15;
  return lamp;
}

vpLampMap mapOf(const std::vector<Eigen::Vector2d> &places)
{
  vpLampMap map;
  for (const Eigen::Vector2d &place : places) {
    map.lamps.push_back(lampAt("L" + std::to_string(map.lamps.size()), place.x(), place.y()));
  }
  return map;
}

//! Four lamps of a room.
vpLampMap room()
{
  return mapOf({{-1, -1}, {1, -1}, {1, 1}, {-1, 1}});
}

//! A pose that is tracked, with the same sigma (m) for x and y.
vpVlpLocation tracked(double x, double y, double yaw = 0, double sigma = 1e-3)
{
  vpVlpLocation location;
  location.fix.valid = location.tracked = true;
  location.state = vpVlpFilter::State::tracking;
  location.fix.wMb = vpPoseOf(Eigen::Vector3d(x, y, 0), Eigen::Vector3d(0, 0, yaw));
  location.fix.covariance.setIdentity();
  location.fix.covariance *= sigma * sigma;
  return location;
}

vpVlpLocation none()
{
  vpVlpLocation location;
  location.fix.refusal = "a position needs two lamps, none came";
  return location;
}

vpLampObservation observed(const std::string &id, bool accepted)
{
  vpLampObservation lamp;
  lamp.id = id;
  lamp.accepted = accepted;
  return lamp;
}

cv::Vec3b bgr(const cv::Scalar &colour)
{
  return {cv::saturate_cast<uchar>(colour[0]), cv::saturate_cast<uchar>(colour[1]),
          cv::saturate_cast<uchar>(colour[2])};
}

cv::Point rounded(const Eigen::Vector2d &pixel)
{
  return {cvRound(pixel.x()), cvRound(pixel.y())};
}

//! Pixels of a colour, or of its edge against a dark ground.
cv::Mat pixelsOf(const cv::Mat &picture, const cv::Scalar &colour)
{
  cv::Mat mask;
  cv::inRange(picture, 0.6 * colour - cv::Scalar::all(12), colour + cv::Scalar::all(3), mask);
  return mask;
}

//! What the panel draws of its view, without the numbers around it and the legend.
cv::Mat drawn(const vpMapPanel &panel)
{
  const Eigen::AlignedBox2d &view = panel.view();
  return panel.draw(size, 1)(cv::Rect(rounded(panel.pixel({view.min().x(), view.max().y()}, size, 1)),
                                      rounded(panel.pixel({view.max().x(), view.min().y()}, size, 1))));
}

//! Width of what is drawn in white: the ellipse of 3 sigma, where no lamp has a label.
int ellipseWidth(double sigma)
{
  vpMapPanel panel(mapOf({}));
  panel.add(tracked(0, 0, 0, sigma));
  const cv::Mat white = pixelsOf(drawn(panel), vpVlpColours::white);
  return cv::countNonZero(white) == 0 ? 0 : cv::boundingRect(white).width;
}
} // namespace

TEST(MapPanel, RobotIsAtThePixelOfItsPlaceAndPointsAlongItsHeading)
{
  for (const double yaw : {0.0, 2.1, -1.2}) {
    vpMapPanel panel(room());
    panel.add(tracked(0.3, -0.4, yaw));
    const cv::Mat picture = panel.draw(size, 1);
    ASSERT_EQ(picture.size(), size);
    const Eigen::Vector2d at = panel.pixel({0.3, -0.4}, size, 1);
    EXPECT_EQ(picture.at<cv::Vec3b>(rounded(at)), bgr(vpVlpColours::green));
    const Eigen::Vector2d head = at + 16 * Eigen::Vector2d(std::cos(yaw), -std::sin(yaw)); // v goes down
    EXPECT_EQ(picture.at<cv::Vec3b>(rounded(head)), bgr(vpVlpColours::green)) << yaw;
    const Eigen::Vector2d behind = 2 * at - head;
    EXPECT_NE(picture.at<cv::Vec3b>(rounded(behind)), bgr(vpVlpColours::green)) << yaw;
  }
}

TEST(MapPanel, XGoesRightAndYUpAtOneScale)
{
  const vpMapPanel panel(room());
  const Eigen::Vector2d origin = panel.pixel({0, 0}, size, 1);
  const Eigen::Vector2d x = panel.pixel({1, 0}, size, 1) - origin, y = panel.pixel({0, 1}, size, 1) - origin;
  EXPECT_GT(x.x(), 50);
  EXPECT_NEAR(x.y(), 0, 1e-9);
  EXPECT_NEAR(y.x(), 0, 1e-9);
  EXPECT_NEAR(y.y(), -x.x(), 1e-9);
  for (const vpLamp &lamp : room().lamps) {
    const Eigen::Vector2d at = panel.pixel(lamp.position.head<2>(), size, 1);
    EXPECT_TRUE(at.x() > 10 && at.y() > 10 && at.x() < 390 && at.y() < 440) << at.transpose();
  }
}

TEST(MapPanel, LampsOfTheFrameAreBrightWhereTheyHang)
{
  vpMapPanel panel(room());
  vpVlpLocation location = none();
  location.observations = {observed("L0", true), observed("L2", false), observed("", false),
                           observed("of another map", true)};
  panel.add(location);
  const cv::Mat picture = panel.draw(size, 1).rowRange(0, size.height - 40); // without the legend
  const auto expectAt = [&](const cv::Scalar &colour, double x, double y) {
    const cv::Mat bright = pixelsOf(picture, colour);
    ASSERT_GT(cv::countNonZero(bright), 0);
    const cv::Rect box = cv::boundingRect(bright);
    const Eigen::Vector2d at = panel.pixel({x, y}, size, 1);
    EXPECT_NEAR(box.x + 0.5 * (box.width - 1), at.x(), 1.5);
    EXPECT_NEAR(box.y + 0.5 * (box.height - 1), at.y(), 1.5);
    const double metre = panel.pixel({1, 0}, size, 1).x() - panel.pixel({0, 0}, size, 1).x();
    EXPECT_NEAR(box.width, 0.15 * metre, 3); // as large as it is
  };
  expectAt(vpVlpColours::green, -1, -1);
  expectAt(vpVlpColours::yellow, 1, 1);
  panel.add(none());
  EXPECT_EQ(cv::countNonZero(pixelsOf(drawn(panel), vpVlpColours::green)), 0);
}

TEST(MapPanel, EllipseGrowsWithTheCovariance)
{
  // A map without lamps shows a metre or a little more on 350 px or less.
  const int small = ellipseWidth(0.01), large = ellipseWidth(0.04);
  EXPECT_GT(small, 10);
  EXPECT_NEAR(large, 4 * small, 8);
}

TEST(MapPanel, EllipseThatIsNoneIsLeftOutAndTheRobotStays)
{
  for (const double variance : {notANumber, std::numeric_limits<double>::infinity(), -1.0, 1e300}) {
    vpMapPanel panel(mapOf({}));
    vpVlpLocation location = tracked(0.2, 0.1);
    location.fix.covariance.setConstant(0);
    location.fix.covariance(0, 0) = variance;
    panel.add(location);
    const cv::Mat picture = panel.draw(size, 1);
    EXPECT_EQ(picture.at<cv::Vec3b>(rounded(panel.pixel({0.2, 0.1}, size, 1))), bgr(vpVlpColours::green));
    EXPECT_EQ(cv::countNonZero(pixelsOf(drawn(panel), vpVlpColours::white)), 0) << variance;
  }
}

TEST(MapPanel, EveryMapAndPoseGivesAPicture)
{
  const std::vector<vpLampMap> maps = {mapOf({}), mapOf({{3, 4}}), mapOf({{3, 4}, {3, 4}}),
                                       mapOf({{notANumber, 0}, {1e300, 0}, {1, 2}}),
                                       mapOf({{-1e6, 0}, {1e6, 0}})};
  std::vector<vpVlpLocation> locations = {
      none(),           tracked(0, 0), tracked(notANumber, 0), tracked(0, 0, notANumber), tracked(1e5, -3e6),
      tracked(1e200, 0)};
  locations.push_back(tracked(1, 1));
  locations.back().fix.ambiguous = true;
  locations.back().fix.other = tracked(1e9, 2).fix.wMb;
  for (const vpLampMap &map : maps) {
    vpMapPanel panel(map);
    EXPECT_FALSE(panel.draw(size, 1).empty()); // no frame yet
    for (const vpVlpLocation &location : locations) {
      panel.add(location);
      for (const cv::Size each : {size, cv::Size(400, 60), cv::Size(3, 3), cv::Size(40, 900)}) {
        EXPECT_EQ(panel.draw(each, 1).size(), each);
      }
    }
  }
}

TEST(MapPanel, RobotIsInViewWhereverItGoes)
{
  for (const vpLampMap &map : {room(), mapOf({}), mapOf({{3, 4}})}) {
    vpMapPanel panel(map);
    for (int i = 0; i < 400; ++i) {
      const Eigen::Vector2d place(0.05 * i, 3 * std::sin(0.1 * i));
      panel.add(tracked(place.x(), place.y()));
      ASSERT_TRUE(panel.view().contains(place)) << i;
      for (const vpLamp &lamp : map.lamps) {
        ASSERT_TRUE(panel.view().contains(Eigen::Vector2d(lamp.position.head<2>()))) << i;
      }
    }
    const double far = panel.view().sizes().maxCoeff();
    panel.add(tracked(0.1, 0.1)); // it was a wrong pose, say
    EXPECT_LT(panel.view().sizes().maxCoeff(), far);
  }
}

TEST(MapPanel, ViewStaysWhileTheRobotIsInIt)
{
  vpMapPanel panel(room());
  panel.add(tracked(0, 0));
  const Eigen::AlignedBox2d view = panel.view();
  for (int i = 0; i < 50; ++i) {
    panel.add(tracked(std::cos(0.3 * i), 0.9 * std::sin(0.2 * i)));
    EXPECT_TRUE(panel.view().isApprox(view));
  }
}

TEST(MapPanel, OfAGreatMapWhatIsNearIsShown)
{
  std::vector<Eigen::Vector2d> places;
  for (int i = 0; i < 10000; ++i) {
    places.emplace_back(2 * (i % 100), 2 * (i / 100));
  }
  vpMapPanel panel(mapOf(places));
  EXPECT_TRUE(panel.view().contains(Eigen::AlignedBox2d(places.front(), places.back()))); // no pose yet
  EXPECT_FALSE(panel.draw(size, 1).empty());
  vpVlpLocation location = tracked(101, 57);
  location.observations = {observed("L2850", true)}; // at 100, 56
  panel.add(location);
  EXPECT_TRUE(panel.view().contains(Eigen::Vector2d(101, 57)));
  const auto inView = std::count_if(places.begin(), places.end(), [&](const Eigen::Vector2d &place) {
    return panel.view().contains(place);
  });
  EXPECT_GT(inView, 20);
  EXPECT_LT(inView, 150);
  EXPECT_GT(cv::countNonZero(pixelsOf(drawn(panel), vpVlpColours::green)), 100);
}

TEST(MapPanel, TrailIsBoundedAndInTheColourOfItsStates)
{
  vpMapPanel panel(room());
  panel.longestTrail = 10;
  for (int i = 0; i < 30; ++i) {
    vpVlpLocation location = tracked(-0.9 + 0.06 * i, 0.5);
    location.state = i < 25 ? vpVlpFilter::State::coasting : vpVlpFilter::State::tracking;
    panel.add(location);
  }
  const cv::Mat picture = panel.draw(size, 1);
  const auto near = [&](int i, const cv::Scalar &colour) {
    cv::Mat mask = pixelsOf(picture, 0.75 * colour);
    const cv::Point at = rounded(panel.pixel({-0.9 + 0.06 * i, 0.5}, size, 1));
    return cv::countNonZero(mask(cv::Rect(at.x - 1, at.y - 2, 3, 5))) > 0;
  };
  EXPECT_TRUE(near(23, vpVlpColours::ofState("coasting")));
  EXPECT_TRUE(near(27, vpVlpColours::ofState("tracking")));
  EXPECT_FALSE(near(15, vpVlpColours::ofState("coasting"))); // forgotten
}

TEST(MapPanel, PathAndTruthAreDrawnAndStayInView)
{
  vpMapPanel panel(room());
  panel.setPath({{-1.5, 0.5}, {1.5, 0.5}});
  panel.setTruth(vpPoseOf(Eigen::Vector3d(-0.5, -0.3, 0), Eigen::Vector3d::Zero()));
  panel.add(tracked(0.3, -0.4, 0.5));
  const cv::Mat picture = panel.draw(size, 1);
  for (const double x : {-1.4, 1.4}) {
    const cv::Mat around =
        picture(cv::Rect(rounded(panel.pixel({x, 0.5}, size, 1)) - cv::Point(2, 2), cv::Size(5, 5)));
    EXPECT_GT(cv::countNonZero(pixelsOf(around, vpVlpColours::grey)), 3) << x;
  }
  const cv::Mat cross =
      picture(cv::Rect(rounded(panel.pixel({-0.5, -0.3}, size, 1)) - cv::Point(10, 10), cv::Size(21, 21)));
  EXPECT_GT(cv::countNonZero(pixelsOf(cross, vpVlpColours::white)), 20);
  panel.add(tracked(6, 0));
  EXPECT_TRUE(panel.view().contains(Eigen::Vector2d(-1.5, 0.5)));
}

TEST(VlpDashboard, PictureStandsUntouchedBesideTheMap)
{
  const cv::Mat grey = vpLocateScene::picture();
  vpImage<unsigned char> I(480, 640);
  std::copy(grey.data, grey.data + grey.total(), I.bitmap);
  vpVlpDashboard dashboard(room());
  cv::Size before;
  for (vpVlpLocation location :
       {none(), tracked(0, 0), tracked(notANumber, notANumber, notANumber, notANumber), tracked(90, 0)}) {
    location.searched = {vpRect(10, 20, 100, 60), vpRect(-50, 300, 1000, 1000)};
    const cv::Mat all = dashboard.draw(I, location, 0.012), picture = vpDrawVlpOverlay(I, location);
    const cv::Mat part = all(cv::Rect(cv::Point(), picture.size()));
    EXPECT_EQ(cv::norm(part, picture, cv::NORM_INF), 0);
    EXPECT_GT(all.cols, picture.cols + 400);
    EXPECT_TRUE(before.empty() || all.size() == before);
    before = all.size();
  }
}

TEST(VlpDashboard, SearchedWindowsAreDrawn)
{
  const vpImage<unsigned char> I(480, 640, 0);
  vpVlpLocation location = none();
  const auto blue = [&] { return pixelsOf(vpDrawVlpOverlay(I, location), vpVlpColours::blue); };
  EXPECT_EQ(cv::countNonZero(blue()), 0);
  location.searched = {vpRect(100, 60, 200, 150)};
  const cv::Rect box = cv::boundingRect(blue()); // the frame is twice as large in the picture
  EXPECT_NEAR(box.x, 200, 2);
  EXPECT_NEAR(box.y, 120, 2);
  EXPECT_NEAR(box.width, 400, 4);
  EXPECT_NEAR(box.height, 300, 4);
}

TEST(VlpDisplay, WithoutAScreenTheRestIsDoneAllTheSame)
{
  const vpTemporaryFolder folder;
  const auto rig = vpLocateScene::writeRig(folder);
  const std::string picture = folder.write("a.png", encoded(".png", vpLocateScene::picture()));
  const char *const kept = std::getenv("DISPLAY");
  const std::string before = kept == nullptr ? "" : kept;
  vpProcess plain("vlp-locate", with(rig, {"--image", picture}));
  EXPECT_EQ(plain.wait(), 0);
  for (const std::string name : {"", ":987"}) {
    name.empty() ? unsetenv("DISPLAY") : setenv("DISPLAY", name.c_str(), 1);
    vpProcess locate("vlp-locate", with(rig, {"--image", picture, "--display"}));
    EXPECT_EQ(locate.wait(), 0) << locate.err();
    EXPECT_EQ(locate.out(), plain.out()); // as if it had not been asked for
    const std::string said = locate.err(), plainSaid = plain.err();
    EXPECT_EQ(said.rfind("vlp-locate: warning: --display: ", 0), 0u) << said;
    EXPECT_NE(said.find(name.empty() ? "DISPLAY is not set" : name), std::string::npos) << said;
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'),
              1 + std::count(plainSaid.begin(), plainSaid.end(), '\n'))
        << said;

    vpProcess files("vlp-locate",
                    with(rig, {"--image", picture, "--display", "--poses", folder / "poses.tum"}));
    EXPECT_EQ(files.wait(), 0) << files.err();
    EXPECT_EQ(folder.read("poses.tum"), plain.out());
  }
  kept == nullptr ? unsetenv("DISPLAY") : setenv("DISPLAY", before.c_str(), 1);
}
