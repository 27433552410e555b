/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpSeenLamps_h
#define vpSeenLamps_h

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <visp3/core/vpMeterPixelConversion.h>
#include <visp3/vlp_localization/vpVlpLocalizer.h>
#include <visp3/vlp_robot/vpOdometry.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

//! The base at a time: m, rad.
struct vpPlannedPlace {
  double x = 0, y = 0, yaw = 0;

  vpHomogeneousMatrix wMb() const
  {
    vpHomogeneousMatrix M;
    M[0][0] = M[1][1] = std::cos(yaw);
    M[1][0] = std::sin(yaw);
    M[0][1] = -M[1][0];
    M[0][3] = x;
    M[1][3] = y;
    return M;
  }
};

//! For how long (s) a robot has which speeds (m/s along its way, rad/s).
struct vpPlannedLeg {
  double duration, v, w;
};

//! A robot that drives leg by leg, its speeds changing within a tenth of a second as motors do.
class vpPlannedDrive
{
public:
  //! \param heading rad, of the way in the base's frame: wheels that are turned against it.
  vpPlannedDrive(vpPlannedPlace start, const std::vector<vpPlannedLeg> &legs, double heading = 0)
      : m_heading(heading)
  {
    static const double lag = 0.05; // s, of the motors
    double v = 0, w = 0;
    m_places.push_back(start);
    for (const vpPlannedLeg &leg : legs) {
      for (int k = 0; k < std::lround(leg.duration / step); ++k) {
        v += (leg.v - v) * step / lag;
        w += (leg.w - w) * step / lag;
        vpPlannedPlace next = m_places.back();
        const double along = next.yaw + heading + 0.5 * w * step;
        next.x += v * step * std::cos(along);
        next.y += v * step * std::sin(along);
        next.yaw += w * step;
        m_places.push_back(next);
        m_ways.push_back(m_ways.empty() ? v * step : m_ways.back() + v * step);
      }
    }
  }

  double duration() const { return static_cast<double>(m_places.size() - 1) * step; }

  vpPlannedPlace at(double t) const
  {
    const double k = std::clamp(t / step, 0.0, static_cast<double>(m_places.size()) - 1);
    const auto i = std::min(static_cast<size_t>(k), m_places.size() - 2);
    const double share = k - static_cast<double>(i);
    const vpPlannedPlace &a = m_places[i], &b = m_places[i + 1];
    return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), a.yaw + share * (b.yaw - a.yaw)};
  }

  //! What exact wheels say of it.
  std::vector<vpOdometry> odometry(double interval) const
  {
    std::vector<vpOdometry> samples{{0, 0, 0}};
    for (double t = interval; t <= duration() + 1e-9; t += interval) {
      samples.push_back(
          {t, (wayAt(t) - wayAt(t - interval)) / interval, (at(t).yaw - at(t - interval).yaw) / interval});
    }
    return samples;
  }

private:
  static constexpr double step = 1e-3; // s

  double wayAt(double t) const
  {
    const auto k = static_cast<long>(std::lround(t / step)) - 1;
    return k < 0 ? 0 : m_ways[std::min(static_cast<size_t>(k), m_ways.size() - 1)];
  }

  double m_heading;
  std::vector<vpPlannedPlace> m_places;
  std::vector<double> m_ways; // m, from the start
};

/*!
  A ceiling and what a camera under it sees of its lamps, without any picture: their middles, at the time of
  their lines, with noise. 800 x 600 pixels read within 66 ms, as the paper's.
*/
class vpSeenLamps
{
public:
  vpVlpRig rig;             // as claimed
  vpLampMap map;            // as claimed
  double pointSigma = 0.03; // px, of a lamp's middle, as observations state it

  //! \param lamps How many there are: up to four, 1.6 m above the camera.
  explicit vpSeenLamps(size_t lamps) : vpSeenLamps(places(lamps)) {}

  //! \param positions Of the lamps, m.
  explicit vpSeenLamps(const std::vector<Eigen::Vector3d> &positions)
  {
    rig.width = 800;
    rig.height = 600;
    rig.camera.initPersProjWithoutDistortion(400, 400, 399.5, 299.5);
    rig.shutter.rowTime = 110e-6;
    rig.shutter.exposure = 43e-6;
    rig.bMc[0][3] = 0.05;
    rig.bMc[1][3] = 0.02;
    rig.bMc[2][3] = 0.2;
    for (size_t k = 0; k < positions.size(); ++k) {
      vpLamp lamp;
      lamp.id = std::string(1, static_cast<char>('A' + k));
      lamp.position = positions[k];
      lamp.size = 0.175;
      lamp.modulation.kind = vpModulation::Kind::pwm;
      lamp.modulation.frequency = 1500 + 500 * static_cast<double>(k);
      map.lamps.push_back(lamp);
    }
    asClaimed();
  }

  //! All is as rig and map say.
  void asClaimed()
  {
    m_bMc = rig.bMc;
    m_camera = rig.camera;
    m_hung.clear();
    for (const vpLamp &lamp : map.lamps) {
      m_hung.push_back(lamp.position);
    }
  }

