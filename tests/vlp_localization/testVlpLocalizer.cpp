/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// From a picture to a pose: right where the lamps allow it, a refusal where they do not.

#include <algorithm>

#include <Eigen/LU>
#include <gtest/gtest.h>
#include <visp3/vlp_localization/vpVlpLocalizer.h>

#include "hungLamps.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{

//! Four lamps, and a robot that stands below them.
struct Room {
  double x = 0.1, y = -0.05, yaw = 0.6; // m, rad
  hungLamps::Camera camera = {640, 480, 600};
  std::vector<hungLamps::Hung> lamps = hungLamps::rectangle(0.4, 0.3);
  vpLampMap map = hungLamps::mapOf(lamps);

  vpVlpRig rig() const { return camera.rig(); }

  vpVlpFrame frame(unsigned int seed = 1) const
  {
    const hungLamps::Place place = {x, y, yaw};
    return camera.frame(
        lamps, 12.5, [&](double) { return place; }, 0.37 * seed, seed);
  }

  vpVlpLocation locate(vpVlpLocalizer::Solver solver = vpVlpLocalizer::Solver::all) const
  {
    vpVlpLocalizer localizer(rig(), map);
    localizer.solver = solver;
    return localizer.process(frame());
  }

  double error(const vpVlpFix &fix) const { return std::hypot(fix.wMb[0][3] - x, fix.wMb[1][3] - y); }
};

const vpLampObservation *find(const vpVlpLocation &location, const std::string &id)
{
  const auto found = std::find_if(location.observations.begin(), location.observations.end(),
                                  [&](const vpLampObservation &lamp) { return lamp.id == id; });
  return found == location.observations.end() ? nullptr : &*found;
}

TEST(VlpLocalizer, MillimetreFromAllLampsWithinItsCovariance)
{
  const Room room;
  vpVlpLocalizer localizer(room.rig(), room.map);
  localizer.tracking = false; // frames of one time
  double worst = 0, nees = 0;
  const int frames = 20;
  for (int seed = 1; seed <= frames; ++seed) {
    const vpVlpLocation location = localizer.process(room.frame(static_cast<unsigned int>(seed)));
    const vpVlpFix &fix = location.fix;
    ASSERT_TRUE(fix.valid) << fix.refusal;
    EXPECT_EQ(location.timestamp, 12.5);
    EXPECT_EQ(fix.lamps.size(), 4u);
    for (const vpLampObservation &lamp : location.observations) {
      EXPECT_TRUE(lamp.accepted) << lamp.id << ": " << lamp.remark << ", " << lamp.features.frequency
                                 << " +- " << lamp.features.frequencySigma << " Hz at "
                                 << lamp.point.transpose();
    }
    worst = std::max(worst, room.error(fix));
    const Eigen::Vector2d e(fix.wMb[0][3] - room.x, fix.wMb[1][3] - room.y);
    nees += e.dot(fix.covariance.topLeftCorner<2, 2>().inverse() * e) / frames;
    EXPECT_NEAR(std::atan2(fix.wMb[1][0], fix.wMb[0][0]), room.yaw, 0.001);
  }
  EXPECT_LT(worst, 0.0005);
  EXPECT_LT(nees, 4); // 2 expected; 99.9 % of the means of 20 lie below 3.6
}

// Whoever has seen the lamps, the pose is the same, also of observations that have been through it before.
TEST(VlpLocalizer, LampsThatAreSeenAlreadyGiveThePoseOfTheirPicture)
{
  const Room room;
  vpVlpLocalizer ofPictures(room.rig(), room.map), ofLamps(room.rig(), room.map);
  for (unsigned int k = 1; k <= 4; ++k) {
    vpVlpFrame frame = room.frame(k);
    frame.timestamp = 0.1 * k;
    const vpVlpLocation seen = ofPictures.process(frame),
                        located = ofLamps.locate(frame.timestamp, seen.observations);
    ASSERT_TRUE(located.fix.valid) << k << ": " << located.fix.refusal;
    EXPECT_EQ(located.fix.lamps, seen.fix.lamps) << k;
    EXPECT_EQ(located.tracked, k > 1) << k;
    for (unsigned int i = 0; i < 3; ++i) {
      EXPECT_NEAR(located.fix.wMb[i][3], seen.fix.wMb[i][3], 1e-12) << k;
    }
  }
  EXPECT_FALSE(ofLamps.locate(0.4, {}).fix.valid) << "not later than the one before";
}

