/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <visp3/core/vpMeterPixelConversion.h>
#include <visp3/core/vpPixelMeterConversion.h>
#include <visp3/vlp_core/vpLampObservation.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
using Eigen::Vector2d;
using Eigen::Vector3d;

//! A flat lamp before the camera.
struct Lamp {
  Vector3d middle; // m, camera frame
  Vector3d normal;
  double radius; // m
};

/*!
  The pixel whose ray meets the point. ViSP's pixel-to-metre and metre-to-pixel conversions with distortion
  differ by 0.2 px in these tests; the first is the one that localization uses.
*/
Vector2d project(const vpCameraParameters &camera, const Vector3d &point)
{
  const Vector2d wanted = point.hnormalized();
  Vector2d pixel, ray;
  vpMeterPixelConversion::convertPoint(camera, wanted.x(), wanted.y(), pixel.x(), pixel.y());
  for (int i = 0; i < 50; ++i) {
    vpPixelMeterConversion::convertPoint(camera, pixel.x(), pixel.y(), ray.x(), ray.y());
    pixel += camera.get_px() * (wanted - ray);
  }
  return pixel;
}

//! The ellipse that fits the lamp's outline best, from 2000 of its points.
vpLampOutline outlineOf(const vpCameraParameters &camera, const Lamp &lamp)
{
  const Vector3d e1 = lamp.normal.unitOrthogonal();
  const Vector3d e2 = lamp.normal.normalized().cross(e1);
  std::vector<Vector2d> points;
  Vector2d mean = Vector2d::Zero();
  constexpr int samples = 2000;
  for (int i = 0; i < samples; ++i) {
    const double t = 2 * M_PI * i / samples;
    points.push_back(project(camera, lamp.middle + lamp.radius * (std::cos(t) * e1 + std::sin(t) * e2)));
    mean += points.back() / samples;
  }
  const double scale = (points[0] - mean).norm();
  cv::Mat1d rows(samples, 6);
  for (int i = 0; i < samples; ++i) {
    const Vector2d s = (points[static_cast<size_t>(i)] - mean) / scale;
    const double row[] = {s.x() * s.x(), s.x() * s.y(), s.y() * s.y(), s.x(), s.y(), 1};
    std::copy(std::begin(row), std::end(row), rows[i]);
  }
  cv::Mat1d q;
  cv::SVD::solveZ(rows, q);
  q *= q(0) < 0 ? -1 : 1;
  Eigen::Matrix2d A;
  A << q(0), q(1) / 2, q(1) / 2, q(2);
  const Vector2d centre = -0.5 * A.inverse() * Vector2d(q(3), q(4));
  const double level = centre.dot(A * centre) - q(5);
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(A); // ascending: the first is the longer axis
  vpLampOutline outline;
  outline.shape = vpLampOutline::Shape::ellipse;
  outline.centre = mean + scale * centre;
  outline.a = scale * std::sqrt(level / axes.eigenvalues()(0));
  outline.b = scale * std::sqrt(level / axes.eigenvalues()(1));
  outline.angle = std::atan2(axes.eigenvectors()(1, 0), axes.eigenvectors()(0, 0));
  return outline;
}

Lamp lampAt(double x, double y, double distance, double tiltDeg, double azimuthDeg, double radius)
{
  const double tilt = tiltDeg * M_PI / 180, azimuth = azimuthDeg * M_PI / 180;
  return {distance * Vector3d(x, y, 1),
          Vector3d(std::sin(tilt) * std::cos(azimuth), std::sin(tilt) * std::sin(azimuth), -std::cos(tilt)),
          radius};
}
} // namespace

