/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_localization/vpTwoLampSolver.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include <Eigen/Geometry>

#include "vpRayFit.h"

BEGIN_VISP_NAMESPACE

namespace
{
const double samePlace = 1e-6; // m in the map, and normalised units in the picture

std::string both(const vpLampSight &first, const vpLampSight &second)
{
  return "lamps " + first.id + " and " + second.id;
}

// Distance in the picture over its standard deviation along the line between the two image points.
double separation(const vpLampSight &first, const vpLampSight &second)
{
  const Eigen::Vector2d apart = second.ray - first.ray;
  const double variance = apart.dot((first.covariance + second.covariance) * apart) / apart.squaredNorm();
  return variance > 0 ? apart.norm() / std::sqrt(variance) : std::numeric_limits<double>::infinity();
}

// What is wrong with the pair before any equation is solved; empty where nothing is.
std::string pairProblem(const vpLampSight &first, const vpLampSight &second, const vpLampPair &pair,
                        double minImageSeparation)
{
  if (std::abs(pair.step) < samePlace)
    return both(first, second) + (std::abs(pair.rise) < samePlace
                                      ? " have the same place in the map"
                                      : " hang one above the other: they do not show the heading");
  if ((second.ray - first.ray).norm() < samePlace)
    return both(first, second) + " have the same place in the picture";
  const double sigmas = separation(first, second);
  if (sigmas < minImageSeparation) {
    std::ostringstream text;
    text.precision(2);
    text << both(first, second) << " are only " << sigmas << " sigma apart in the picture, "
         << minImageSeparation << " are needed";
    return text.str();
  }
  return "";
}

// Refusal where the pair leaves height or heading too uncertain; empty where it does not.
std::string sigmaProblem(const vpLampSight &first, const vpLampSight &second, double height,
                         const vpMatrix6d &covariance, double limit)
{
  const double sigma = std::sqrt(covariance(2, 2)) / height;
  const double yawSigma = std::sqrt(covariance(5, 5));
  std::ostringstream text;
  text.precision(2);
  if (sigma > limit)
    text << both(first, second) << " leave the height above the camera uncertain by " << 100 * sigma
         << " %, at most " << 100 * limit << " % is accepted";
  else if (yawSigma > limit)
    text << both(first, second) << " leave the heading uncertain by " << degrees(yawSigma) << ", at most "
         << degrees(limit) << " is accepted";
  return text.str();
}
} // namespace

vpVlpFix vpTwoLampSolver::solve(const vpLampSight &first, const vpLampSight &second,
                                const vpVlpRig &rig) const
{
  const std::vector<vpLampSight> lamps = {first, second};
  const vpMountFrame mount(rig);
  std::string problem = sightProblem(lamps);
  if (!problem.empty())
    return refusedFix(problem);
  const Eigen::Vector3d step = second.position - first.position;
  vpLampPair pair{{step.x(), step.y()}, step.z(), {}};
  for (int k = 0; k < 2; ++k) {
    const vpUprightRay upright(lamps[k].ray, mount);
    if (!upright.aboveHorizon)
      return refusedFix("lamp " + lamps[k].id +
                        ": its ray does not point above the horizon; is the rig's mount rotation right?");
    pair.rays[k] = upright.value;
  }
  problem = pairProblem(first, second, pair, minImageSeparation);
  if (!problem.empty())
    return refusedFix(problem);

  bool disagree = false;
  std::vector<double> heights = pair.heights(disagree);
  if (disagree)
    return refusedFix(both(first, second) + ": no height of the camera fits their places in map and picture");
  if (heights.empty())
    return refusedFix(both(first, second) + ": the camera would have to be above them");
  // The robot drives on z = 0: of two heights the one that puts its base nearer to there.
  std::vector<vpBasePose> poses;
  for (double H : heights) {
    const Eigen::AngleAxisd turn(pair.heading(H), Eigen::Vector3d::UnitZ());
    const std::complex<double> way = H * std::polar(1.0, turn.angle()) * pair.rays[0];
    const Eigen::Vector3d camera = first.position - Eigen::Vector3d(way.real(), way.imag(), H);
    poses.push_back({turn.matrix(), camera - turn * mount.btc});
  }
  if (poses.size() == 2 && std::abs(poses[1].wtb.z()) < std::abs(poses[0].wtb.z())) {
    std::swap(poses[0], poses[1]);
    std::swap(heights[0], heights[1]);
  }

  vpVlpFix fix;
  if (!vpRayFit(lamps, mount, vpRayFit::Kind::level).covariance(poses[0], fix.covariance))
    return refusedFix(both(first, second) + " do not determine the pose");
  problem = sigmaProblem(first, second, heights[0] + pair.rise / 2, fix.covariance, maxRelativeSigma);
  if (!problem.empty())
    return refusedFix(problem);
  fix.covariance += mountCovariance(poses[0], mount);
  describeFix(fix, lamps, poses[0], rig);
  fix.ambiguous = poses.size() == 2;
  if (fix.ambiguous)
    fix.other = poses[1].wMb();
  return fix;
}

vpVlpFix vpTwoLampSolver::solveBestPair(const std::vector<vpLampSight> &lamps, const vpVlpRig &rig) const
{
  if (lamps.size() < 2)
    return refusedFix("a position needs two lamps, " + std::to_string(lamps.size()) + " came");
  const std::string problem = sightProblem(lamps);
  if (!problem.empty())
    return refusedFix(problem);

  vpVlpFix best;
  double bestTrace = std::numeric_limits<double>::infinity();
  double widest = -1;
  for (size_t i = 0; i < lamps.size(); ++i)
    for (size_t j = i + 1; j < lamps.size(); ++j) {
      vpVlpFix fix = solve(lamps[i], lamps[j], rig);
      const double trace = fix.covariance(0, 0) + fix.covariance(1, 1);
      if (fix.valid && trace < bestTrace) {
        best = std::move(fix);
        bestTrace = trace;
        continue;
      }
      const double apart = (lamps[j].ray - lamps[i].ray).norm();
      if (!best.valid && apart > widest) { // what is wrong with the widest pair tells most
        best.refusal = fix.refusal;
        widest = apart;
      }
    }
  if (!best.valid && lamps.size() > 2)
    best.refusal = "no pair of the " + std::to_string(lamps.size()) +
                   " lamps gives a position; the widest: " + best.refusal;
  return best;
}

END_VISP_NAMESPACE
