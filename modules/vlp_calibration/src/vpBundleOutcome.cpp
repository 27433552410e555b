/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// vpBundleProblem: what is told of a problem once it is solved.

#include "vpBundleProblem.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "vpBundleResiduals.h"

BEGIN_VISP_NAMESPACE

vpBundleResidual vpBundleProblem::residualOf(size_t view, size_t image)
{
  const vpBundleView &entry = m_start.views[view];
  const vpLampImage &seen = m_runs[entry.run].views[entry.view].images[image];
  const vpImageResidual residual = imageResidual(view, image);
  vpBundleResidual out;
  out.run = entry.run;
  out.view = entry.view;
  out.lamp = seen.lamp;
  out.point = residual.point;
  out.residual = residual.pixels(m_rig.data(), m_odometry.data(), slipAt(view, entry.since[image].dt),
                                 m_rates[view].data(), m_poses[view].position, &m_poses[view].heading,
                                 m_lamps[seen.lamp].data());
  out.sigmas = m_imageWeight * (residual.whitening * out.residual).norm();
  out.used = entry.used[image];
  return out;
}

vpRigMatrix vpBundleProblem::covarianceOf(const Eigen::MatrixXd &covariance) const
{
  vpRigMatrix all = vpRigMatrix::Zero();
  for (size_t i = 0; i < m_freeRig.size(); ++i) {
    for (size_t k = 0; k < m_freeRig.size(); ++k) {
      all(m_freeRig[i], m_freeRig[k]) =
          covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k));
    }
  }
  return all;
}

/*!
  Directions in which the rig's parameters stay as good as unknown: eigenvectors of the information that the
  data alone have of them, the image points taken for so uncertain that no number of them averages away what a
  detector is off by systematically.
*/
std::vector<std::string> vpBundleProblem::unseparated()
{
  const auto count = static_cast<Eigen::Index>(m_freeRig.size());
  if (count == 0) {
    return {};
  }
  const double stated = m_imageWeight;
  double variance = 0; // px^2, mean of the image points'
  size_t points = 0;
  for (const vpBundleView &view : m_start.views) {
    for (const vpLampImage &image : m_runs[view.run].views[view.view].images) {
      variance += 0.5 * image.covariance.trace();
      ++points;
    }
  }
  variance /= static_cast<double>(points) * stated * stated;
  const double common = m_bundle.systematicError * m_bundle.systematicError * static_cast<double>(points);
  m_imageWeight = stated / std::sqrt(1 + common / variance);
  Eigen::MatrixXd information = equations().information();
  m_imageWeight = stated;

  // Priors of the rig take no part; odometry's errors and lamps are eliminated.
  for (Eigen::Index i = 0; i < count; ++i) {
    const double prior = m_bundle.rigSigma(m_freeRig[static_cast<size_t>(i)]);
    information(i, i) -= std::isinf(prior) ? 0 : 1 / (prior * prior);
  }
  Eigen::MatrixXd own = information.topLeftCorner(count, count);
  const Eigen::Index others = information.rows() - count;
  if (others > 0) {
    const Eigen::MatrixXd across = information.topRightCorner(count, others);
    const Eigen::MatrixXd rest = information.bottomRightCorner(others, others);
    own -= across * vpInverseOf(rest) * across.transpose();
  }
  Eigen::VectorXd coarse(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    coarse(i) = vpRigParameterInfo::all()[static_cast<size_t>(m_freeRig[static_cast<size_t>(i)])].coarse;
  }
  const Eigen::MatrixXd scaled = coarse.asDiagonal() * own * coarse.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  std::vector<std::string> found;
  for (Eigen::Index k = 0; k < count; ++k) {
    if (eigen.eigenvalues()(k) >= 1) {
      continue;
    }
    std::string names;
    const Eigen::VectorXd direction = eigen.eigenvectors().col(k);
    static const double share = 0.3; // of the direction's length: what makes part of it
    for (Eigen::Index i = 0; i < count; ++i) {
      if (std::abs(direction(i)) > share) {
        names += (names.empty() ? "" : " with ") +
                 vpRigParameterInfo::all()[static_cast<size_t>(m_freeRig[static_cast<size_t>(i)])].name;
      }
    }
    if (std::find(found.begin(), found.end(), names) == found.end()) {
      found.push_back(names);
    }
  }
  return found;
}

