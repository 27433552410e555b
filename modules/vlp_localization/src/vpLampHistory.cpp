/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLampHistory.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "vpLampPicture.h"

BEGIN_VISP_NAMESPACE

namespace
{
const int known = 3; // frames after which a lamp's place and size are its own

//! Width and height of an outline over the expected ones.
Eigen::Vector2d relativeSize(const vpLampOutline &outline, const vpLampExtent &expected)
{
  const Eigen::Vector4d box = outline.box();
  return (box.tail<2>() - box.head<2>()).cwiseQuotient(expected.size);
}

//! Of a lamp as seen by a robot that may move.
vpLampExtent extentFrom(const vpLampFrame &frame, const vpFrameLamp &lamp, const vpHomogeneousMatrix &wMb)
{
  static const double moving = 0.01; // stretch of a lamp by an unknown velocity, standard deviation
  const vpLampPicture picture(*lamp.lamp, vpBasePose::of(wMb), *frame.rig);
  return {picture.extent(Eigen::Vector3d::Zero(), frame.lineTime), moving};
}

//! Of the latest of \e frames in a running mean, which is slower than people walk.
double shareOf(int frames)
{
  return std::max(0.03, 1.0 / frames);
}
} // namespace

const vpLampHistory::Past *vpLampHistory::find(const vpLamp &lamp) const
{
  const auto found = m_past.find(lamp.id);
  return found == m_past.end() ? nullptr : &found->second;
}

std::string vpLampHistory::changed(const vpLamp &lamp, const vpLampObservation &seen,
                                   const vpLampExtent &expected)
{
  const auto found = m_past.find(lamp.id);
  if (found == m_past.end() || found->second.sizes < known || seen.cut || !(expected.size.minCoeff() > 0)) {
    return "";
  }
  Past &past = found->second;
  static const double coarse = 0.15; // px
  static const int patience = 60;    // frames in a row, after which a lamp is of another size for good
  const Eigen::Vector2d size = relativeSize(seen.outline, expected);
  const Eigen::Vector2d tolerance =
      (sizeTolerance + gate * expected.stretch) * past.size + coarse * expected.size.cwiseInverse();
  const Eigen::Vector2d more = (size - past.size).cwiseQuotient(tolerance);
  const bool smaller = more.minCoeff() < -1 || seen.outline.shape != past.shape,
             larger = more.maxCoeff() > 1 && !smaller;
  past.changed = smaller || larger ? past.changed + 1 : 0;
  if (past.changed > patience) {
    past.size = size;
    past.shape = seen.outline.shape;
    past.changed = 0;
    return "";
  }
  return smaller ? "not as large as it was: partly hidden" : larger ? "larger than it was" : "";
}

void vpLampHistory::seeFrom(const vpLampFrame &frame, const vpHomogeneousMatrix &wMb)
{
  double logs = 0;
  int lamps = 0;
  for (const vpFrameLamp &lamp : frame.lamps) {
    const Past *past = find(*lamp.lamp);
    const vpLampExtent extent = extentFrom(frame, lamp, wMb);
    if (lamp.seen->accepted && past != nullptr && past->sizes >= known && !lamp.seen->cut &&
        extent.size.minCoeff() > 0) {
      logs += relativeSize(lamp.seen->outline, extent).cwiseQuotient(past->size).array().log().mean();
      ++lamps;
    }
  }
  if (lamps < 2) {
    return; // one lamp alone may be partly hidden
  }
  for (auto &[id, past] : m_past) {
    past.size *= std::exp(logs / lamps);
  }
}

bool vpLampHistory::looksAsBefore(const vpLampFrame &frame, const vpHomogeneousMatrix &wMb) const
{
  vpLampHistory there = *this; // which counts, too, how often it is asked
  there.seeFrom(frame, wMb);
  return std::all_of(frame.lamps.begin(), frame.lamps.end(), [&](const vpFrameLamp &lamp) {
    return !lamp.seen->accepted ||
           there.changed(*lamp.lamp, *lamp.seen, extentFrom(frame, lamp, wMb)).empty();
  });
}

bool vpLampHistory::isStranger(const vpLamp &lamp) const
{
  const Past *past = find(lamp);
  return past != nullptr && past->stranger;
}

void vpLampHistory::setStranger(const vpLamp &lamp, bool stranger)
{
  Past &past = m_past[lamp.id];
  past.stranger = stranger;
  past.away.reset();
  past.strayed = 0;
}

double vpLampHistory::logStill(const vpLamp &lamp, const vpVlpFilter::Innovation &innovation) const
{
  const Past *past = find(lamp);
  return past == nullptr || !past->away ? -std::numeric_limits<double>::infinity()
                                        : logNormal(innovation.ray - innovation.byPlace * *past->away,
                                                    past->awayCovariance + innovation.covariance);
}

double vpLampHistory::addStranger(const vpLamp &lamp, const vpVlpFilter::Innovation &innovation)
{
  Past &past = m_past[lamp.id];
  const double before = past.strayed;
  const bool isFirst = !past.away;
  if (!isFirst) {
    const Eigen::Vector2d ray = innovation.ray - innovation.byPlace * *past.away;
    const Eigen::Matrix2d S = past.awayCovariance + innovation.covariance;
    past.strayed = std::max(before, 0.5 * ray.dot(S.inverse() * ray));
  }
  // Errors of the pose are alike from frame to frame: a mean would be no better than the most exact of them.
  if (isFirst || innovation.covariance.trace() < past.awayCovariance.trace()) {
    past.away = innovation.byPlace.inverse() * innovation.ray;
    past.awayCovariance = innovation.covariance;
  }
  past.stranger = true;
  return past.strayed - before;
}

double vpLampHistory::tolerance(const vpLamp &lamp) const
{
  const Past *past = find(lamp);
  return past == nullptr         ? mapTolerance
         : past->places >= known ? placeTolerance
         : past->stranger        ? strangerTolerance
                                 : mapTolerance;
}

Eigen::Vector2d vpLampHistory::offset(const vpLamp &lamp) const
{
  static const double chance = 13.8; // chi-square of two, 1 in 1000
  const Past *past = find(lamp);
  const bool isOff = past != nullptr && past->places >= known &&
                     past->offset.dot(past->covariance.inverse() * past->offset) > chance;
  return isOff ? past->offset : Eigen::Vector2d(0, 0);
}

void vpLampHistory::forgetPlaces()
{
  for (auto &[id, past] : m_past) {
    past.places = 0;
    past.offset.setZero();
    past.covariance.setZero();
  }
}

void vpLampHistory::add(const vpLamp &lamp, const vpLampObservation &seen,
                        const vpVlpFilter::Innovation &innovation, const vpLampExtent &expected)
{
  setStranger(lamp, false);
  Past &past = m_past[lamp.id];
  const double share = shareOf(++past.places);
  past.offset += share * (innovation.ray - past.offset);
  past.covariance = (1 - share) * (1 - share) * past.covariance + share * share * innovation.covariance;
  static const double sure = 0.004; // of the stretch
  if (!seen.cut && expected.size.minCoeff() > 0 && expected.stretch < sure) {
    past.shape = past.sizes == 0 ? seen.outline.shape : past.shape;
    past.size += shareOf(++past.sizes) * (relativeSize(seen.outline, expected) - past.size);
  }
}

END_VISP_NAMESPACE
