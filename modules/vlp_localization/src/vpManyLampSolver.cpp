/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_localization/vpManyLampSolver.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <opencv2/calib3d.hpp>
#include <visp3/vlp_localization/vpTwoLampSolver.h>

#include "vpLampGeometry.h"
#include "vpRayFit.h"

BEGIN_VISP_NAMESPACE

namespace
{
using Minimum = vpRayFit::Minimum;

// Weights are inverse covariances, which a lamp that is exact has not.
std::string weightProblem(const std::vector<vpLampSight> &lamps)
{
  for (const vpLampSight &lamp : lamps) {
    const Eigen::Matrix2d &C = lamp.covariance;
    if (!(C(0, 0) > 0 && C(1, 1) > 0 && C.determinant() > 1e-9 * C(0, 0) * C(1, 1)))
      return "lamp " + lamp.id + ": the covariance of its ray is singular";
  }
  return "";
}

bool onOneLine(const std::vector<vpLampSight> &lamps)
{
  Eigen::Matrix3Xd places(3, lamps.size());
  for (size_t k = 0; k < lamps.size(); ++k)
    places.col(k) = lamps[k].position;
  places.colwise() -= places.rowwise().mean().eval();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> scatter;
  scatter.computeDirect(places * places.transpose(), Eigen::EigenvaluesOnly);
  const double thinnest = 1e-3; // width over length
  return scatter.eigenvalues()(1) <= thinnest * thinnest * scatter.eigenvalues()(2);
}

/*
  Poses that three lamps in a row leave, up to four each (Grunert 1841; solved after Ke and Roumeliotis 2017).
  Lamps that are not all on one line have three in a row that are not.
*/
std::vector<vpBasePose> posesOfThrees(const std::vector<vpLampSight> &lamps, const vpMountFrame &mount)
{
  std::vector<vpBasePose> poses;
  for (size_t first = 0; first < (lamps.size() == 3 ? 1 : lamps.size()); ++first) {
    std::vector<cv::Point3d> places;
    std::vector<cv::Point2d> rays;
    for (size_t k = first; k < first + 3; ++k) {
      const vpLampSight &lamp = lamps[k % lamps.size()];
      places.emplace_back(lamp.position.x(), lamp.position.y(), lamp.position.z());
      rays.emplace_back(lamp.ray.x(), lamp.ray.y());
    }
    std::vector<cv::Vec3d> turns, ways;
    cv::solveP3P(places, rays, cv::Matx33d::eye(), cv::noArray(), turns, ways, cv::SOLVEPNP_AP3P);
    for (size_t k = 0; k < turns.size(); ++k) {
      const Eigen::Vector3d turn(turns[k].val), way(ways[k].val); // of cMw
      const Eigen::Matrix3d wRc = Eigen::AngleAxisd(turn.norm(), turn.stableNormalized()).inverse().matrix();
      const Eigen::Matrix3d wRb = wRc * mount.bRc.transpose();
      const Eigen::Vector3d wtb = -wRc * way - wRb * mount.btc;
      if (wtb.allFinite())
        poses.push_back({wRb, wtb});
    }
  }
  return poses;
}

// Adds the minima that a fit finds from there, each once.
void descend(std::vector<Minimum> &minima, const vpRayFit &fit, const std::vector<vpBasePose> &starts,
             double maxTilt, int rounds = 3)
{
  static const double same = 1e-3; // m and rad
  for (const vpBasePose &start : starts) {
    const Minimum found = fit.minimise(start, rounds);
    if (!found.converged || found.pose.tilt() > maxTilt)
      continue;
    const auto known = std::find_if(minima.begin(), minima.end(), [&](const Minimum &minimum) {
      return minimum.pose.stepTo(found.pose).norm() < same;
    });
    if (known == minima.end())
      minima.push_back(found);
    else if (found.cost < known->cost)
      *known = found;
  }
}

/*
  Best first. Where the picture does not tell poses apart (no likelihood ratio of \e likelihood between
  them) and the rig says nothing of the tilt, the pose that stands most upright comes first.
*/
void rank(std::vector<Minimum> &minima, bool preferUpright, double likelihood)
{
  std::sort(minima.begin(), minima.end(), [](const Minimum &a, const Minimum &b) { return a.cost < b.cost; });
  if (!preferUpright)
    return;
  const double limit = minima.front().cost + 2 * std::log(likelihood);
  const auto end =
      std::find_if(minima.begin(), minima.end(), [=](const Minimum &m) { return m.cost >= limit; });
  std::sort(minima.begin(), end,
            [](const Minimum &a, const Minimum &b) { return a.pose.tilt() < b.pose.tilt(); });
}

/*
  Second moment of the pose about the minimum, with chi-square's own profile over the tilt instead of the
  parabola that its derivatives make of it. They differ where a small flat group is seen head-on: its
  foreshortening is of second order in the tilt, so noise alone moves the minimum off head-on, and there the
  derivative claims a certainty that nothing has. The likelihood is summed along eight rays of tilts, each
  up to where it is \e likelihood times less, and the sum scaled so that a parabola keeps the covariance it
  had.
*/
void addCurvature(vpMatrix6d &covariance, const Minimum &best, const vpRayFit &tiltHeld, double likelihood)
{
  const Eigen::LLT<Eigen::Matrix2d> root(Eigen::Matrix2d(covariance.block<2, 2>(3, 3)));
  // Pose by tilt in units of its sigma, the other parameters following.
  const Eigen::Matrix<double, 6, 2> byTilt = root.matrixL().solve(covariance.middleRows<2>(3)).transpose();
  const double limit = 2 * std::log(likelihood), stride = 0.5, farthest = 40; // sigma
  vpMatrix6d moment = vpMatrix6d::Zero();
  double weights = 0, parabolaMoment = 0, parabolaWeights = 0;
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector2d ray(std::cos(M_PI * k / 4), std::sin(M_PI * k / 4));
    for (double reach = stride; reach < farthest; reach += stride) {
      const Minimum there = tiltHeld.minimise(best.pose.moved(byTilt * ray * reach), 1);
      const double rise = there.cost - best.cost;
      if (reach * reach <= limit) {
        const double weight = reach * std::exp(-reach * reach / 2);
        parabolaMoment += weight * reach * reach / 2;
        parabolaWeights += weight;
      }
      if (!there.converged || rise > limit)
        break;
      const Eigen::Matrix<double, 6, 1> moved = best.pose.stepTo(there.pose);
      const double weight = reach * std::exp(-rise / 2);
      moment += weight * moved * moved.transpose();
      weights += weight;
    }
  }
  if (weights > 0)
    covariance += moment * (parabolaWeights / (weights * parabolaMoment)) - byTilt * byTilt.transpose();
}

