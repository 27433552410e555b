/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpBundleStart.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <visp3/core/vpPixelMeterConversion.h>
#include <visp3/vlp_core/vpPoseText.h>
#include <visp3/vlp_localization/vpManyLampSolver.h>

BEGIN_VISP_NAMESPACE

namespace
{
using Motion = vpLampRun::Motion;

const char *const noStart =
    "no frame shows two lamps whose places are known; begin where two of them are in view, "
    "and check with vlp-locate --overlay that they are recognised";

bool hasPrior(const vpLampBundle &bundle, size_t lamp)
{
  return std::isfinite(bundle.lampSigma[lamp]);
}

//! The lamps of a view whose place is known, as the solvers want them.
std::vector<vpLampSight> sightsOf(const std::vector<bool> &known, const vpLampView &view, const vpVlpRig &rig,
                                  const vpLampMap &map)
{
  std::vector<vpLampSight> sights;
  for (const vpLampImage &image : view.images) {
    if (known[image.lamp]) {
      vpLampObservation seen;
      seen.point = image.point;
      seen.covariance = image.covariance;
      sights.push_back(vpLampSight::from(map.lamps[image.lamp], seen, rig.camera));
    }
  }
  return sights;
}

//! Ray of an image, upright in b but for the base's yaw.
Eigen::Vector3d rayInBase(const vpLampImage &image, const vpVlpRig &rig)
{
  double x = 0, y = 0;
  vpPixelMeterConversion::convertPoint(rig.camera, image.point.x(), image.point.y(), x, y);
  return vpQuaternionOf(rig.bMc) * Eigen::Vector3d(x, y, 1).normalized();
}

double nearestTurn(double angle, double to)
{
  return to + std::remainder(angle - to, 2 * M_PI);
}
} // namespace

vpBundleStart::vpBundleStart(const vpLampBundle &bundle, const std::vector<vpLampRun> &runs,
                             const vpVlpRig &given, const vpLampMap &givenMap)
    : rig(given), map(givenMap)
{
  for (size_t r = 0; r < runs.size(); ++r) {
    paths.emplace_back(runs[r].odometry);
    for (size_t v = 0; v < runs[r].views.size(); ++v) {
      const vpLampView &view = runs[r].views[v];
      if (view.images.empty()) {
        continue;
      }
      vpBundleView entry;
      entry.run = r;
      entry.view = v;
      entry.time = view.middle();
      entry.used.assign(view.images.size(), true);
      for (const vpLampImage &image : view.images) {
        entry.points.push_back(image.point);
      }
      views.push_back(entry);
    }
  }
  m_placed.assign(views.size(), false);
  for (size_t k = 0; k < map.lamps.size(); ++k) {
    m_known.push_back(hasPrior(bundle, k));
  }
  if (bundle.distance) {
    placeByWheels(runs);
  } else {
    placeByLamps(runs);
    turnHeading(bundle, runs);
    // From where lamps are known to those beside them, and on.
    while (placeLamps(bundle, runs) && placeByLamps(runs)) {
    }
    followWheels(runs);
  }
  dropUnplaced();
  if (views.empty()) {
    refusal = bundle.distance ? "a distance alone needs odometry, which says how the robot went; expected "
                                "odometry.csv over the time of the frames"
                              : noStart;
    return;
  }
  placeLamps(bundle, runs);
  if (bundle.distance) {
    alignToDistance(bundle, givenMap);
  }
  followImages(runs);
}

//! Poses of known places, and of frames that show two lamps that are known. \return Whether there are new
//! ones.
bool vpBundleStart::placeByLamps(const std::vector<vpLampRun> &runs)
{
  const vpManyLampSolver solver;
  bool any = false;
  for (size_t i = 0; i < views.size(); ++i) {
    if (m_placed[i]) {
      continue;
    }
    const vpLampRun &run = runs[views[i].run];
    std::optional<vpHomogeneousMatrix> wMb;
    if (run.motion == Motion::known) {
      static const double gap = 0.5; // s
      wMb = run.places.at(run.views[views[i].view].timestamp, gap);
    } else {
      const std::vector<vpLampSight> sights = sightsOf(m_known, run.views[views[i].view], rig, map);
      const vpVlpFix fix = sights.size() < 2 ? vpVlpFix() : solver.solve(sights, rig);
      if (fix.valid && !fix.ambiguous) {
        wMb = fix.wMb;
      }
    }
    if (wMb) {
      const double yaw = vpRollPitchYaw(*wMb).z();
      const bool follows = i > 0 && m_placed[i - 1] && views[i - 1].run == views[i].run;
      views[i].start = {(*wMb)[0][3], (*wMb)[1][3], follows ? nearestTurn(yaw, views[i - 1].start(2)) : yaw};
      m_placed[i] = any = true;
    }
  }
  return any;
}

