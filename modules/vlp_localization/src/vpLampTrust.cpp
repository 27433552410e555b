/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLampTrust.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/LU>
#include <visp3/core/vpMeterPixelConversion.h>

#include "vpLampGeometry.h"

BEGIN_VISP_NAMESPACE

namespace
{
const int known = 3;        // frames after which a lamp's place and size are its own
const double memory = 0.03; // share of the latest frame in a running mean: slower than people walk
const int patience = 60;    // frames in a row that it takes to believe that a lamp is of another size

Eigen::Vector2d seenExtent(const vpLampOutline &outline)
{
  const Eigen::Vector4d box = outline.box();
  return {box(2) - box(0), box(3) - box(1)};
}

//! A place (m) given in frame w, in frame a.
Eigen::Vector3d inFrame(const vpHomogeneousMatrix &wMa, const Eigen::Vector3d &place)
{
  Eigen::Vector3d a = Eigen::Vector3d::Zero();
  for (unsigned int i = 0; i < 3; ++i) {
    for (unsigned int k = 0; k < 3; ++k) {
      a(i) += wMa[k][i] * (place(k) - wMa[k][3]);
    }
  }
  return a;
}

Eigen::Vector3d inFrame(const Eigen::Isometry3d &wMa, const Eigen::Vector3d &place)
{
  return wMa.linear().transpose() * (place - wMa.translation());
}

//! Pixel of a place (m, in b). False where it is not in front of the camera.
bool pixelOf(const Eigen::Vector3d &place, const vpVlpRig &rig, Eigen::Vector2d &pixel)
{
  const Eigen::Vector3d c = inFrame(rig.bMc, place);
  if (!(c.z() > 1e-3)) {
    return false;
  }
  vpMeterPixelConversion::convertPoint(rig.camera, c.x() / c.z(), c.y() / c.z(), pixel.x(), pixel.y());
  return true;
}

constexpr size_t rimPoints = 24;

std::array<Eigen::Vector3d, rimPoints> unitCircle()
{
  std::array<Eigen::Vector3d, rimPoints> points;
  for (size_t k = 0; k < rimPoints; ++k) {
    const double angle = 2 * M_PI * static_cast<double>(k) / rimPoints;
    points[k] = {std::cos(angle), std::sin(angle), 0};
  }
  return points;
}
} // namespace

bool vpLampTrust::motionOf(const Eigen::Vector3d &place, const Eigen::Isometry3d &wMb,
                           const Eigen::Vector3d &velocity, const vpVlpRig &rig, Eigen::Vector2d &pixel,
                           Eigen::Vector2d &motion)
{
  const Eigen::Vector3d b = inFrame(wMb, place);
  // From b, whatever stands still in w moves the other way.
  const Eigen::Vector3d moves(velocity.z() * b.y() - velocity.x(), -velocity.z() * b.x() - velocity.y(), 0);
  static const double moment = 1e-3; // s
  if (!pixelOf(b, rig, pixel) || !pixelOf(b + moment * moves, rig, motion)) {
    return false;
  }
  motion = (motion - pixel) / moment;
  return true;
}

Eigen::Vector2d vpLampTrust::extentOf(const vpLamp &lamp, const Eigen::Isometry3d &wMb,
                                      const Eigen::Vector3d &velocity, const vpVlpRig &rig, double lineTime)
{
  const double half = 0.5 * (std::isfinite(lamp.size) ? lamp.size : 1);
  static const std::array<Eigen::Vector3d, rimPoints> circle = unitCircle();
  const bool disk = lamp.shape == vpLamp::Shape::disk;
  Eigen::Vector2d least(1e9, 1e9), most(-1e9, -1e9), p;
  for (size_t k = 0; k < (disk ? rimPoints : 4); ++k) {
    const double angle = lamp.yaw + M_PI * static_cast<double>(2 * k + 1) / 4; // of a corner
    const Eigen::Vector3d rim =
        disk ? half * circle[k] : std::sqrt(2) * half * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
    if (!pixelOf(inFrame(wMb, lamp.position + rim), rig, p)) {
      return Eigen::Vector2d::Zero();
    }
    least = least.cwiseMin(p);
    most = most.cwiseMax(p);
  }
  Eigen::Vector2d extent = most - least;
  if (disk) {
    extent /= std::cos(0.5 * M_PI / rimPoints); // a polygon's falls short of its circle's
  }
  Eigen::Vector2d middle, motion;
  if (motionOf(lamp.position, wMb, velocity, rig, middle, motion)) {
    const int along = rig.shutter.alongColumns() ? 0 : 1;
    extent(along) /= std::max(0.1, 1 - motion(along) * lineTime);
  }
  return extent;
}

