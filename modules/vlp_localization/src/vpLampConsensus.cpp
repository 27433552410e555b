/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLampConsensus.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/LU>
#include <visp3/core/vpMeterPixelConversion.h>
#include <visp3/vlp_core/vpNumberText.h>

#include "vpLampGeometry.h"

BEGIN_VISP_NAMESPACE

namespace
{

//! Probability that a chi-square of \e degrees of freedom exceeds \e x: Q(degrees / 2, x / 2) by its
//! recurrence.
double chiSquareTail(double x, int degrees)
{
  if (degrees <= 0) {
    return 1;
  }
  const double h = 0.5 * x;
  const bool odd = degrees % 2 == 1;
  double tail = odd ? std::erfc(std::sqrt(h)) : std::exp(-h);
  double term = odd ? 2 * std::sqrt(h / M_PI) * std::exp(-h) : h * std::exp(-h);
  for (int k = odd ? 3 : 4; k <= degrees; k += 2) {
    tail += term;
    term *= h / (0.5 * k);
  }
  return tail;
}

std::string joined(const std::vector<std::string> &ids)
{
  std::string text;
  for (const std::string &id : ids) {
    text += (text.empty() ? "" : ", ") + id;
  }
  return text;
}

Eigen::Vector3d inCamera(const Eigen::Vector3d &p, const vpHomogeneousMatrix &cMw)
{
  Eigen::Vector3d c;
  for (unsigned int i = 0; i < 3; ++i) {
    c(i) = cMw[i][0] * p.x() + cMw[i][1] * p.y() + cMw[i][2] * p.z() + cMw[i][3];
  }
  return c;
}

//! Along the camera's axis, m.
double depthOf(const Eigen::Vector3d &p, const vpHomogeneousMatrix &cMw)
{
  return inCamera(p, cMw).z();
}

/*!
  Mean diameter, px, that the picture of a lamp has from there: of the ellipse that the lens, near its middle,
  makes of a circle of its size, half the sum of the singular values of that map. NaN behind the camera.
*/
double diameterOf(const vpLamp &lamp, const vpHomogeneousMatrix &cMw, const vpCameraParameters &camera)
{
  Eigen::Matrix2d across; // px, of the lamp along x and y of the map
  for (int axis = 0; axis < 2; ++axis) {
    Eigen::Vector2d ends[2];
    for (int k = 0; k < 2; ++k) {
      const Eigen::Vector3d c =
          inCamera(lamp.position + (k - 0.5) * lamp.size * Eigen::Vector3d::Unit(axis), cMw);
      if (!(c.z() > 0)) {
        return NAN;
      }
      vpMeterPixelConversion::convertPoint(camera, c.x() / c.z(), c.y() / c.z(), ends[k].x(), ends[k].y());
    }
    across.col(axis) = ends[1] - ends[0];
  }
  return 0.5 * std::sqrt(across.squaredNorm() + 2 * std::abs(across.determinant()));
}

} // namespace

vpLampConsensus::vpLampConsensus(std::vector<const vpLamp *> lamps, const vpVlpRig &rig,
                                 const std::vector<vpLampObservation> &observations, double mapTolerance,
                                 double outlierLikelihood)
    : m_lamps(std::move(lamps)), m_rig(rig), m_observations(observations), m_tolerance(mapTolerance),
      m_likelihood(outlierLikelihood)
{
}

void vpLampConsensus::usable(std::vector<vpLampObservation> &observations, std::vector<size_t> &which)
{
  // Two standard deviations of the middle lie within the lamp; how much such a lamp tells its covariance
  // says.
  static const double placed = 0.25; // share of the diameter
  which.clear();
  for (size_t i = 0; i < observations.size(); ++i) {
    vpLampObservation &lamp = observations[i];
    if (lamp.id.empty() && lamp.candidates.empty()) {
      continue;
    }
    const double sigma = std::sqrt(lamp.covariance.trace());
    if (lamp.outline.shape == vpLampOutline::Shape::region || !(sigma < placed * lamp.outline.diameter())) {
      lamp.remark =
          lamp.cut ? "cut by the picture's border: its middle is uncertain" : "its middle is uncertain";
    } else {
      which.push_back(i);
    }
  }
}