TEST(LampOutline, LinesEndOnAnEllipse)
{
  vpLampOutline outline;
  outline.shape = vpLampOutline::Shape::ellipse;
  outline.centre = {40, 30};
  outline.a = 20;
  outline.b = 8;
  outline.angle = 0.4;
  const Eigen::Rotation2Dd turn(-outline.angle);
  const Eigen::Vector4d box = outline.box();
  const vpOutlineLines across(outline);
  double first, last;
  for (double v = box(1) + 0.01; v < box(3); v += 0.5) {
    ASSERT_TRUE(across.stretch(v, first, last)) << v;
    EXPECT_LT(first, last);
    for (double u : {first, last}) {
      const Eigen::Vector2d at = turn * (Eigen::Vector2d(u, v) - outline.centre);
      EXPECT_NEAR(std::hypot(at.x() / outline.a, at.y() / outline.b), 1, 1e-9) << u << ", " << v;
    }
  }
  EXPECT_FALSE(across.stretch(box(1) - 0.01, first, last));
  EXPECT_FALSE(across.stretch(box(3) + 0.01, first, last));
}

TEST(LampOutline, LinesEndOnTheSidesOfAQuadrilateral)
{
  vpLampOutline outline;
  outline.shape = vpLampOutline::Shape::quadrilateral;
  outline.corners = {Eigen::Vector2d(10, 0), Eigen::Vector2d(20, 10), Eigen::Vector2d(10, 20),
                     Eigen::Vector2d(0, 10)};
  const vpOutlineLines across(outline);
  double first, last;
  ASSERT_TRUE(across.stretch(5, first, last));
  EXPECT_DOUBLE_EQ(first, 5);
  EXPECT_DOUBLE_EQ(last, 15);
  EXPECT_FALSE(across.stretch(20.5, first, last));
}

TEST(LampOutline, MiddleOfATiltedDiskIsNotTheMiddleOfItsEllipse)
{
  const vpCameraParameters camera(280, 280, 320, 240);
  const Lamp lamp = lampAt(0, 0, 1.5, 10, 30, 0.15); // 28 px radius
  const vpLampOutline outline = outlineOf(camera, lamp);
  const Vector2d truth = project(camera, lamp.middle);
  EXPECT_NEAR(outline.diameter(), 56, 1);
  EXPECT_NEAR((outline.centre - truth).norm(), 0.5, 0.1);
  EXPECT_LT((outline.middle(camera, lamp.normal) - truth).norm(), 1e-3);
  EXPECT_LT((outline.middle(camera, -7 * lamp.normal) - truth).norm(), 1e-3); // of any length, either way
}

TEST(LampOutline, MiddleIsExactAnywhereInThePicture)
{
  const vpCameraParameters camera(906.25, 900, 417, 341);
  for (const double x : {-0.4, 0.0, 0.35}) {
    for (const double y : {-0.3, 0.2}) {
      for (const double tilt : {0.0, 10.0, 35.0}) {
        const Lamp lamp = lampAt(x, y, 1.5, tilt, 70, 0.075);
        EXPECT_LT((outlineOf(camera, lamp).middle(camera, lamp.normal) - project(camera, lamp.middle)).norm(),
                  1e-6);
      }
    }
  }
}

TEST(LampOutline, MiddleWithDistortion)
{
  const std::vector<double> kb = {0.02, -0.005, 0.001, 0, 0};
  for (const vpCameraParameters &camera : {vpCameraParameters(906.25, 906.25, 417, 341, -0.12, 0.125),
                                           vpCameraParameters(906.25, 906.25, 417, 341, kb)}) {
    for (const double x : {-0.35, 0.0, 0.3}) {
      const Lamp lamp = lampAt(x, 0.25, 1.5, 10, 70, 0.05); // 30 px radius
      const Vector2d truth = project(camera, lamp.middle);
      EXPECT_LT((outlineOf(camera, lamp).middle(camera, lamp.normal) - truth).norm(), 0.01) << x;
    }
  }
}

TEST(LampOutline, MiddleOfADiskThatFacesTheCameraIsItsCentre)
{
  vpLampOutline outline;
  outline.shape = vpLampOutline::Shape::ellipse;
  outline.centre = Vector2d(700, 100);
  outline.a = outline.b = 20;
  // even where kud and kdu are no exact inverses of each other
  const vpCameraParameters camera(900, 900, 400, 300, -0.3, 0.2);
  Vector3d ray(0, 0, 1);
  vpPixelMeterConversion::convertPoint(camera, 700, 100, ray.x(), ray.y());
  EXPECT_LT((outline.middle(camera, ray) - outline.centre).norm(), 0.1);
  outline.a = outline.b = 1e-3;
  EXPECT_LT((outline.middle(camera, ray) - outline.centre).norm(), 1e-6);
}

