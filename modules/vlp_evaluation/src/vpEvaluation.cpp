/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_evaluation/vpEvaluation.h>

#include <cmath>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

BEGIN_VISP_NAMESPACE

namespace
{
using Eigen::Vector2d;

//! Adds the NEES of one fix where its sigmas allow.
void addConsistency(const vpLoggedFix &fix, const vpPosePair &pair, vpFixStatistics &statistics)
{
  const double xx = fix.sigmaX * fix.sigmaX, yy = fix.sigmaY * fix.sigmaY, xy = fix.covXY;
  const double determinant = xx * yy - xy * xy;
  if (determinant > 0) { // false for NaN too
    const double ex = pair.errorX(), ey = pair.errorY();
    statistics.position.add((yy * ex * ex - 2 * xy * ex * ey + xx * ey * ey) / determinant);
  }
  if (fix.sigmaZ > 0) {
    statistics.height.add(std::pow(pair.errorZ() / fix.sigmaZ, 2));
  }
  if (fix.sigmaYaw > 0) {
    statistics.yaw.add(std::pow(pair.errorYaw() / fix.sigmaYaw, 2));
  }
}

vpFixStatistics statisticsOf(const vpFixLog &log, const vpTrajectory &truth,
                             const vpEvaluationSettings &settings)
{
  vpFixStatistics statistics;
  statistics.frames = log.fixes.size();
  statistics.fixes = log.count();
  std::vector<double> compute;
  for (const vpLoggedFix &fix : log.fixes) {
    compute.push_back(fix.compute);
    statistics.ambiguous += fix.state == vpLoggedFix::State::ambiguous ? 1 : 0;
    if (!fix.hasPosition() || settings.alignment != vpAlignment::none) {
      continue;
    }
    if (const auto wMb = truth.at(fix.timestamp, settings.longestGap)) {
      addConsistency(fix, {fix.timestamp, fix.wMb, *wMb}, statistics);
    }
  }
  statistics.compute = vpErrorStatistics::of(compute);
  return statistics;
}

void computeErrors(vpEvaluation &evaluation)
{
  std::vector<double> x, y, z, yaw, distances, off;
  std::vector<Vector2d> errors, positions;
  for (const vpPosePair &pair : evaluation.pairs) {
    x.push_back(pair.errorX());
    y.push_back(pair.errorY());
    z.push_back(pair.errorZ());
    yaw.push_back(pair.errorYaw());
    distances.push_back(pair.distance());
    errors.emplace_back(pair.errorX(), pair.errorY());
    positions.emplace_back(pair.estimate[0][3], pair.estimate[1][3]);
    if (evaluation.line) {
      off.push_back(evaluation.line->distance(positions.back()));
    }
  }
  evaluation.x = vpErrorStatistics::of(x);
  evaluation.y = vpErrorStatistics::of(y);
  evaluation.z = vpErrorStatistics::of(z);
  evaluation.yaw = vpErrorStatistics::of(yaw);
  evaluation.horizontal = vpErrorStatistics::of(distances);
  evaluation.distribution = vpErrorDistribution(distances);
  evaluation.dispersion = vpDispersion::of(errors);
  evaluation.lineDistance = vpErrorStatistics::of(off);
  evaluation.offLine = vpErrorDistribution(off);
  if (evaluation.line) {
    evaluation.fitted = vpFittedLine::of(positions);
  }
}

void append(std::vector<vpStatistic> &list, const std::string &name, const std::string &unit,
            const vpErrorStatistics &errors)
{
  if (errors.count == 0) {
    return;
  }
  list.push_back({name + "_mean", unit, errors.mean});
  list.push_back({name + "_median", unit, errors.median});
  list.push_back({name + "_rmse", unit, errors.rmse});
  list.push_back({name + "_std", unit, errors.deviation});
  list.push_back({name + "_p90", unit, errors.percentile90});
  list.push_back({name + "_p95", unit, errors.percentile95});
  list.push_back({name + "_max", unit, errors.largest});
}

void append(std::vector<vpStatistic> &list, const std::string &name, const vpConsistency &consistency)
{
  if (consistency.count() == 0) {
    return;
  }
  list.push_back({name + "_count", "1", static_cast<double>(consistency.count())});
  list.push_back({name + "_mean", "1", consistency.mean()});
  list.push_back({name + "_lower", "1", consistency.lower()});
  list.push_back({name + "_upper", "1", consistency.upper()});
  list.push_back({name + "_within95", "1", consistency.shareWithin95()});
}

void append(std::vector<vpStatistic> &list, const vpFixStatistics &fixes)
{
  list.push_back({"frames", "1", static_cast<double>(fixes.frames)});
  list.push_back({"fixes", "1", static_cast<double>(fixes.fixes)});
  list.push_back({"ambiguous", "1", static_cast<double>(fixes.ambiguous)});
  list.push_back({"fix_share", "1", fixes.share()});
  if (fixes.compute.count > 0) {
    list.push_back({"compute_mean", "s", fixes.compute.mean});
    list.push_back({"compute_median", "s", fixes.compute.median});
    list.push_back({"compute_p95", "s", fixes.compute.percentile95});
    list.push_back({"compute_max", "s", fixes.compute.largest});
  }
  append(list, "nees_xy", fixes.position);
  append(list, "nees_z", fixes.height);
  append(list, "nees_yaw", fixes.yaw);
}
} // namespace

