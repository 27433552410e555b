/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// A hall whose lamps share few identifiers, from picture to pose: right from cold, a refusal where two rooms
// look the same, and no mirrored lamp taken for one of the map.

#include <set>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <visp3/vlp_core/vpCsvTable.h>
#include <visp3/vlp_evaluation/vpFixLog.h>

#include "apps/vpReuseHall.h"
#include "common/vpProcess.h"

namespace
{
const double near = 3; // px, of a lamp's middle

//! Of the map's lamp whose middle is there, to within \e reach (px); empty where there is none.
std::string idAt(const vpReuseHall &hall, const Eigen::Vector2d &pixel, const vpHomogeneousMatrix &wMb,
                 double reach = near)
{
  for (const vpLamp &lamp : hall.map.lamps) {
    if ((hall.pixelOf(lamp.position, wMb) - pixel).norm() < reach) {
      return lamp.id;
    }
  }
  return "";
}

double headingOf(const vpHomogeneousMatrix &wMb)
{
  return std::atan2(wMb[1][0], wMb[0][0]);
}

void expectPose(const vpVlpFix &fix, const vpHomogeneousMatrix &wMb)
{
  ASSERT_TRUE(fix.valid) << fix.refusal;
  EXPECT_FALSE(fix.ambiguous);
  EXPECT_NEAR(fix.wMb[0][3], wMb[0][3], 0.005);
  EXPECT_NEAR(fix.wMb[1][3], wMb[1][3], 0.005);
  EXPECT_NEAR(std::remainder(headingOf(fix.wMb) - headingOf(wMb), 2 * M_PI), 0, 0.003);
}

//! Lamps that are seen whole.
struct Whole {
  size_t seen = 0, accepted = 0;
};

//! No region has the id of another lamp; those of lamps seen whole count.
void expectNames(const vpReuseHall &hall, const vpVlpLocation &location, const vpHomogeneousMatrix &wMb,
                 Whole &whole)
{
  std::set<std::string> accepted;
  for (const vpLampObservation &lamp : location.observations) {
    if (!lamp.id.empty()) {
      const double reach = near + 3 * std::sqrt(lamp.covariance.trace()); // px, where the border cuts it
      EXPECT_EQ(lamp.id, idAt(hall, lamp.point, wMb, reach)) << lamp.remark;
    }
    if (lamp.accepted) {
      accepted.insert(lamp.id);
    }
  }
  for (const vpLamp &lamp : hall.map.lamps) {
    if (hall.shows(lamp.position, wMb)) {
      ++whole.seen;
      whole.accepted += accepted.count(lamp.id);
    }
  }
}
} // namespace

TEST(IdentifierReuse, ColdStartsAreRight)
{
  vpReuseHall hall(8, 8, 16, 3);
  ASSERT_EQ(hall.map.identifiers().size(), 16u);
  Whole whole;
  for (int place = 0; place < 20;) {
    const vpHomogeneousMatrix wMb = hall.randomPose(0, 10.5, 0, 10.5);
    if (hall.inView(wMb) < 3) {
      continue;
    }
    SCOPED_TRACE(testing::Message() << "place " << place << ": " << wMb[0][3] << ", " << wMb[1][3] << ", "
                                    << headingOf(wMb) << " rad");
    vpVlpLocalizer localizer(hall.rig, hall.map);
    const vpVlpLocation location = localizer.process(hall.look(wMb, static_cast<std::uint64_t>(++place)));
    expectPose(location.fix, wMb);
    expectNames(hall, location, wMb, whole);
  }
  // Where all edges of a lamp fall into gaps between the lines it has no id: 3 in 1000.
  static const double unread = 0.02;
  EXPECT_GE(static_cast<double>(whole.accepted), (1 - unread) * static_cast<double>(whole.seen));
}