std::string vpLampTrust::changed(const vpLamp &lamp, const vpLampObservation &seen,
                                 const vpLampExtent &expected)
{
  const auto found = m_past.find(lamp.id);
  if (found == m_past.end() || found->second.sizes < known || seen.cut || !(expected.size.minCoeff() > 0)) {
    return "";
  }
  Past &past = found->second;
  const Eigen::Vector2d size = seenExtent(seen.outline).cwiseQuotient(expected.size);
  static const double coarse = 0.15; // px
  const Eigen::Vector2d tolerance =
      (sizeTolerance + gate * expected.stretch) * past.size + coarse * expected.size.cwiseInverse();
  const Eigen::Vector2d more = (size - past.size).cwiseQuotient(tolerance);
  past.smaller = more.minCoeff() < -1 || seen.outline.shape != past.shape ? past.smaller + 1 : 0;
  past.larger = more.maxCoeff() > 1 && past.smaller == 0 ? past.larger + 1 : 0;
  if (past.smaller > patience || past.larger > patience) { // so it is, then
    past.size = size;
    past.shape = seen.outline.shape;
    past.smaller = past.larger = 0;
  }
  return past.smaller > 0  ? "not as large as it was: partly hidden"
         : past.larger > 0 ? "larger than it was"
                           : "";
}

bool vpLampTrust::looksAsBefore(const vpLampFrame &frame, const vpHomogeneousMatrix &wMb) const
{
  const vpBasePose base = vpBasePose::of(wMb);
  Eigen::Isometry3d pose(base.wRb);
  pose.translation() = base.wtb;
  vpLampTrust asked = *this;         // which counts how often it is asked
  static const double moving = 0.01; // stretch of a lamp by an unknown velocity, standard deviation
  return std::all_of(frame.lamps.begin(), frame.lamps.end(), [&](const vpFrameLamp &lamp) {
    const vpLampExtent expected = {
        extentOf(*lamp.lamp, pose, Eigen::Vector3d::Zero(), *frame.rig, frame.lineTime), moving};
    return !lamp.seen->accepted || asked.changed(*lamp.lamp, *lamp.seen, expected).empty();
  });
}

bool vpLampTrust::knows(const vpLamp &lamp) const
{
  const auto found = m_past.find(lamp.id);
  return found != m_past.end() && found->second.frames >= known;
}

bool vpLampTrust::doubts(const vpLamp &lamp) const
{
  const auto found = m_past.find(lamp.id);
  return found != m_past.end() && found->second.doubted;
}

double vpLampTrust::tolerance(const vpLamp &lamp) const
{
  return knows(lamp) ? placeTolerance : doubts(lamp) ? doubtedTolerance : mapTolerance;
}

Eigen::Vector2d vpLampTrust::offset(const vpLamp &lamp) const
{
  if (!knows(lamp)) {
    return Eigen::Vector2d::Zero();
  }
  const Past &past = m_past.at(lamp.id);
  static const double chance = 13.8; // chi-square of two, 1 in 1000
  return past.offset.dot(past.doubt.inverse() * past.offset) > chance ? past.offset : Eigen::Vector2d(0, 0);
}

void vpLampTrust::forgetPlaces()
{
  for (auto &[id, past] : m_past) {
    past.frames = 0;
    past.offset.setZero();
    past.doubt.setZero();
  }
}

void vpLampTrust::believe(const vpLamp &lamp, const vpLampObservation &seen,
                          const vpVlpFilter::Innovation &innovation, const vpLampExtent &expected)
{
  Past &past = m_past[lamp.id];
  ++past.frames;
  past.doubted = false;
  const double share = std::max(memory, 1.0 / past.frames);
  past.offset += share * (innovation.ray - past.offset);
  past.doubt = (1 - share) * (1 - share) * past.doubt + share * share * innovation.covariance;
  static const double sure = 0.004; // of the stretch
  if (!seen.cut && expected.size.minCoeff() > 0 && expected.stretch < sure) {
    const Eigen::Vector2d size = seenExtent(seen.outline).cwiseQuotient(expected.size);
    past.shape = past.sizes == 0 ? seen.outline.shape : past.shape;
    ++past.sizes;
    past.size += std::max(memory, 1.0 / past.sizes) * (size - past.size);
  }
}

END_VISP_NAMESPACE