/*!
  Of what is free. Image points count for no better than stated there: what all of them are off by together
  is in that, and shows in no residual. Nor do they count for worse by what is chance: taken one way only, it
  would make all standard deviations too large.
*/
Eigen::MatrixXd vpBundleProblem::covariance()
{
  static const double significant = 3; // standard deviations of the weight
  const double found = m_imageWeight, chance = std::sqrt(0.5 / std::max(1.0, m_imageRedundancy));
  m_imageWeight = found > 1 - significant * chance ? 1 : found;
  Eigen::MatrixXd inverse = vpInverseOf(equations().information());
  m_imageWeight = found;
  return inverse;
}

vpBundleResult vpBundleProblem::result()
{
  vpBundleResult result;
  result.unseparated = unseparated();
  const Eigen::MatrixXd covariance = this->covariance();

  result.rig = vpMovedRig(m_start.rig, m_rig);
  result.step = vpRigStep(m_prior, result.rig);
  result.rigCovariance = covarianceOf(covariance);
  const vpRigVector sigma = result.rigCovariance.diagonal().cwiseMax(0).cwiseSqrt();
  for (int i = 0; i < 3; ++i) {
    if (m_bundle.rigSigma(i) > 0) {
      result.rig.translationSigma(i) = sigma(i);
    }
    if (m_bundle.rigSigma(i + 3) > 0) {
      result.rig.rotationSigma(i) = sigma(i + 3);
    }
  }

  if (m_bundle.rigSigma.segment<2>(6).maxCoeff() > 0) {
    result.rig.principalPointSigma = sigma.segment<2>(6).maxCoeff();
  }
  if (m_bundle.rigSigma(8) > 0) {
    result.rig.focalLengthSigma = sigma(8);
  }

  result.map = m_priorMap;
  result.lampCovariance.assign(m_lamps.size(), Eigen::Matrix3d::Zero());
  result.lampImages.assign(m_lamps.size(), 0);
  auto column = static_cast<Eigen::Index>(m_freeRig.size());
  column += m_problem->IsParameterBlockConstant(m_odometry.data())
                ? 0
                : m_problem->ParameterBlockTangentSize(m_odometry.data());
  for (size_t k = 0; k < m_lamps.size(); ++k) {
    const double *block = m_lamps[k].data();
    if (!m_problem->HasParameterBlock(block)) {
      continue;
    }
    result.map.lamps[k].position = m_lamps[k];
    if (m_problem->IsParameterBlockConstant(block)) {
      continue;
    }
    const int size = m_problem->ParameterBlockTangentSize(block);
    result.lampCovariance[k].bottomRightCorner(size, size) = covariance.block(column, column, size, size);
    column += size;
    result.map.lamps[k].positionSigma = std::sqrt(std::max(0.0, result.lampCovariance[k].trace() / 3));
  }

  result.imageFactor = 1 / m_imageWeight;
  result.odometry = {m_odometry(0), m_odometry(1), m_odometry(2), m_odometry(3), m_odometry(4)};
  result.poses.resize(m_runs.size());
  double squares = 0;
  size_t count = 0;
  for (size_t i = 0; i < m_poses.size(); ++i) {
    const vpBundleView &view = m_start.views[i];
    vpTrajectory &poses = result.poses[view.run];
    if (poses.empty() || view.time > poses.poses().back().timestamp) {
      poses.add(view.time, vpPoseOf(Eigen::Vector3d(m_poses[i].position[0], m_poses[i].position[1], 0),
                                    Eigen::Vector3d(0, 0, m_poses[i].heading)));
    }
    for (size_t k = 0; k < view.used.size(); ++k) {
      result.residuals.push_back(residualOf(i, k));
      if (view.used[k]) {
        ++result.lampImages[result.residuals.back().lamp];
        squares += result.residuals.back().residual.squaredNorm();
        count += 2;
      }
    }
  }
  result.rms = count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0;
  result.converged = m_converged;
  result.valid = true;
  return result;
}

END_VISP_NAMESPACE
