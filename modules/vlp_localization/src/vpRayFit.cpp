/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpRayFit.h"

#include <algorithm>
#include <cmath>

BEGIN_VISP_NAMESPACE

vpRayFit::vpRayFit(const std::vector<vpLampSight> &lamps, const vpMountFrame &mount, Kind kind)
    : m_lamps(lamps), m_mount(mount), m_level(kind == Kind::level),
      m_parameters(kind == Kind::free ? std::vector<int>{0, 1, 2, 3, 4, 5} : std::vector<int>{0, 1, 2, 5}),
      m_fixedCovariance((!m_level || !mount.tiltStated()) && !mount.lensStated())
{
  for (const vpLampSight &lamp : lamps)
    m_fixedCovariance = m_fixedCovariance && lamp.positionSigma == 0;
}

int vpRayFit::rows() const
{
  const int angles = m_level ? 0 : (m_mount.rotationSigma.x() > 0) + (m_mount.rotationSigma.y() > 0);
  return 2 * static_cast<int>(m_lamps.size()) + angles;
}

int vpRayFit::degreesOfFreedom() const
{
  return rows() - static_cast<int>(m_parameters.size());
}

vpRayFit::Linear vpRayFit::linearise(const vpBasePose &pose, bool withCovariance) const
{
  Linear linear;
  linear.residual.setZero(rows());
  linear.byBase.setZero(rows(), 6);
  if (withCovariance)
    linear.covariance.setZero(rows(), rows());
  for (size_t k = 0; k < m_lamps.size(); ++k) {
    const vpPredictedRay predicted = predictRay(m_lamps[k].position, pose, m_mount);
    if (!predicted.inFront) {
      linear.inFront = false;
      return linear;
    }
    linear.residual.segment<2>(2 * k) = m_lamps[k].ray - predicted.ray;
    linear.byBase.middleRows<2>(2 * k) = predicted.derivative;
    if (withCovariance)
      linear.covariance.block<2, 2>(2 * k, 2 * k) = rayCovariance(m_lamps[k], predicted);
  }
  if (withCovariance && m_mount.lensStated()) {
    const Eigen::Index rows = 2 * static_cast<Eigen::Index>(m_lamps.size());
    Eigen::VectorXd rays(rows);
    for (size_t k = 0; k < m_lamps.size(); ++k) {
      rays.segment<2>(2 * k) = m_lamps[k].ray;
    }
    linear.covariance.topLeftCorner(rows, rows) += lensCovariance(rays, m_mount);
  }
  if (!m_level)
    addTiltPrior(linear, pose);
  else if (withCovariance && m_mount.tiltStated()) {
    const Eigen::MatrixXd byTilt = byCameraTilt(linear.byBase, pose, m_mount);
    linear.covariance += byTilt * tiltCovariance(pose, m_mount) * byTilt.transpose();
  }
  return linear;
}

// Up in b is (-pitch, roll, 1) to first order; turning the base by a small e about axes of w moves it by
// wRb^T (z x e).
void vpRayFit::addTiltPrior(Linear &linear, const vpBasePose &pose) const
{
  const Eigen::Matrix3d &R = pose.wRb;
  const Eigen::Vector2d angle(R(2, 1), -R(2, 0));
  Eigen::Matrix2d byRotation; // about x and y of w
  byRotation << R(1, 1), -R(0, 1), -R(1, 0), R(0, 0);
  int row = 2 * static_cast<int>(m_lamps.size());
  for (int k = 0; k < 2; ++k) {
    const double sigma = m_mount.rotationSigma(k);
    if (sigma > 0) {
      linear.residual(row) = -angle(k);
      linear.byBase.block<1, 2>(row, 3) = byRotation.row(k);
      if (linear.covariance.size() > 0)
        linear.covariance(row, row) = sigma * sigma;
      ++row;
    }
  }
}

vpRayFit::Minimum vpRayFit::minimise(const vpBasePose &start, int rounds) const
{
  Minimum minimum;
  minimum.pose = start;
  for (int round = 0; round < (m_fixedCovariance ? 1 : rounds); ++round) {
    const Linear linear = linearise(minimum.pose, true);
    minimum.converged = false;
    if (!linear.inFront)
      break;
    const Cholesky S(linear.covariance);
    if (S.info() != Eigen::Success || !descend(minimum, S))
      break;
  }
  return minimum;
}

bool vpRayFit::descend(Minimum &minimum, const Cholesky &S) const
{
  double damping = 1e-3;
  Linear linear = linearise(minimum.pose, false);
  for (int iteration = 0; iteration < 100; ++iteration) {
    const Eigen::VectorXd r = S.matrixL().solve(linear.residual); // whitened
    const Columns J = S.matrixL().solve(Columns(linear.byBase(Eigen::all, m_parameters)));
    const Square normal = J.transpose() * J;
    const Parameters gradient = J.transpose() * r;
    minimum.cost = r.squaredNorm();
    bool better = false;
    while (!better && damping < 1e12) {
      Square damped = normal;
      damped.diagonal() *= 1 + damping;
      const Parameters change = damped.ldlt().solve(gradient);
      const double gain = change.dot(gradient); // of the cost, twice as predicted
      if (!std::isfinite(gain))
        return false;
      minimum.converged = damping <= 1 && gain < 1e-12 * (1 + minimum.cost);
      if (minimum.converged)
        return true;
      Eigen::Matrix<double, 6, 1> step = Eigen::Matrix<double, 6, 1>::Zero();
      step(m_parameters) = change;
      const vpBasePose trial = minimum.pose.moved(step);
      Linear there = linearise(trial, false);
      better = there.inFront && S.matrixL().solve(there.residual).squaredNorm() < minimum.cost;
      minimum.converged = !better && damping <= 1 && gain < 1e-6 * (1 + minimum.cost); // but for rounding
      if (minimum.converged)
        return true;
      damping = better ? std::max(damping / 10, 1e-12) : damping * 10;
      if (better) {
        minimum.pose = trial;
        linear = std::move(there);
      }
    }
    if (!better)
      return false;
  }
  return false;
}

bool vpRayFit::covariance(const vpBasePose &pose, vpMatrix6d &covariance) const
{
  const Linear linear = linearise(pose, true);
  if (!linear.inFront)
    return false;
  const Columns J = linear.byBase(Eigen::all, m_parameters);
  // As many equations as parameters hold exactly, whatever their weights are.
  const bool exactly = m_level && J.rows() == J.cols();
  const Columns weighted = exactly ? J : Columns(Cholesky(linear.covariance).solve(J));
  const Square normal = J.transpose() * weighted;
  // Conditioned apart from the units of the parameters.
  const Parameters scale = normal.diagonal().cwiseSqrt().cwiseInverse();
  const Square scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  const Eigen::LDLT<Square> factors(scaled);
  if (!scaled.allFinite() || factors.vectorD().minCoeff() < 1e-12)
    return false;
  const Square identity = Square::Identity(scaled.rows(), scaled.cols());
  const Square inverse = scale.asDiagonal() * factors.solve(identity) * scale.asDiagonal();
  if (!m_level)
    covariance = (inverse + inverse.transpose()) / 2;
  else
    covariance = levelCovariance(inverse * weighted.transpose(), linear.covariance,
                                 byCameraTilt(linear.byBase, pose, m_mount), tiltCovariance(pose, m_mount));
  return covariance.allFinite();
}

END_VISP_NAMESPACE