TEST(VlpLocalizer, TwoSolverUsesTwoLamps)
{
  const Room room;
  const vpVlpLocation location = room.locate(vpVlpLocalizer::Solver::two);
  ASSERT_TRUE(location.fix.valid) << location.fix.refusal;
  EXPECT_EQ(location.fix.lamps.size(), 2u);
  EXPECT_LT(room.error(location.fix), 0.001);
  EXPECT_EQ(std::count_if(location.observations.begin(), location.observations.end(),
                          [](const vpLampObservation &lamp) { return lamp.accepted; }),
            2);
}

TEST(VlpLocalizer, LampThatHangsElsewhereIsLeftOut)
{
  for (const double elsewhere : {0.01, 0.05, 0.4}) { // m
    Room room;
    room.map.lamps[1].position.x() += elsewhere; // the map is wrong about B
    const vpVlpLocation location = room.locate();
    ASSERT_TRUE(location.fix.valid) << location.fix.refusal;
    EXPECT_LT(room.error(location.fix), 0.001) << elsewhere;
    ASSERT_NE(find(location, "B"), nullptr);
    EXPECT_FALSE(find(location, "B")->accepted) << elsewhere;
    EXPECT_FALSE(find(location, "B")->remark.empty());
  }
}

// What lies within the sigma that the map states for its lamps is no contradiction.
TEST(VlpLocalizer, LampWithinItsStatedSigmaCounts)
{
  Room room;
  room.map.lamps[1].position.x() += 0.02;
  for (vpLamp &lamp : room.map.lamps)
    lamp.positionSigma = 0.01;
  const vpVlpLocation location = room.locate();
  ASSERT_TRUE(location.fix.valid) << location.fix.refusal;
  EXPECT_EQ(location.fix.lamps.size(), 4u);
}

TEST(VlpLocalizer, ThreeLampsThatDisagreeGiveNoPosition)
{
  Room room;
  room.lamps.pop_back();
  room.map.lamps[1].position.x() += 0.4;
  const vpVlpLocation location = room.locate();
  EXPECT_FALSE(location.fix.valid);
  EXPECT_NE(location.fix.refusal.find("do not agree"), std::string::npos) << location.fix.refusal;
}

TEST(VlpLocalizer, TwoLampsOfWrongSizeGiveNoPosition)
{
  Room room;
  room.lamps.resize(2);
  room.map.lamps[1].position.x() +=
      0.8; // so the height would come out double, and the lamps too small for it
  const vpVlpLocation location = room.locate();
  EXPECT_FALSE(location.fix.valid) << room.error(location.fix);
  EXPECT_NE(location.fix.refusal.find("by its size in the map"), std::string::npos) << location.fix.refusal;
}

TEST(VlpLocalizer, LampOfWrongSizeAmongOthersIsLeftOut)
{
  for (const size_t seen : {3u, 4u}) {
    Room room;
    room.lamps.resize(seen);
    room.map.lamps[1].size *= 2; // or what is taken for B is something else
    const vpVlpLocation location = room.locate();
    ASSERT_TRUE(location.fix.valid) << location.fix.refusal;
    EXPECT_EQ(location.fix.lamps.size(), seen - 1);
    EXPECT_LT(room.error(location.fix), 0.001);
    ASSERT_NE(find(location, "B"), nullptr);
    EXPECT_FALSE(find(location, "B")->accepted);
  }
}

TEST(VlpLocalizer, HalfOfTheLampsOfWrongSizeGiveNoPosition)
{
  Room room;
  room.map.lamps[1].size *= 2;
  room.map.lamps[2].size *= 2;
  EXPECT_FALSE(room.locate().fix.valid);
}

