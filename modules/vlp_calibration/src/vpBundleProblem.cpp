/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpBundleProblem.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/manifold.h>
#include <ceres/solver.h>

#include "vpBundleResiduals.h"

BEGIN_VISP_NAMESPACE

namespace
{
using Motion = vpLampRun::Motion;

const double huber = 3; // standard deviations from which on a residual counts less

//! Standard deviations that hold a parameter that nothing else holds, so that it stays a number.
vpRigVector boundsOfFree()
{
  static const double wide = 50;
  vpRigVector bounds;
  for (int i = 0; i < vpRigParameterCount; ++i) {
    bounds(i) = wide * vpRigParameterInfo::all()[static_cast<size_t>(i)].coarse;
  }
  return bounds;
}

template <int Residuals, int... Blocks, typename Functor>
ceres::CostFunction *cost(Functor *functor)
{
  return new ceres::AutoDiffCostFunction<Functor, Residuals, Blocks...>(functor);
}
} // namespace

vpBundleProblem::vpBundleProblem(const vpLampBundle &bundle, const std::vector<vpLampRun> &runs,
                                 const vpVlpRig &prior, const vpLampMap &priorMap, vpBundleStart &start)
    : m_bundle(bundle), m_runs(runs), m_prior(prior), m_priorMap(priorMap), m_start(start),
      m_rig(vpRigVector::Zero()), m_slips(start.views.size(), Eigen::Vector2d::Zero()),
      m_rates(start.views.size(), Eigen::Vector2d::Zero())
{
  for (const vpLamp &lamp : start.map.lamps) {
    m_lamps.push_back(lamp.position);
  }
  for (size_t i = 0; i < start.views.size(); ++i) {
    const vpBundleView &view = start.views[i];
    const bool shared = i > 0 && start.views[i - 1].run == view.run && runs[view.run].motion == Motion::spin;
    if (!shared) {
      m_positions.emplace_back(view.start.head<2>());
    }
    m_poses.push_back({m_positions.back().data(), view.start(2)});
  }
  for (int i = 0; i < vpRigParameterCount; ++i) {
    if (bundle.rigSigma(i) > 0) {
      m_freeRig.push_back(i);
    }
  }
  m_steps.resize(start.views.size());
  for (size_t i = 1; i < start.views.size(); ++i) {
    const vpBundleView &before = start.views[i - 1], &view = start.views[i];
    if (before.run == view.run && runs[view.run].motion == Motion::wheels) {
      m_steps[i] = start.paths[view.run].step(before.time, view.time);
    }
  }
}

void vpBundleProblem::add(ceres::CostFunction *function, bool robust, const std::vector<double *> &blocks,
                          const std::vector<Row> &rows)
{
  ceres::LossFunction *loss = robust ? new ceres::HuberLoss(huber) : nullptr;
  m_blocks.push_back(m_problem->AddResidualBlock(function, loss, blocks));
  m_rows.insert(m_rows.end(), rows.begin(), rows.end());
}

/*!
  Slip of the wheels between a view's pose and an image of it: that of the step which the image's time lies
  in, or of the other one at an end of the run; none where no odometry tells the steps.
*/
double *vpBundleProblem::slipAt(size_t view, double since)
{
  const size_t next = view + 1;
  const bool before = m_steps[view].has_value(), after = next < m_steps.size() && m_steps[next];
  return after && (since > 0 || !before) ? m_slips[next].data() : m_slips[view].data();
}

//! Of the errors of speed (m/s) and turn rate (rad/s) within a view: the more, the more these change.
Eigen::Vector2d vpBundleProblem::ratesSigma(const vpBundleView &view) const
{
  static const double half = 0.04; // s, of a frame
  Eigen::Vector2d sigma(m_bundle.odometrySpeed, m_bundle.odometryRate);
  if (m_runs[view.run].motion == Motion::wheels) {
    const auto before = m_start.paths[view.run].step(view.time - half, view.time),
               after = m_start.paths[view.run].step(view.time, view.time + half);
    if (before && after) {
      sigma += m_bundle.odometryChange / half *
               Eigen::Vector2d(after->along - before->along, after->turn - before->turn).cwiseAbs();
    }
  }
  return sigma;
}

//! Places the middles of lamps in their outlines as the rig found so far sees these.
void vpBundleProblem::placeMiddles()
{
  const vpVlpRig rig = vpMovedRig(m_start.rig, m_rig);
  for (vpBundleView &view : m_start.views) {
    const std::vector<vpLampImage> &images = m_runs[view.run].views[view.view].images;
    for (size_t k = 0; k < images.size(); ++k) {
      if (images[k].outline.shape != vpLampOutline::Shape::region) {
        view.points[k] = images[k].outline.middle(rig.camera, rig.verticalInCamera());
      }
    }
  }
}

vpImageResidual vpBundleProblem::imageResidual(size_t view, size_t image) const
{
  const vpBundleView &entry = m_start.views[view];
  return vpImageResidual(m_start.rig, entry.points[image],
                         m_runs[entry.run].views[entry.view].images[image].covariance, entry.since[image],
                         m_bundle.wheelSeparation, m_imageWeight);
}

