/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpNormalEquations.h"

#include <random>

#include <Eigen/Eigenvalues>
#include <ceres/crs_matrix.h>

BEGIN_VISP_NAMESPACE

namespace
{
//! What keeps the factorisation of a matrix with undetermined directions going, as a share of its diagonal.
const double ridge = 1e-12;

Eigen::SparseMatrix<double> kept(const Eigen::SparseMatrix<double> &matrix)
{
  Eigen::SparseMatrix<double> more = matrix;
  const double least = 1e-300;
  for (int i = 0; i < more.rows(); ++i) {
    more.coeffRef(i, i) += ridge * more.coeff(i, i) + least;
  }
  return more;
}
} // namespace

vpNormalEquations::vpNormalEquations(ceres::Problem &problem, const std::vector<double *> &eliminated,
                                     const std::vector<double *> &interest,
                                     const std::vector<ceres::ResidualBlockId> &residuals)
{
  ceres::Problem::EvaluateOptions options;
  int first = 0, second = 0; // columns
  for (double *block : eliminated) {
    if (!problem.IsParameterBlockConstant(block)) {
      options.parameter_blocks.push_back(block);
      first += problem.ParameterBlockTangentSize(block);
    }
  }
  for (double *block : interest) {
    if (!problem.IsParameterBlockConstant(block)) {
      options.parameter_blocks.push_back(block);
      second += problem.ParameterBlockTangentSize(block);
    }
  }
  options.residual_blocks = residuals;
  ceres::CRSMatrix rows;
  problem.Evaluate(options, nullptr, &m_residuals, nullptr, &rows);
  m_jacobian = Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>>(
      rows.num_rows, rows.num_cols, static_cast<Eigen::Index>(rows.values.size()), rows.rows.data(),
      rows.cols.data(), rows.values.data());
  m_normal = Sparse(m_jacobian.transpose()) * m_jacobian;

  const Sparse inner = m_normal.topLeftCorner(first, first), cross = m_normal.topRightCorner(first, second);
  m_information = Eigen::MatrixXd(Sparse(m_normal.bottomRightCorner(second, second)));
  if (first > 0) {
    const Eigen::SimplicialLDLT<Sparse> factors(kept(inner));
    const Eigen::MatrixXd across(cross);
    m_information -= across.transpose() * factors.solve(across);
  }
  m_information = 0.5 * (m_information + m_information.transpose()).eval();
}

Eigen::MatrixXd vpInverseOf(const Eigen::MatrixXd &information)
{
  // Metres, radians, pixels: on a scale of their own all are told apart from what is not known at all.
  const Eigen::VectorXd scale = information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scale.asDiagonal() * information *
                                                             scale.asDiagonal());
  static const double unknown = 1e-13;
  const Eigen::VectorXd inverse = eigen.eigenvalues().cwiseMax(unknown).cwiseInverse();
  return scale.asDiagonal() * eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose() *
         scale.asDiagonal();
}

double vpNormalEquations::redundancy(const std::vector<size_t> &rows) const
{
  if (!m_factors) {
    m_factors = std::make_unique<Eigen::SimplicialLDLT<Sparse>>(kept(m_normal));
  }
  static const int probes = 6;
  std::mt19937_64 signs(1);
  double taken = 0;
  for (int probe = 0; probe < probes; ++probe) {
    Eigen::VectorXd z = Eigen::VectorXd::Zero(m_jacobian.rows());
    for (const size_t row : rows) {
      z(static_cast<Eigen::Index>(row)) = (signs() & 1U) != 0 ? 1 : -1;
    }
    const Eigen::VectorXd y = m_jacobian.transpose() * z;
    taken += y.dot(m_factors->solve(y)) / probes;
  }
  return static_cast<double>(rows.size()) - taken;
}

END_VISP_NAMESPACE