TEST(VlpLocalizer, LampsOfAWideLensAreAsSmallAsItShowsThem)
{
  Room room;
  room.x = room.y = room.yaw = 0;
  room.camera = {1280, 960, 600};
  room.lamps = {{"A", {-1.6, 0, 1.6}, 1800},
                {"B", {0, -1, 1.6}, 2300},
                {"C", {1.6, 0, 1.6}, 2900},
                {"D", {0, 1, 1.6}, 3600}};
  room.map = hungLamps::mapOf(room.lamps);
  vpVlpRig rig = room.rig();
  rig.camera.initProjWithKannalaBrandtDistortion(600, 600, room.camera.u0(), room.camera.v0(),
                                                 {0, 0, 0, 0}); // by the angle
  vpLampPicture picture;
  picture.width = room.camera.width;
  picture.height = room.camera.height;
  picture.rowTime = picture.exposure = rig.shutter.rowTime;
  for (const hungLamps::Hung &hung : room.lamps) {
    const Eigen::Vector2d way = hung.position.head<2>() / hung.position.z();
    const double tangent = way.norm(), half = 0.08 / hung.position.z();
    const double near = 600 * std::atan(tangent - half), far = 600 * std::atan(tangent + half);
    const double outwards = 0.5 * (far - near), around = 600 * std::atan(tangent) / tangent * half;
    vpPaintedLamp lamp;
    lamp.centre = Eigen::Vector2d(room.camera.u0(), room.camera.v0()) + 0.5 * (near + far) * way.normalized();
    lamp.a = way.y() == 0 ? outwards : around;
    lamp.b = way.y() == 0 ? around : outwards;
    lamp.frequency = hung.frequency;
    lamp.pwm(0.5);
    picture.lamps.push_back(lamp);
  }
  const vpVlpLocation location = vpVlpLocalizer(rig, room.map).process({picture.render(), 0, ""});
  ASSERT_TRUE(location.fix.valid) << location.fix.refusal;
  EXPECT_EQ(location.fix.lamps.size(), 4u);
  EXPECT_LT(room.error(location.fix), 0.001);
}

TEST(VlpLocalizer, ReflectionIsToldFromItsLampByItsPlace)
{
  Room room;
  room.lamps.push_back({"reflection of A", {0, 0, 1.6}, room.lamps[0].frequency});
  const vpVlpLocation location = room.locate();
  ASSERT_TRUE(location.fix.valid) << location.fix.refusal;
  EXPECT_EQ(location.fix.lamps.size(), 4u);
  EXPECT_LT(room.error(location.fix), 0.001);
  int refused = 0;
  for (const vpLampObservation &lamp : location.observations) {
    if (!lamp.accepted) {
      ++refused;
      EXPECT_EQ(lamp.remark, "a reflection of lamp A, or another lamp that blinks alike");
      EXPECT_LT((lamp.point - Eigen::Vector2d(319.5, 239.5)).norm(), 60); // where (0, 0) is seen
    }
  }
  EXPECT_EQ(refused, 1);
}

TEST(VlpLocalizer, LampAndReflectionThatFitAlikeCountForNeither)
{
  Room room;
  room.lamps.erase(room.lamps.begin() + 2); // A, B and D, and A once more: as far from B and D as the lamp
  room.lamps.pop_back();
  room.lamps.push_back({"reflection of A", {0.4, 0.5, 1.6}, room.lamps[0].frequency});
  const vpVlpLocation location = room.locate(); // A and B, or the reflection and B
  EXPECT_FALSE(location.fix.valid);
  EXPECT_NE(location.fix.refusal.find("2 places"), std::string::npos) << location.fix.refusal;
  for (const vpLampObservation &lamp : location.observations) {
    EXPECT_FALSE(lamp.accepted);
    EXPECT_FALSE(lamp.remark.empty());
  }
}