  //! Rig and map state what a careful installer reaches, and are off by \e proud times that.
  void claim(double proud, std::mt19937_64 &generator)
  {
    static const double place = 0.002, lean = 0.15 * M_PI / 180, centre = 1, focal = 0.003; // m, rad, px
    std::normal_distribution<double> normal(0, proud);
    for (vpLamp &lamp : map.lamps) {
      lamp.positionSigma = place;
    }
    rig.rotationSigma << lean, lean, lean;
    rig.principalPointSigma = centre;
    rig.focalLengthSigma = focal;
    asClaimed();
    for (Eigen::Vector3d &position : m_hung) {
      position += place * Eigen::Vector3d(normal(generator), normal(generator), normal(generator));
    }
    turn(lean * Eigen::Vector3d(normal(generator), normal(generator), normal(generator)));
    const double f = rig.camera.get_px() * (1 + focal * normal(generator));
    m_camera.initPersProjWithoutDistortion(f, f, rig.camera.get_u0() + centre * normal(generator),
                                           rig.camera.get_v0() + centre * normal(generator));
  }

  //! The camera is turned by a small rotation about its own centre, which the rig does not say.
  void turn(const Eigen::Vector3d &rotation)
  {
    m_bMc =
        vpHomogeneousMatrix(vpTranslationVector(), vpThetaUVector(rotation.x(), rotation.y(), rotation.z())) *
        rig.bMc;
    for (unsigned int i = 0; i < 3; ++i) {
      m_bMc[i][3] = rig.bMc[i][3];
    }
  }

  //! Where a lamp truly hangs, m.
  Eigen::Vector3d &hung(size_t lamp) { return m_hung[lamp]; }

  /*!
    What is seen in a frame. \param path The base at a time, s. \param lit Which lamps shine.
  */
  template <class Path>
  std::vector<vpLampObservation> see(double timestamp, const Path &path, std::mt19937_64 &generator,
                                     const std::vector<bool> &lit = {}) const
  {
    std::normal_distribution<double> normal(0, pointSigma);
    const vpLineTiming timing = rig.lineTiming();
    std::vector<vpLampObservation> seen;
    for (size_t k = 0; k < m_hung.size(); ++k) {
      Eigen::Vector2d pixel(0, 0.5 * rig.height);
      double depth = 0;
      for (int round = 0; round < 4; ++round) { // the line gives the time, the time gives the line
        depth = project(m_hung[k], path(timestamp + timing.middleAt(pixel.y())).wMb(), pixel);
      }
      const double radius = 0.5 * map.lamps[k].size * rig.camera.get_px() / depth;
      if ((k < lit.size() && !lit[k]) || pixel.x() < radius || pixel.y() < radius ||
          pixel.x() > rig.width - 1 - radius || pixel.y() > rig.height - 1 - radius) {
        continue;
      }
      vpLampObservation lamp;
      lamp.id = map.lamps[k].id;
      lamp.confidence = 1;
      lamp.point = pixel + Eigen::Vector2d(normal(generator), normal(generator));
      lamp.covariance = pointSigma * pointSigma * Eigen::Matrix2d::Identity();
      lamp.outline.shape = vpLampOutline::Shape::ellipse;
      lamp.outline.centre = lamp.point;
      // Lines that are read while the picture runs ahead of the readout see more of it.
      static const double moment = 1e-3; // s
      Eigen::Vector2d later;
      project(m_hung[k], path(timestamp + timing.middleAt(pixel.y()) + moment).wMb(), later);
      const double stretch = 1 / (1 - (later.y() - pixel.y()) / moment * timing.meanLineTime());
      lamp.outline.a = radius * std::max(1.0, stretch);
      lamp.outline.b = radius * std::min(1.0, stretch);
      lamp.outline.angle = stretch > 1 ? M_PI / 2 : 0;
      lamp.outline.centreCovariance = lamp.covariance;
      lamp.time = timing.middleAt(lamp.point.y());
      seen.push_back(lamp);
    }
    return seen;
  }

private:
  static std::vector<Eigen::Vector3d> places(size_t lamps)
  {
    const std::vector<Eigen::Vector3d> all = {
        {-0.5, -0.4, 1.8}, {0.5, 0.4, 1.85}, {0.45, -0.45, 1.9}, {-0.4, 0.5, 1.95}};
    return {all.begin(), all.begin() + static_cast<long>(lamps)};
  }

  //! \return m, along the camera's axis.
  double project(const Eigen::Vector3d &position, const vpHomogeneousMatrix &wMb,
                 Eigen::Vector2d &pixel) const
  {
    const vpColVector c = (wMb * m_bMc).inverse() *
                          vpColVector(std::vector<double>{position.x(), position.y(), position.z(), 1});
    vpMeterPixelConversion::convertPoint(m_camera, c[0] / c[2], c[1] / c[2], pixel.x(), pixel.y());
    return c[2];
  }

  vpHomogeneousMatrix m_bMc;           // as it is
  vpCameraParameters m_camera;         // likewise
  std::vector<Eigen::Vector3d> m_hung; // m, likewise
};

//! Horizontal, m.
inline double vpErrorOf(const vpVlpFix &fix, const vpPlannedPlace &truth)
{
  return std::hypot(fix.wMb[0][3] - truth.x, fix.wMb[1][3] - truth.y);
}

//! Of x, y and yaw the one that is farthest off, in its standard deviations.
inline double vpSigmasOff(const vpVlpFix &fix, const vpPlannedPlace &truth)
{
  const double turn = std::remainder(std::atan2(fix.wMb[1][0], fix.wMb[0][0]) - truth.yaw, 2 * M_PI);
  return std::max({std::abs(fix.wMb[0][3] - truth.x) / std::sqrt(fix.covariance(0, 0)),
                   std::abs(fix.wMb[1][3] - truth.y) / std::sqrt(fix.covariance(1, 1)),
                   std::abs(turn) / std::sqrt(fix.covariance(5, 5))});
}

#endif