std::vector<vpLampSight> vpLampConsensus::sights(const std::vector<size_t> &which) const
{
  std::vector<vpLampSight> lamps;
  for (size_t i : which) {
    lamps.push_back(vpLampSight::from(*m_lamps[i], m_observations[i], m_rig.camera));
  }
  return lamps;
}

/*!
  Chi-square of a fix's residuals under the rays' doubt and the map's tolerance. The fix minimises another
  sum, so this is no less than the least there is.
*/
double vpLampConsensus::misfit(const vpVlpFix &fix, const std::vector<vpLampSight> &lamps) const
{
  const vpHomogeneousMatrix cMw = fix.wMc.inverse();
  double sum = 0;
  for (size_t i = 0; i < fix.lamps.size(); ++i) {
    const auto lamp = std::find_if(lamps.begin(), lamps.end(),
                                   [&](const vpLampSight &sight) { return sight.id == fix.lamps[i]; });
    const double sigma = std::max(lamp->positionSigma, m_tolerance) / depthOf(lamp->position, cMw);
    const Eigen::Matrix2d doubt = lamp->covariance + sigma * sigma * Eigen::Matrix2d::Identity();
    sum += fix.residuals[i].dot(doubt.inverse() * fix.residuals[i]);
  }
  return sum;
}

bool vpLampConsensus::agree(const vpVlpFix &fix, const std::vector<vpLampSight> &lamps) const
{
  return fix.valid && chiSquareTail(misfit(fix, lamps), fix.degreesOfFreedom) > m_likelihood;
}

/*!
  Lamps of a fix that look larger or smaller from there than the map's size makes them. \param remark Says so
  of the first one.
*/
std::vector<std::string> vpLampConsensus::wrongSizes(const vpVlpFix &fix, const std::vector<size_t> &usable,
                                                     std::string &remark) const
{
  // The map may mean the housing, and the picture shows the light.
  static const double tolerance = 0.3; // of the size
  static const double coarse = 3;      // px
  const vpHomogeneousMatrix cMw = fix.wMc.inverse();
  std::vector<std::string> wrong;
  for (size_t i : usable) {
    const vpLampObservation &seen = m_observations[i];
    const vpLamp *lamp = m_lamps[i];
    if (lamp == nullptr || !std::isfinite(lamp->size) || seen.cut ||
        std::find(fix.lamps.begin(), fix.lamps.end(), seen.id) == fix.lamps.end()) {
      continue;
    }
    const double expected = diameterOf(*lamp, cMw, m_rig.camera), found = seen.outline.diameter();
    if (!(std::abs(found - expected) <= tolerance * expected + coarse)) {
      if (wrong.empty()) {
        remark = "lamp " + seen.id + " looks " + vpNumberText(std::round(found)) + " px large, expected " +
                 vpNumberText(std::round(expected)) + " px by its size in the map";
      }
      wrong.push_back(seen.id);
    }
  }
  return wrong;
}

/*!
  A fix without lamps of wrong size: what was taken for such a lamp may be something else, or its outline be
  spoilt. Where these are half of all lamps or more, the place may be what is wrong.
*/
vpVlpFix vpLampConsensus::withoutWrongSizes(const vpVlpFix &all, const std::vector<size_t> &usable,
                                            std::vector<vpLampSight> &lamps, const Solve &solver) const
{
  const size_t most = (lamps.size() - 1) / 2;
  size_t dropped = 0;
  vpVlpFix fix = all;
  std::string remark;
  for (std::vector<std::string> wrong; fix.valid && !(wrong = wrongSizes(fix, usable, remark)).empty();) {
    dropped += wrong.size();
    if (dropped > most) {
      return refusedFix(remark);
    }
    lamps.erase(std::remove_if(lamps.begin(), lamps.end(),
                               [&](const vpLampSight &lamp) {
                                 return std::find(wrong.begin(), wrong.end(), lamp.id) != wrong.end();
                               }),
                lamps.end());
    fix = solver(lamps);
  }
  return fix;
}

