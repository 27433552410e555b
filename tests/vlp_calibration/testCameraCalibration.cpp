/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <visp3/core/vpPixelMeterConversion.h>
#include <visp3/vlp_calibration/vpCameraCalibration.h>
#include <visp3/vlp_core/vpYamlNode.h>

#include "common/vpTemporaryFolder.h"
#include "vlp_calibration/boardPictures.h"

namespace
{
using namespace boardPictures;
using Model = vpCameraCalibration::Model;

vpImage<unsigned char> imageOf(const cv::Mat_<unsigned char> &grey)
{
  vpImage<unsigned char> I(static_cast<unsigned int>(grey.rows), static_cast<unsigned int>(grey.cols));
  std::copy(grey.begin(), grey.end(), I.bitmap);
  return I;
}

double median(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

TEST(CameraCalibration, RecoversViSPsModelOver50Seeds)
{
  const int seeds = 50;
  std::vector<double> focal, principal;
  std::vector<double> normalised(5, 0.0);
  const vpCameraParameters truth = camera();
  Eigen::VectorXd exact(5);
  exact << truth.get_px(), truth.get_py(), truth.get_u0(), truth.get_v0(), truth.get_kud();
  for (int seed = 0; seed < seeds; ++seed) {
    const vpCameraEstimate found = vpCameraCalibration().solve(
        sights(vpBoard(), 15, 0.2, static_cast<unsigned int>(seed + 1)), width, height);
    ASSERT_TRUE(found.valid) << found.refusal;
    const Eigen::VectorXd error = found.values - exact;
    focal.push_back(std::max(std::abs(error(0)) / exact(0), std::abs(error(1)) / exact(1)));
    principal.push_back(std::max(std::abs(error(2)), std::abs(error(3))));
    for (int i = 0; i < 5; ++i) {
      normalised[static_cast<size_t>(i)] += error(i) * error(i) / found.covariance(i, i) / seeds;
    }
    EXPECT_NEAR(found.rms, 0.2, 0.02);
  }
  EXPECT_LT(median(focal), 0.003);
  EXPECT_LT(median(principal), 1.0);
  for (int i = 0; i < 5; ++i) { // mean of 50 chi-squares of one degree: 99.9 % are between these
    EXPECT_GT(normalised[static_cast<size_t>(i)], 0.46) << i;
    EXPECT_LT(normalised[static_cast<size_t>(i)], 1.84) << i;
  }
}

//! Root mean square, px over the picture, of what there and back leaves.
double wayBackError(const vpCameraParameters &camera)
{
  double squares = 0;
  int count = 0;
  for (double v1 = 0; v1 < height; v1 += 20) {
    for (double u1 = 0; u1 < width; u1 += 20) {
      double x = 0, y = 0, u = 0, v = 0;
      vpPixelMeterConversion::convertPoint(camera, u1, v1, x, y);
      vpMeterPixelConversion::convertPoint(camera, x, y, u, v);
      squares += (u - u1) * (u - u1) + (v - v1) * (v - v1);
      count += 2;
    }
  }
  return std::sqrt(squares / count);
}

//! ViSP's kud and kdu are no exact inverses: of all kdu the one found has to be among the best.
TEST(CameraCalibration, TheWayBackUndoesTheWayThere)
{
  for (const double kud : {-0.03, -0.12}) {
    const vpCameraEstimate found =
        vpCameraCalibration().solve(sights(vpBoard(), 15, 0.05, 3, camera(kud)), width, height);
    ASSERT_TRUE(found.valid) << found.refusal;
    const vpCameraParameters &own = found.camera;
    for (const double share : {0.85, 1.15}) {
      vpCameraParameters other;
      other.initPersProjWithDistortion(own.get_px(), own.get_py(), own.get_u0(), own.get_v0(), own.get_kud(),
                                       share * own.get_kdu());
      EXPECT_LT(wayBackError(own), wayBackError(other)) << kud;
    }
    if (kud > -0.05) {
      EXPECT_LT(wayBackError(own), 0.3);
    }
  }
}

TEST(CameraCalibration, OtherModelsExplainTheSamePictures)
{
  const std::vector<vpBoardSight> seen = sights(vpBoard(), 15, 0.1, 5, camera(-0.05));
  for (const Model model : {Model::opencv, Model::kannalaBrandt}) {
    vpCameraCalibration calibration;
    calibration.model = model;
    const vpCameraEstimate found = calibration.solve(seen, width, height);
    ASSERT_TRUE(found.valid) << found.refusal;
    EXPECT_LT(found.rms, 0.12);
    EXPECT_NEAR(found.values(0), 488, 3);
  }
  vpCameraCalibration none;
  none.model = Model::perspective; // has no distortion to explain them with
  EXPECT_GT(none.solve(seen, width, height).rms, 0.3);
}

TEST(CameraCalibration, KannalaBrandtIsRecoveredFromItsOwnPictures)
{
  vpCameraParameters wide;
  wide.initProjWithKannalaBrandtDistortion(400, 401, 398, 301, {0.02, -0.01, 0.002, 0, 0});
  vpCameraCalibration calibration;
  calibration.model = Model::kannalaBrandt;
  const vpCameraEstimate found = calibration.solve(sights(vpBoard(), 20, 0.05, 9, wide), width, height);
  ASSERT_TRUE(found.valid) << found.refusal;
  EXPECT_NEAR(found.camera.get_px(), 400, 1.2);
  EXPECT_NEAR(found.camera.get_u0(), 398, 1);
  EXPECT_LT(found.rms, 0.06);
}

TEST(CameraCalibration, NamesPicturesFarOffTheOthers)
{
  std::vector<vpBoardSight> seen = sights(vpBoard(), 15, 0.1, 7);
  for (size_t i = 0; i < seen[4].pixels.size(); i += 2) { // the board bent
    seen[4].pixels[i].x += 5;
  }
  const vpCameraEstimate found = vpCameraCalibration().solve(seen, width, height);
  ASSERT_TRUE(found.valid) << found.refusal;
  ASSERT_EQ(found.views.size(), 15u);
  for (const vpCalibratedView &view : found.views) {
    EXPECT_EQ(view.used, view.picture != "picture 4") << view.picture;
  }
  EXPECT_NEAR(found.values(0), 488, 1.5);
}

TEST(CameraCalibration, RefusesSetsThatDoNotTell)
{
  const vpBoard board;
  const vpCameraCalibration calibration;
  const vpCameraEstimate few = calibration.solve(sights(board, 3, 0.1, 1), width, height);
  EXPECT_FALSE(few.valid);
  EXPECT_NE(few.refusal.find("too few pictures: 3"), std::string::npos) << few.refusal;

  std::mt19937_64 random(1);
  const vpHomogeneousMatrix cMo = held(board, 0, random);
  std::vector<vpBoardSight> same, flat;
  for (int i = 0; i < 15; ++i) {
    same.push_back(sight(board, camera(), cMo, 0.2, random, "same"));
    const vpHomogeneousMatrix shifted(vpTranslationVector(-0.2 + 0.02 * i, -0.1, 0.4), vpRotationMatrix());
    flat.push_back(sight(board, camera(), shifted, 0.2, random, "flat"));
  }
  const vpCameraEstimate still = calibration.solve(same, width, height);
  EXPECT_FALSE(still.valid);
  EXPECT_NE(still.refusal.find("from one place"), std::string::npos) << still.refusal;
  const vpCameraEstimate straight = calibration.solve(flat, width, height);
  EXPECT_FALSE(straight.valid);
  EXPECT_NE(straight.refusal.find("tilted by 20 to 40 degrees"), std::string::npos) << straight.refusal;
}

TEST(CameraCalibration, AnyNameComesBackFromItsYaml)
{
  const vpTemporaryFolder folder;
  vpCameraEstimate estimate;
  estimate.values = Eigen::VectorXd::Constant(6, 1);
  for (const std::string name : {"a: b", "a #b", "- x", "\"q", "%", "true", "UB300"}) {
    const std::string file =
        folder.write("camera_info.yaml",
                     vpCameraInfoYaml(estimate, vpCameraCalibration::Model::perspective, name, 640, 480));
    EXPECT_EQ(vpYamlNode::load(file).text("camera_name"), name);
  }
}

TEST(CameraInfo, OfAWideLensComesBackAndOneWithoutAModelIsRefused)
{
  const vpTemporaryFolder folder;
  vpCameraEstimate estimate;
  estimate.values = (Eigen::VectorXd(8) << 500, 501, 320, 240, 0.01, -0.02, 0.003, -0.0004).finished();
  const std::string file =
      folder.write("camera_info.yaml",
                   vpCameraInfoYaml(estimate, vpCameraCalibration::Model::kannalaBrandt, "wide", 640, 480));
  const vpCameraXml wide = vpCameraFromInfo(file);
  EXPECT_EQ(wide.name, "wide");
  EXPECT_EQ(wide.width, 640u);
  EXPECT_EQ(wide.height, 480u);
  EXPECT_EQ(wide.camera.get_py(), 501);
  EXPECT_EQ(wide.camera.getKannalaBrandtDistortionCoefficients(),
            (std::vector<double>{0.01, -0.02, 0.003, -0.0004, 0}));

  estimate.values = (Eigen::VectorXd(9) << 500, 501, 320, 240, -0.1, 0.01, 0, 0, 0).finished();
  folder.write("camera_info.yaml",
               vpCameraInfoYaml(estimate, vpCameraCalibration::Model::opencv, "k2", 640, 480));
  try {
    vpCameraFromInfo(file);
    FAIL() << "k2 was taken";
  } catch (const vpException &error) {
    EXPECT_NE(error.getStringMessage().find("distortion_coefficients"), std::string::npos);
    EXPECT_NE(error.getStringMessage().find("k2"), std::string::npos);
  }
}

TEST(Board, IsFoundWhereItIs)
{
  for (const vpBoard::Kind kind : {vpBoard::Kind::chessboard, vpBoard::Kind::charuco}) {
    vpBoard board;
    board.kind = kind;
    std::mt19937_64 random(2);
    const vpHomogeneousMatrix cMo = held(board, 2, random, 0.5);
    const vpBoardSight truth = sight(board, camera(), cMo, 0, random, "truth");
    const vpBoardSight found = board.find(imageOf(picture(board, camera(), cMo, random)), "picture");
    ASSERT_GT(found.pixels.size(), 40u);
    std::vector<double> errors;
    for (size_t i = 0; i < found.pixels.size(); ++i) {
      double nearest = 1e9; // a chessboard may be counted from its other end
      for (const cv::Point2f &corner : truth.pixels) {
        nearest = std::min(nearest, cv::norm(corner - found.pixels[i]));
      }
      errors.push_back(nearest);
    }
    EXPECT_LT(median(errors), 0.15) << static_cast<int>(kind);
  }
}

//! Large ones as well: as a camera of 3 megapixels shows those of a sheet of paper.
TEST(Board, TellsHowLargeItsDiscsAre)
{
  vpBoard board;
  board.kind = vpBoard::Kind::circles;
  board.columns = 4;
  board.rows = 3;
  board.spacing = 0.09;
  std::mt19937_64 random(4);
  const vpHomogeneousMatrix cMo(vpTranslationVector(-0.15, -0.1, 0.4), vpRotationMatrix(0.4, 0.2, 0.1));
  const vpBoardSight truth = sight(board, camera(), cMo, 0, random, "truth");
  const vpBoardSight found = board.find(imageOf(picture(board, camera(), cMo, random)), "picture");
  ASSERT_EQ(found.pixels.size(), 12u);
  EXPECT_NEAR(found.discRadius, discShare * board.spacing, 0.03 * discShare * board.spacing);
}

//! What pictures of discs show: the middles of what these cover, by a polygon of many corners.
std::vector<vpBoardSight> discSights(const vpBoard &board, double radius, double noise, unsigned int seed)
{
  const int corners = 400;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0, noise);
  std::vector<vpBoardSight> all;
  for (int i = 0; i < 15; ++i) {
    const vpHomogeneousMatrix cMo = held(board, i, random);
    vpBoardSight shown = sight(board, camera(), cMo, 0, random, "picture " + std::to_string(i));
    shown.discRadius = radius;
    for (size_t k = 0; k < shown.pixels.size(); ++k) {
      std::vector<cv::Point2d> rim;
      for (int j = 0; j < corners; ++j) {
        const double angle = 2 * M_PI * j / corners;
        const vpColVector c =
            cMo * vpColVector(std::vector<double>{shown.board[k].x + radius * std::cos(angle),
                                                  shown.board[k].y + radius * std::sin(angle), 0, 1});
        double u = 0, v = 0;
        vpMeterPixelConversion::convertPoint(camera(), c[0] / c[2], c[1] / c[2], u, v);
        rim.emplace_back(u - shown.pixels[k].x, v - shown.pixels[k].y);
      }
      cv::Point2d moment(0, 0);
      double area = 0;
      for (size_t j = 0; j < rim.size(); ++j) {
        const cv::Point2d &a = rim[j], &b = rim[(j + 1) % rim.size()];
        area += a.cross(b);
        moment += a.cross(b) / 3 * (a + b);
      }
      shown.pixels[k] += cv::Point2f(static_cast<float>(moment.x / area + normal(random)),
                                     static_cast<float>(moment.y / area + normal(random)));
    }
    all.push_back(shown);
  }
  return all;
}

//! The middle of a disc's picture is not the picture of its middle: taken for that, the focal length is
//! short.
TEST(CameraCalibration, DiscsAreNotTakenForPoints)
{
  const vpBoard board;
  std::vector<vpBoardSight> seen = discSights(board, discShare * board.spacing, 0.01, 5);
  const vpCameraEstimate found = vpCameraCalibration().solve(seen, width, height);
  ASSERT_TRUE(found.valid) << found.refusal;
  EXPECT_EQ(found.views.size(), seen.size());
  const Eigen::Vector4d truth(488, 489, 395, 305);
  const auto sigmas = [&truth](const vpCameraEstimate &estimate, int i) {
    return (estimate.values(i) - truth(i)) / std::sqrt(estimate.covariance(i, i));
  };
  for (int i = 0; i < 4; ++i) {
    EXPECT_LT(std::abs(sigmas(found, i)), 3.5) << found.names[static_cast<size_t>(i)];
  }
  seen.front().discRadius = 0; // a picture too dim to tell: its discs are taken for points
  EXPECT_TRUE(vpCameraCalibration().solve(seen, width, height).valid);
  for (vpBoardSight &sight : seen) {
    sight.discRadius = 0;
  }
  EXPECT_LT(sigmas(vpCameraCalibration().solve(seen, width, height), 0), -4);
}

//! As markers are counted, and circles of which a part is found.
TEST(CameraCalibration, PointsCountedForABoardOfAnotherSizeAreRefusedAsSuch)
{
  std::vector<vpBoardSight> seen = sights(vpBoard(), 15, 0.2, 7);
  for (vpBoardSight &sight : seen) {
    for (size_t i = 0; i < sight.board.size(); ++i) {
      const auto column = static_cast<float>(i % 8), row = static_cast<float>(i / 8);
      sight.board[i] = cv::Point3f(0.025f * column, 0.025f * row, 0);
    }
  }
  const vpCameraEstimate found = vpCameraCalibration().solve(seen, width, height);
  EXPECT_FALSE(found.valid);
  EXPECT_NE(found.refusal.find("15 of 15 pictures do not lie as on the board"), std::string::npos)
      << found.refusal;
}

TEST(Board, AnotherSizeIsToldByItsName)
{
  vpBoard other;
  other.columns = 8;
  other.rows = 5;
  std::mt19937_64 random(2);
  const cv::Mat_<unsigned char> shown = picture(other, camera(), held(other, 2, random, 0.4), random);
  EXPECT_TRUE(vpBoard().find(imageOf(shown), "").pixels.empty());
  EXPECT_EQ(vpBoard().sizeShown(imageOf(shown)), "8x5");
}

TEST(Board, PrintsInTrueSize)
{
  const std::string pdf = vpBoard().pdf();
  EXPECT_EQ(pdf.rfind("%PDF-1.4\n", 0), 0u);
  EXPECT_NE(pdf.find("/MediaBox [0 0 1190.55118 841.88976]"), std::string::npos); // A3: 300 mm and more wide
  EXPECT_NE(pdf.find("2.83465 0 0 2.83465 0 0 cm\n"), std::string::npos);         // millimetres
  size_t squares = 0;
  for (size_t at = pdf.find(" 25.00000 25.00000 re\n"); at != std::string::npos;
       at = pdf.find(" 25.00000 25.00000 re\n", at + 1)) {
    ++squares;
  }
  EXPECT_EQ(squares, 35u); // half of ten by seven
  EXPECT_NE(pdf.find(" 100.00000 0.50000 re\n"), std::string::npos);
  const size_t table = pdf.find("xref\n"), start = pdf.find("startxref\n");
  EXPECT_EQ(std::stoul(pdf.substr(start + 10)), table);
}
} // namespace