//! All poses by odometry alone, from the map's origin.
void vpBundleStart::placeByWheels(const std::vector<vpLampRun> &runs)
{
  for (size_t i = 0; i < views.size(); ++i) {
    const vpLampRun &run = runs[views[i].run];
    if (run.odometry.empty() || views[i].run != 0) {
      continue; // nothing ties a second run to the first one before the lamps have their places
    }
    if (const auto step = paths[0].roughStep(run.odometry.front().timestamp, views[i].time)) {
      views[i].start = vpAfter(vpPlanarPose::Zero(), *step);
      m_placed[i] = true;
    }
  }
}

//! Poses of the other frames along the odometry, from a neighbour, first onwards, then backwards.
void vpBundleStart::followWheels(const std::vector<vpLampRun> &runs)
{
  const auto follow = [&](size_t from, size_t to) {
    if (m_placed[to] || !m_placed[from] || views[from].run != views[to].run ||
        runs[views[to].run].motion == Motion::known) {
      return;
    }
    if (const auto step = paths[views[to].run].roughStep(views[from].time, views[to].time)) {
      views[to].start = vpAfter(views[from].start, *step);
      m_placed[to] = true;
    }
  };
  for (size_t i = 1; i < views.size(); ++i) {
    follow(i - 1, i);
  }
  for (size_t i = views.size(); i-- > 1;) {
    follow(i, i - 1);
  }
  // Turns counted on from frame to frame: a pose that lamps gave is one of many, all full turns apart.
  for (size_t i = 1; i < views.size(); ++i) {
    if (!m_placed[i] || !m_placed[i - 1] || views[i].run != views[i - 1].run) {
      continue;
    }
    const auto step = paths[views[i].run].roughStep(views[i - 1].time, views[i].time);
    views[i].start(2) = nearestTurn(views[i].start(2), views[i - 1].start(2) + (step ? step->turn : 0));
  }
}

void vpBundleStart::dropUnplaced()
{
  std::vector<vpBundleView> placed;
  for (size_t i = 0; i < views.size(); ++i) {
    if (m_placed[i]) {
      placed.push_back(views[i]);
    }
  }
  views = placed;
  m_placed.assign(views.size(), true);
}

/*!
  A mount whose heading is far off: a base that rolls shows it by the way that it goes. The rig is turned by
  the mean angle between that way and its heading.
*/
void vpBundleStart::turnHeading(const vpLampBundle &bundle, const std::vector<vpLampRun> &runs)
{
  if (!std::isinf(bundle.rigSigma(static_cast<int>(vpRigParameter::yaw)))) {
    return;
  }
  std::complex<double> mean = 0;
  size_t last = 0;
  for (size_t i = 1; i < views.size(); ++i) {
    if (!m_placed[i] || runs[views[i].run].motion != Motion::wheels) {
      continue;
    }
    if (!m_placed[last] || views[last].run != views[i].run) {
      last = i;
      continue;
    }
    const auto step = paths[views[i].run].roughStep(views[last].time, views[i].time);
    const Eigen::Vector2d way = (views[i].start - views[last].start).head<2>();
    static const double least = 0.02; // m: shorter ways say little
    if (!step || way.norm() < least) {
      continue;
    }
    const std::complex<double> went(way.x(), way.y()),
        said = std::polar(1.0, views[last].start(2)) * std::complex<double>(step->x, step->y);
    mean += went * std::conj(said);
    last = i;
  }
  static const double far = 0.1; // rad: the rest is left to the adjustment
  const double turn = std::arg(mean);
  if (std::abs(mean) > 0 && std::abs(turn) > far) {
    // The base heads where it goes; the camera, which the lamps saw right, stays.
    vpRigVector step = vpRigVector::Zero();
    step(static_cast<int>(vpRigParameter::yaw)) = -turn;
    const Eigen::Vector3d before(rig.bMc[0][3], rig.bMc[1][3], 0);
    rig = vpMovedRig(rig, step);
    for (vpBundleView &view : views) {
      const Eigen::Vector2d camera =
          view.start.head<2>() + (Eigen::Rotation2Dd(view.start(2)) * before.head<2>());
      view.start(2) += turn;
      view.start.head<2>() = camera - Eigen::Rotation2Dd(view.start(2)) * before.head<2>();
    }
  }
}