void vpBundleProblem::addImages()
{
  for (size_t i = 0; i < m_poses.size(); ++i) {
    const vpBundleView &view = m_start.views[i];
    const std::vector<vpLampImage> &images = m_runs[view.run].views[view.view].images;
    for (size_t k = 0; k < images.size(); ++k) {
      if (view.used[k]) {
        add(cost<2, vpRigParameterCount, 5, 2, 2, 2, 1, 3>(new vpImageResidual(imageResidual(i, k))), true,
            {m_rig.data(), m_odometry.data(), slipAt(i, view.since[k].dt), m_rates[i].data(),
             m_poses[i].position, &m_poses[i].heading, m_lamps[images[k].lamp].data()},
            {Row::image, Row::image});
      }
    }
    if (m_problem->HasParameterBlock(m_rates[i].data())) {
      add(cost<2, 2>(new vpRatesResidual{ratesSigma(view), &m_ratesWeight}), false, {m_rates[i].data()},
          {Row::rates, Row::rates});
    }
  }
}

void vpBundleProblem::addMotion()
{
  for (size_t i = 0; i < m_poses.size(); ++i) {
    const vpBundleView &view = m_start.views[i];
    const vpLampRun &run = m_runs[view.run];
    if (run.motion == Motion::known) {
      add(cost<3, 2, 1>(new vpPlaceResidual{view.start, run.placeSigma, run.headingSigma}), false,
          {m_poses[i].position, &m_poses[i].heading}, {Row::other, Row::other, Row::other});
    } else if (m_steps[i]) {
      addStep(i);
    } else if (run.motion == Motion::wheels && run.odometry.empty() && i > 0 &&
               m_start.views[i - 1].run == view.run) {
      add(cost<1, 2, 1, 2, 1>(new vpRollingResidual{m_bundle.sideways, &m_stepWeight}), true,
          {m_poses[i - 1].position, &m_poses[i - 1].heading, m_poses[i].position, &m_poses[i].heading},
          {Row::sideways});
    }
  }
}

//! The odometry's step to a view, and the wheels' slip over it.
void vpBundleProblem::addStep(size_t i)
{
  const vpPlanarStep &step = *m_steps[i];
  const Eigen::Vector3d sigma(
      m_bundle.odometryLength,
      std::hypot(m_bundle.sideways, m_bundle.slip * step.length * std::abs(step.turned)),
      m_bundle.odometryTurn);
  const Eigen::Vector2d ways = vpRolled(step, m_bundle.wheelSeparation).cwiseAbs();
  add(cost<3, 5, 2, 2, 1, 2, 1>(new vpStepResidual{step, m_bundle.wheelSeparation, sigma, &m_stepWeight}),
      true,
      {m_odometry.data(), m_slips[i].data(), m_poses[i - 1].position, &m_poses[i - 1].heading,
       m_poses[i].position, &m_poses[i].heading},
      {Row::along, Row::sideways, Row::turn});
  const std::vector<Row> rows(2, Row::slip);
  if (!m_steps[i - 1]) {
    const Eigen::Vector2d any = Eigen::Vector2d::Constant(m_bundle.slip);
    add(cost<2, 2>(new vpSlipResidual{Eigen::Vector2d::Zero(), any, &m_slipWeight}), false,
        {m_slips[i].data()}, rows);
    return;
  }
  static const double least = 1e-4; // m, so that a wheel that stands may begin anew
  const Eigen::Vector2d kept = (-ways.cwiseMax(least) / m_bundle.slipLength).array().exp();
  const Eigen::Vector2d more = m_bundle.slip * (1 - kept.array().square()).sqrt();
  add(cost<2, 2, 2>(new vpSlipResidual{kept, more, &m_slipWeight}), false,
      {m_slips[i - 1].data(), m_slips[i].data()}, rows);
}