TEST(IdentifierReuse, TwoCopiesOfOneRoomAreRefused)
{
  vpReuseHall hall(4, 3, 12, 4);
  const vpLampMap room = hall.map;
  for (const vpLamp &lamp : room.lamps) {
    hall.add("copy of " + lamp.id, lamp.position + Eigen::Vector3d(20, 7, 0), lamp.modulation);
  }
  for (std::uint64_t place = 1; place <= 3; ++place) {
    const vpHomogeneousMatrix wMb = hall.randomPose(1, 3.5, 1, 2);
    vpVlpLocalizer localizer(hall.rig, hall.map);
    const vpVlpLocation location = localizer.process(hall.look(wMb, place));
    EXPECT_FALSE(location.fix.valid);
    EXPECT_NE(location.fix.refusal.find("2 places"), std::string::npos) << location.fix.refusal;
    for (const vpLampObservation &lamp : location.observations) {
      EXPECT_FALSE(lamp.accepted);
    }
  }
}

TEST(IdentifierReuse, MirroredLampIsNotAcceptedAndTheFixIsKept)
{
  const double wall = -0.4; // m, a mirror at this x
  const vpTemporaryFolder folder;
  vpReuseHall hall(6, 6, 12, 5);
  hall.map.save(folder / "lamps.yaml");
  std::vector<std::string> arguments = {"--rig",   std::string(VLP_DATA_DIR) + "/rigs/ub300-800x600.yaml",
                                        "--lamps", folder / "lamps.yaml",
                                        "--seen",  folder / "seen.csv",
                                        "--fixes", folder / "fixes.csv",
                                        "--image"};
  std::vector<vpHomogeneousMatrix> poses;
  std::vector<Eigen::Vector2d> images; // of the mirrored lamp
  while (poses.size() < 6) {
    const size_t k = 6 * static_cast<size_t>(hall.uniform(0, 6)); // of the column next to the wall
    vpReuseHall mirrored = hall;
    vpSimulatedLamp image = hall.scene.lamps[k]; // the same light at the same time
    image.lamp.position.x() = 2 * wall - image.lamp.position.x();
    mirrored.scene.lamps.push_back(image);
    const vpHomogeneousMatrix wMb = hall.randomPose(0, 1.5, 0, 7.5);
    if (!hall.shows(image.lamp.position, wMb) || !hall.shows(hall.map.lamps[k].position, wMb) ||
        hall.inView(wMb) < 3) {
      continue;
    }
    vpVlpFrame frame = mirrored.look(wMb, poses.size());
    const std::string file = folder / (std::to_string(poses.size()) + ".png");
    cv::imwrite(file, cv::Mat(static_cast<int>(frame.I.getHeight()), static_cast<int>(frame.I.getWidth()),
                              CV_8UC1, frame.I.bitmap));
    arguments.push_back(file);
    poses.push_back(wMb);
    images.push_back(hall.pixelOf(image.lamp.position, wMb));
  }

  vpProcess locate("vlp-locate", arguments);
  EXPECT_EQ(locate.wait(), 0) << locate.err();
  const vpCsvTable fixes = vpCsvTable::load(folder / "fixes.csv", vpFixLog::columns());
  ASSERT_EQ(fixes.rows(), poses.size());
  for (size_t i = 0; i < poses.size(); ++i) {
    EXPECT_NEAR(fixes.number(i, 1), poses[i][0][3], 0.005);
    EXPECT_NEAR(fixes.number(i, 2), poses[i][1][3], 0.005);
  }
  const vpCsvTable seen =
      vpCsvTable::load(folder / "seen.csv", {"timestamp_s", "file", "lamp_id", "u", "v", "diameter_px",
                                             "frequency_hz", "duty", "confidence", "accepted", "symbols"});
  size_t refused = 0, accepted = 0;
  for (size_t row = 0; row < seen.rows(); ++row) {
    const auto i = static_cast<size_t>(seen.number(row, 0));
    const Eigen::Vector2d point(seen.number(row, 3), seen.number(row, 4));
    if ((point - images[i]).norm() < near) {
      EXPECT_EQ(seen.text(row, 9), "0") << "picture " << i;
      ++refused;
    } else if (seen.text(row, 9) == "1") {
      EXPECT_EQ(seen.text(row, 2), idAt(hall, point, poses[i])) << "picture " << i;
      ++accepted;
    }
  }
  EXPECT_EQ(refused, poses.size());
  EXPECT_GE(accepted, 3 * poses.size());
}