vpVlpFix vpLampConsensus::solve(const std::vector<size_t> &usable, const Solve &solver) const
{
  static const size_t fewest = 2;
  if (usable.size() < fewest) {
    return refusedFix(tooFewLamps(usable.size()));
  }
  std::vector<vpLampSight> lamps = sights(usable);
  vpVlpFix fix = solver(lamps);
  // One of three could be any of them, and some few of many always agree by chance.
  const size_t fewestLeft = usable.size() - usable.size() / 4;
  while (fix.valid && !agree(fix, lamps)) {
    if (lamps.size() <= fewestLeft) {
      return refusedFix("lamps " + joined(fix.lamps) + " do not agree on one place");
    }
    fix = withoutWorst(lamps, solver);
  }
  if (fix.valid) {
    fix = withoutMisplaced(fix, lamps, solver);
    fix = withoutWrongSizes(fix, usable, lamps, solver);
  }
  if (fix.valid && fix.degreesOfFreedom > 0) {
    fix.covariance *= std::max(1.0, fix.chiSquare / fix.degreesOfFreedom);
  }
  return fix;
}

/*!
  A fix without the one lamp that is elsewhere than the map says, where that is as good as certain: under what
  map and pictures say of themselves, all lamps contradict each other, without that lamp they do not, and
  without any other they still do.
*/
vpVlpFix vpLampConsensus::withoutMisplaced(const vpVlpFix &all, std::vector<vpLampSight> &lamps,
                                           const Solve &solver) const
{
  static const double contradiction = 1e-6, agreement = 0.01; // probabilities
  static const int enough = 4; // degrees of freedom: of three lamps left, two bear the third out
  auto likelihood = [](const vpVlpFix &fix) {
    return fix.valid ? chiSquareTail(fix.chiSquare, fix.degreesOfFreedom) : 0;
  };
  if (all.degreesOfFreedom < enough || likelihood(all) > contradiction) {
    return all;
  }
  vpVlpFix best = all;
  std::vector<vpLampSight> kept = lamps;
  for (size_t left = 0; left < lamps.size(); ++left) {
    std::vector<vpLampSight> others = lamps;
    others.erase(others.begin() + static_cast<long>(left));
    const vpVlpFix fix = solver(others);
    const double likely = likelihood(fix);
    if (likely > contradiction && likelihood(best) > contradiction) {
      return all; // it may be one or the other
    }
    if (likely > agreement) {
      best = fix;
      kept = others;
    }
  }
  lamps = kept;
  return best;
}

//! Drops the lamp that the others agree best without.
vpVlpFix vpLampConsensus::withoutWorst(std::vector<vpLampSight> &lamps, const Solve &solver) const
{
  std::vector<vpLampSight> kept = lamps;
  vpVlpFix best = refusedFix("no lamps agree on one place");
  double least = 0;
  for (size_t left = 0; left < lamps.size(); ++left) {
    std::vector<vpLampSight> others = lamps;
    others.erase(others.begin() + static_cast<long>(left));
    vpVlpFix fix = solver(others);
    if (!fix.valid) {
      continue;
    }
    const double chiSquare = misfit(fix, others);
    if (!best.valid || chiSquare < least) {
      best = fix;
      least = chiSquare;
      kept = others;
    }
  }
  lamps = kept;
  return best;
}

void vpLampConsensus::explain(const vpVlpFix &fix, const std::vector<size_t> &usable,
                              std::vector<vpLampObservation> &observations)
{
  for (size_t i : usable) {
    vpLampObservation &lamp = observations[i];
    const bool member = std::find(fix.lamps.begin(), fix.lamps.end(), lamp.id) != fix.lamps.end();
    lamp.accepted = fix.valid && member;
    if (!lamp.accepted) {
      lamp.remark = !fix.valid              ? fix.refusal
                    : fix.lamps.size() == 2 ? "not of the pair with the best geometry"
                                            : elsewhere;
    }
  }
}

END_VISP_NAMESPACE