// The fix of the best minimum.
vpVlpFix fixOf(std::vector<Minimum> &minima, const vpRayFit &fit, const std::vector<vpLampSight> &lamps,
               const vpVlpRig &rig, double likelihood, bool free)
{
  const vpMountFrame mount(rig);
  rank(minima, free && !mount.tiltStated(), likelihood);
  const Minimum &best = minima.front();
  vpVlpFix fix;
  if (!fit.covariance(best.pose, fix.covariance) || !describeFix(fix, lamps, best.pose, rig))
    return refusedFix("the lamps do not determine the pose");
  if (free)
    addCurvature(fix.covariance, best, vpRayFit(lamps, mount, vpRayFit::Kind::freeTiltHeld), likelihood);
  fix.covariance += mountCovariance(best.pose, mount);
  fix.chiSquare = best.cost;
  fix.degreesOfFreedom = fit.degreesOfFreedom();
  fix.ambiguous = minima.size() > 1 && std::abs(minima[1].cost - best.cost) < 2 * std::log(likelihood);
  if (fix.ambiguous)
    fix.other = minima[1].pose.wMb();
  return fix;
}
} // namespace

vpVlpFix vpManyLampSolver::solve(const std::vector<vpLampSight> &lamps, const vpVlpRig &rig) const
{
  return attitude == Attitude::free ? solveFree(lamps, rig) : solveMount(lamps, rig);
}

vpVlpFix vpManyLampSolver::solveMount(const std::vector<vpLampSight> &lamps, const vpVlpRig &rig) const
{
  vpVlpFix pair = vpTwoLampSolver().solveBestPair(lamps, rig);
  if (!pair.valid || lamps.size() == 2)
    return pair;
  const std::string problem = weightProblem(lamps);
  if (!problem.empty())
    return refusedFix(problem);

  std::vector<vpBasePose> starts = {vpBasePose::of(pair.wMb)};
  if (pair.ambiguous)
    starts.push_back(vpBasePose::of(pair.other));
  const vpMountFrame mount(rig);
  const vpRayFit fit(lamps, mount, vpRayFit::Kind::level);
  std::vector<Minimum> minima;
  descend(minima, fit, starts, M_PI);
  if (minima.empty())
    return refusedFix("no pose has the " + std::to_string(lamps.size()) +
                      " lamps in front of the camera; one id or place is wrong");
  return fixOf(minima, fit, lamps, rig, ambiguityLikelihood, false);
}

vpVlpFix vpManyLampSolver::solveFree(const std::vector<vpLampSight> &lamps, const vpVlpRig &rig) const
{
  if (lamps.size() < 3)
    return refusedFix("a free attitude needs three lamps, " + std::to_string(lamps.size()) + " came");
  std::string problem = sightProblem(lamps);
  if (problem.empty())
    problem = weightProblem(lamps);
  if (!problem.empty())
    return refusedFix(problem);
  if (onOneLine(lamps))
    return refusedFix("the " + std::to_string(lamps.size()) +
                      " lamps hang on one line: they leave the rotation about it free");

  const vpMountFrame mount(rig);
  const vpRayFit fit(lamps, mount, vpRayFit::Kind::free);
  std::vector<Minimum> found, minima;
  descend(found, fit, posesOfThrees(lamps, mount), maxTilt, 1);
  for (const Minimum &minimum : found)
    descend(minima, fit, {minimum.pose}, maxTilt);
  if (minima.empty())
    return refusedFix("no pose within " + degrees(maxTilt) + " of the vertical sees the " +
                      std::to_string(lamps.size()) + " lamps");
  vpVlpFix fix = fixOf(minima, fit, lamps, rig, ambiguityLikelihood, true);
  if (!fix.valid)
    return fix;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> tilt;
  tilt.computeDirect(Eigen::Matrix2d(fix.covariance.block<2, 2>(3, 3)), Eigen::EigenvaluesOnly);
  const double tiltSigma = std::sqrt(tilt.eigenvalues()(1));
  if (!(tiltSigma <= maxTiltSigma))
    return refusedFix("the lamps leave roll and pitch uncertain by " + degrees(tiltSigma) + ", at most " +
                      degrees(maxTiltSigma) + " is accepted");
  return fix;
}

END_VISP_NAMESPACE