void vpBundleProblem::addPriors()
{
  const std::vector<Row> three(3, Row::other);
  if (!m_freeRig.empty()) {
    add(cost<vpRigParameterCount, vpRigParameterCount>(new vpPriorResidual<vpRigParameterCount>{
            vpRigStep(m_start.rig, m_prior), m_bundle.rigSigma.cwiseMin(boundsOfFree())}),
        false, {m_rig.data()}, std::vector<Row>(vpRigParameterCount, Row::other));
  }
  const Vector5d odometrySigma((Vector5d() << m_bundle.odometryScale, m_bundle.odometryDrift,
                                m_bundle.odometryScale, m_bundle.odometryTurnPerMetre, m_bundle.odometryBias)
                                   .finished());
  add(cost<5, 5>(new vpPriorResidual<5>{Vector5d::Zero(), odometrySigma}), false, {m_odometry.data()},
      std::vector<Row>(5, Row::other));
  if (m_bundle.wheelSeparation > 0) {
    add(cost<1, 5>(new vpWheelsResidual{m_bundle.wheelSeparation}), false, {m_odometry.data()}, {Row::other});
  }
  for (size_t k = 0; k < m_lamps.size(); ++k) {
    const double sigma = m_bundle.lampSigma[k];
    if (sigma > 0 && std::isfinite(sigma) && m_problem->HasParameterBlock(m_lamps[k].data())) {
      add(cost<3, 3>(new vpPriorResidual<3>{m_priorMap.lamps[k].position, Eigen::Vector3d::Constant(sigma)}),
          false, {m_lamps[k].data()}, three);
    }
  }
  if (m_bundle.distance) {
    const vpLampDistance &known = *m_bundle.distance;
    const Eigen::Vector3d way = m_priorMap.lamps[known.to].position - m_priorMap.lamps[known.from].position;
    add(cost<2, 3, 3>(new vpDistanceResidual{known.metres, known.sigma, way.head<2>().normalized()}), false,
        {m_lamps[known.from].data(), m_lamps[known.to].data()}, {Row::other, Row::other});
  }
}

//! Makes constant what is held.
void vpBundleProblem::hold()
{
  std::vector<int> held;
  for (int i = 0; i < vpRigParameterCount; ++i) {
    if (!(m_bundle.rigSigma(i) > 0)) {
      held.push_back(i);
    }
  }
  if (m_freeRig.empty()) {
    m_problem->SetParameterBlockConstant(m_rig.data());
  } else if (!held.empty()) {
    m_problem->SetManifold(m_rig.data(), new ceres::SubsetManifold(vpRigParameterCount, held));
  }
  for (size_t i = 0; i < m_slips.size(); ++i) {
    if (!m_steps[i] && m_problem->HasParameterBlock(m_slips[i].data())) {
      m_problem->SetParameterBlockConstant(m_slips[i].data());
    }
  }
  for (size_t k = 0; k < m_lamps.size(); ++k) {
    if (!(m_bundle.lampSigma[k] > 0) && m_problem->HasParameterBlock(m_lamps[k].data())) {
      m_problem->SetParameterBlockConstant(m_lamps[k].data());
    }
  }
  if (m_bundle.distance) {
    m_problem->SetManifold(m_lamps[m_bundle.distance->from].data(), new ceres::SubsetManifold(3, {0, 1}));
  }
  const bool moving =
      std::any_of(m_runs.begin(), m_runs.end(), [](const vpLampRun &run) { return !run.odometry.empty(); });
  if (!moving) {
    m_problem->SetParameterBlockConstant(m_odometry.data());
  } else { // wheels have no bias, and a gyro knows nothing of metres
    static const int turnPerMetre = 3, turnBias = 4;
    m_problem->SetManifold(
        m_odometry.data(),
        new ceres::SubsetManifold(5, {m_bundle.wheelSeparation > 0 ? turnBias : turnPerMetre}));
  }
}

void vpBundleProblem::build()
{
  m_problem = std::make_unique<ceres::Problem>();
  m_blocks.clear();
  m_rows.clear();
  placeMiddles();
  addImages();
  addMotion();
  addPriors();
  hold();
}

bool vpBundleProblem::solve()
{
  build();
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = m_bundle.maxIterations;
  options.function_tolerance = 1e-9;
  options.parameter_tolerance = 1e-10;
  options.max_trust_region_radius = 1e12; // beyond, rounding alone makes the normal equations singular
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, m_problem.get(), &summary);
  m_converged = summary.termination_type == ceres::CONVERGENCE;
  static const double shortest = 0.1; // of the focal length: below, nothing is explained any more
  return summary.IsSolutionUsable() && m_rig.allFinite() &&
         1 + m_rig(static_cast<int>(vpRigParameter::focal)) > shortest;
}

vpNormalEquations vpBundleProblem::equations()
{
  std::vector<double *> poses, rest;
  std::set<double *> known;
  for (size_t i = 0; i < m_poses.size(); ++i) {
    for (double *block : {m_poses[i].position, &m_poses[i].heading, m_slips[i].data(), m_rates[i].data()}) {
      if (m_problem->HasParameterBlock(block) && known.insert(block).second) {
        poses.push_back(block);
      }
    }
  }
  rest = {m_rig.data(), m_odometry.data()};
  for (Eigen::Vector3d &lamp : m_lamps) {
    if (m_problem->HasParameterBlock(lamp.data())) {
      rest.push_back(lamp.data());
    }
  }
  return vpNormalEquations(*m_problem, poses, rest, m_blocks);
}

size_t vpBundleProblem::dropOutliers()
{
  size_t dropped = 0;
  for (size_t i = 0; i < m_poses.size(); ++i) {
    for (size_t k = 0; k < m_start.views[i].used.size(); ++k) {
      if (m_start.views[i].used[k] && residualOf(i, k).sigmas > m_bundle.outlier) {
        m_start.views[i].used[k] = false;
        ++dropped;
      }
    }
  }
  return dropped;
}

END_VISP_NAMESPACE