//! The pose of the frame before decides between two places for a robot that is followed, and only then.
TEST(VlpLocalizer, FramesByThemselvesTakeNoHint)
{
  Room room;
  Room alike = room;
  alike.lamps.erase(alike.lamps.begin() + 2);
  alike.lamps.pop_back();
  alike.lamps.push_back({"reflection of A", {0.4, 0.5, 1.6}, alike.lamps[0].frequency});
  vpVlpLocalizer localizer(room.rig(), room.map);
  localizer.tracking = false;
  ASSERT_TRUE(localizer.process(room.frame()).fix.valid);
  const vpVlpLocation location = localizer.process(alike.frame());
  EXPECT_FALSE(location.fix.valid);
  EXPECT_NE(location.fix.refusal.find("2 places"), std::string::npos) << location.fix.refusal;
}

TEST(VlpLocalizer, FreeAttitudeLeavesOutAnIdSeenTwice)
{
  Room room;
  room.lamps.push_back({"reflection of A", {0, 0, 1.6}, room.lamps[0].frequency});
  vpVlpLocalizer localizer(room.rig(), room.map);
  localizer.manyLamps.attitude = vpManyLampSolver::Attitude::free;
  const vpVlpLocation location = localizer.process(room.frame());
  for (const vpLampObservation &lamp : location.observations) {
    EXPECT_FALSE(lamp.accepted && lamp.id == "A");
    if (lamp.id == "A") {
      EXPECT_NE(lamp.remark.find("2 times"), std::string::npos);
    }
  }
}

TEST(VlpLocalizer, LastPoseIsNoMoreThanAHint)
{
  Room room;
  room.lamps.push_back({"reflection of A", {0, 0, 1.6}, room.lamps[0].frequency});
  vpVlpLocalizer localizer(room.rig(), room.map);
  localizer.tracking = false;
  ASSERT_TRUE(localizer.process(room.frame()).fix.valid);
  room.x = 0.25;
  room.y = 0.1;
  room.yaw = -2;
  const vpVlpLocation carried = localizer.process(room.frame());
  ASSERT_TRUE(carried.fix.valid) << carried.fix.refusal;
  EXPECT_LT(room.error(carried.fix), 0.001);
}

TEST(VlpLocalizer, NoLampOrOneLampIsARefusalInOneLine)
{
  Room room;
  room.lamps.resize(1);
  EXPECT_NE(room.locate().fix.refusal.find("one lamp"), std::string::npos);
  room.lamps.clear();
  const vpVlpLocation nothing = room.locate();
  EXPECT_FALSE(nothing.fix.valid);
  EXPECT_NE(nothing.fix.refusal.find("no lamp"), std::string::npos);
  EXPECT_TRUE(nothing.observations.empty());
}

TEST(VlpLocalizer, LampsThatTheMapDoesNotHaveDoNotCount)
{
  const Room room;
  std::vector<vpLampObservation> observations = room.locate().observations;
  observations[0].id = "nobody";
  vpVlpLocalizer localizer(room.rig(), room.map);
  const vpVlpFix fix = localizer.locate(12.5, observations).fix;
  ASSERT_TRUE(fix.valid) << fix.refusal;
  EXPECT_EQ(fix.lamps.size(), 3u);
  EXPECT_LT(room.error(fix), 0.001);
}

TEST(VlpLocalizer, SteadyLampsAreSeenAndDoNotCount)
{
  Room room;
  room.lamps[0].frequency = 0;
  const vpVlpLocation location = room.locate();
  ASSERT_TRUE(location.fix.valid) << location.fix.refusal;
  EXPECT_EQ(location.observations.size(), 4u);
  EXPECT_EQ(location.fix.lamps.size(), 3u);
  EXPECT_LT(room.error(location.fix), 0.001);
}

TEST(VlpLocalizer, RegionsWithoutIdSayWhy)
{
  Room room;
  room.lamps[2].frequency = 4800;
  const vpVlpLocation location = room.locate();
  for (const vpLampObservation &lamp : location.observations) {
    EXPECT_EQ(lamp.id.empty(), !lamp.accepted);
    EXPECT_EQ(lamp.remark.empty(), lamp.accepted);
  }
}

} // namespace