vpEvaluation vpEvaluation::of(const vpTrajectory &truth, const vpTrajectory &estimate, const vpFixLog *fixes,
                              const vpEvaluationSettings &settings)
{
  if (!(settings.longestGap > 0)) {
    throw vpException(vpException::badValue,
                      "longest gap of the truth: " + vpNumberText(settings.longestGap) +
                          " s, expected a number above 0");
  }
  vpPosePairs associated = vpPosePairs::of(estimate, truth, settings.longestGap);

  vpEvaluation evaluation;
  evaluation.truthPoses = truth.size();
  evaluation.estimatePoses = estimate.size();
  evaluation.outside = associated.outside;
  evaluation.inGaps = associated.inGaps;
  evaluation.longestGap = settings.longestGap;
  evaluation.alignment = settings.alignment;
  evaluation.tTe = vpAlignmentOf(associated.pairs, settings.alignment);
  evaluation.truth = truth;
  evaluation.pairs = std::move(associated.pairs);
  if (settings.alignment != vpAlignment::none) {
    for (vpPosePair &pair : evaluation.pairs) {
      pair.estimate = evaluation.tTe * pair.estimate;
    }
  }
  evaluation.line = settings.line ? settings.line : vpTrackLine::of(truth);
  computeErrors(evaluation);
  if (fixes != nullptr) {
    evaluation.fixes = statisticsOf(*fixes, truth, settings);
  }
  return evaluation;
}

std::vector<vpStatistic> vpEvaluation::statistics() const
{
  std::vector<vpStatistic> list = {{"truth_poses", "1", static_cast<double>(truthPoses)},
                                   {"estimate_poses", "1", static_cast<double>(estimatePoses)},
                                   {"outside_truth", "1", static_cast<double>(outside)},
                                   {"in_truth_gaps", "1", static_cast<double>(inGaps)},
                                   {"pairs", "1", static_cast<double>(pairs.size())}};
  append(list, "x", "m", x);
  append(list, "y", "m", y);
  append(list, "z", "m", z);
  append(list, "yaw", "rad", yaw);
  append(list, "horizontal", "m", horizontal);
  append(list, "line", "m", lineDistance);
  if (!pairs.empty()) {
    list.push_back({"dispersion_diameter", "m", dispersion.diameter()});
    list.push_back({"dispersion_radius", "m", dispersion.radius()});
    list.push_back({"circle_radius", "m", dispersion.circleRadius});
    list.push_back({"circle_centre_x", "m", dispersion.centre.x()});
    list.push_back({"circle_centre_y", "m", dispersion.centre.y()});
  }
  if (fitted) {
    list.push_back({"fit_along_y", "1", fitted->alongY ? 1. : 0.});
    list.push_back({"fit_slope", "1", fitted->slope});
    list.push_back({"fit_offset", "m", fitted->offset});
  }
  if (fixes) {
    append(list, *fixes);
  }
  return list;
}

std::string vpEvaluation::csv() const
{
  std::string text = "name,unit,value\n";
  for (const vpStatistic &statistic : statistics()) {
    text += statistic.name + "," + statistic.unit + "," + vpNumberText(statistic.value) + "\n";
  }
  return text;
}

END_VISP_NAMESPACE