TEST(LampOutline, MiddleFallsBackOnTheCentre)
{
  const vpCameraParameters camera(900, 900, 400, 300);
  vpLampOutline outline;
  outline.centre = Vector2d(410, 305);
  outline.a = 30;
  outline.b = 20;
  EXPECT_EQ(outline.middle(camera, Vector3d(0, 0, 1)), outline.centre); // a region
  outline.shape = vpLampOutline::Shape::ellipse;
  EXPECT_EQ(outline.middle(camera, Vector3d(1, 0, 0)),
            outline.centre); // seen edge-on: the horizon cuts the lamp
  EXPECT_EQ(outline.middle(camera, Vector3d(0, 0, 0)), outline.centre);
  EXPECT_EQ(outline.middle(camera, Vector3d(NAN, 0, 1)), outline.centre);
  outline.b = 0;
  EXPECT_EQ(outline.middle(camera, Vector3d(0, 0, 1)), outline.centre);
  outline.a = outline.b = NAN;
  EXPECT_EQ(outline.middle(camera, Vector3d(0, 0, 1)), outline.centre);
}

TEST(LampOutline, MiddleOfASquareIsTheCrossingOfItsDiagonals)
{
  for (const vpCameraParameters &camera :
       {vpCameraParameters(906.25, 900, 417, 341), vpCameraParameters(906.25, 900, 417, 341, -0.12, 0.125)}) {
    const Lamp lamp = lampAt(0.3, -0.2, 1.5, 25, 40, 0);
    const Vector3d e1 = 0.15 * lamp.normal.unitOrthogonal();
    const Vector3d e2 = lamp.normal.normalized().cross(e1);
    vpLampOutline outline;
    outline.shape = vpLampOutline::Shape::quadrilateral;
    outline.corners = {project(camera, lamp.middle + e1), project(camera, lamp.middle + e2),
                       project(camera, lamp.middle - e1), project(camera, lamp.middle - e2)};
    EXPECT_LT((outline.middle(camera, lamp.normal) - project(camera, lamp.middle)).norm(), 1e-6);
  }
  vpLampOutline flat;
  flat.shape = vpLampOutline::Shape::quadrilateral;
  flat.centre = Vector2d(3, 4); // of corners that are all one point
  EXPECT_EQ(flat.middle(vpCameraParameters(900, 900, 0, 0), Vector3d(0, 0, 1)), flat.centre);
}

TEST(LampOutline, BoxAndDiameter)
{
  vpLampOutline ellipse;
  ellipse.shape = vpLampOutline::Shape::ellipse;
  ellipse.centre = Vector2d(100, 50);
  ellipse.a = 30;
  ellipse.b = 10;
  ellipse.angle = M_PI / 2;
  EXPECT_TRUE(ellipse.box().isApprox(Eigen::Vector4d(90, 20, 110, 80)));
  EXPECT_DOUBLE_EQ(ellipse.diameter(), 40);
  ellipse.angle = 0.4;
  Eigen::Vector4d expected(1e9, 1e9, -1e9, -1e9);
  for (int i = 0; i < 100000; ++i) {
    const double t = 2 * M_PI * i / 100000;
    const Vector2d point = ellipse.centre + std::cos(t) * 30 * Vector2d(std::cos(0.4), std::sin(0.4)) +
                           std::sin(t) * 10 * Vector2d(-std::sin(0.4), std::cos(0.4));
    expected << expected.head<2>().cwiseMin(point), expected.tail<2>().cwiseMax(point);
  }
  EXPECT_LT((ellipse.box() - expected).norm(), 1e-6);

  vpLampOutline square;
  square.shape = vpLampOutline::Shape::quadrilateral;
  square.corners = {Vector2d(0, 5), Vector2d(5, 0), Vector2d(10, 5), Vector2d(5, 10)};
  EXPECT_EQ(square.box(), Eigen::Vector4d(0, 0, 10, 10));
  EXPECT_NEAR(square.diameter(), std::sqrt(50), 1e-12);
}