/*!
  Lamps whose map position is no prior, each where its rays from the poses so far come nearest to each other.
  \return Whether new ones are known, by rays that come from enough directions.
*/
bool vpBundleStart::placeLamps(const vpLampBundle &bundle, const std::vector<vpLampRun> &runs)
{
  struct Rays {
    int count = 0;
    Eigen::Matrix3d across = Eigen::Matrix3d::Zero(); // sum of what is across each ray
    Eigen::Vector3d through = Eigen::Vector3d::Zero();
  };
  std::vector<Rays> rays(map.lamps.size());
  const Eigen::Vector3d btc(rig.bMc[0][3], rig.bMc[1][3], rig.bMc[2][3]);
  for (size_t i = 0; i < views.size(); ++i) {
    if (!m_placed[i]) {
      continue;
    }
    const vpBundleView &entry = views[i];
    const Eigen::AngleAxisd wRb(entry.start(2), Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d eye = Eigen::Vector3d(entry.start(0), entry.start(1), 0) + wRb * btc;
    for (const vpLampImage &image : runs[entry.run].views[entry.view].images) {
      const Eigen::Vector3d ray = wRb * rayInBase(image, rig);
      const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - ray * ray.transpose();
      ++rays[image.lamp].count;
      rays[image.lamp].across += across;
      rays[image.lamp].through += across * eye;
    }
  }
  bool any = false;
  for (size_t k = 0; k < rays.size(); ++k) {
    const Rays &own = rays[k];
    const Eigen::Vector3d place = own.across.ldlt().solve(own.through);
    const double reach = (place - btc).norm();
    // A lamp seen from one place only keeps the map's position: its covariance shows what is wrong with it.
    if (!hasPrior(bundle, k) && place.allFinite() && place.z() > btc.z() && reach < 1000) {
      map.lamps[k].position = place;
      static const int fewest = 10;         // rays
      static const double leastAngle = 0.1; // rad, of the rays to their mean, root mean square
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread;
      const double least = spread.computeDirect(own.across, Eigen::EigenvaluesOnly).eigenvalues()(0);
      if (!m_known[k] && own.count >= fewest && least > leastAngle * leastAngle * own.count) {
        m_known[k] = any = true;
      }
    }
  }
  return any;
}

//! Turns and moves all so that the first lamp is where the map has it, and the second in the map's direction.
void vpBundleStart::alignToDistance(const vpLampBundle &bundle, const vpLampMap &given)
{
  const size_t a = bundle.distance->from, b = bundle.distance->to;
  const Eigen::Vector2d anchor = given.lamps[a].position.head<2>(), place = map.lamps[a].position.head<2>();
  const Eigen::Vector2d wanted = given.lamps[b].position.head<2>() - anchor;
  const Eigen::Vector2d way = (map.lamps[b].position - map.lamps[a].position).head<2>();
  const double turn = std::atan2(wanted.y(), wanted.x()) - std::atan2(way.y(), way.x());
  const Eigen::Rotation2Dd by(turn);
  for (vpLamp &lamp : map.lamps) {
    lamp.position.head<2>() = anchor + by * (lamp.position.head<2>() - place);
  }
  for (vpBundleView &view : views) {
    view.start.head<2>() = anchor + by * (view.start.head<2>() - place);
    view.start(2) += turn;
  }
}

//! How the base moves from each view's pose to its images: by odometry, else as fast as the views around
//! show.
void vpBundleStart::followImages(const std::vector<vpLampRun> &runs)
{
  for (size_t i = 0; i < views.size(); ++i) {
    vpBundleView &view = views[i];
    const vpLampRun &run = runs[view.run];
    const size_t before = i > 0 && views[i - 1].run == view.run ? i - 1 : i;
    const size_t after = i + 1 < views.size() && views[i + 1].run == view.run ? i + 1 : i;
    const double dt = views[after].time - views[before].time;
    static const double longest = 1; // s: over a longer gap, nothing is known of the speed
    const bool moves = run.motion != Motion::known && dt > 0 && dt < longest;
    const vpPlanarPose rate =
        moves ? vpPlanarPose((views[after].start - views[before].start) / dt) : vpPlanarPose(0, 0, 0);
    const double c = std::cos(view.start(2)), s = std::sin(view.start(2));
    const bool spins = run.motion == Motion::spin;
    for (const vpLampImage &image : run.views[view.view].images) {
      const double since = image.time - view.time;
      const auto step =
          run.motion == Motion::known ? std::nullopt : paths[view.run].step(view.time, image.time);
      vpPlanarStep by{since, 0, 0, since * rate(2), 0, 0, 0};
      if (step) {
        by = *step;
      } else if (!spins) {
        by.x = since * (c * rate(0) + s * rate(1));
        by.y = since * (-s * rate(0) + c * rate(1));
      }
      if (spins) {
        by.x = by.y = 0;
      }
      view.since.push_back(by);
    }
  }
}

END_VISP_NAMESPACE
