/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpNormalEquations_h
#define vpNormalEquations_h

#include <memory>
#include <vector>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <ceres/problem.h>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  The normal equations of a Ceres problem at its present values, robust losses applied: what is known of a few
  blocks of interest once the many others (poses, say) are eliminated, and how much freedom residuals have
  left. Unlike ceres::Covariance it holds where the blocks of interest are not determined: that is what is to
  be found out.
*/
class vpNormalEquations
{
public:
  /*!
    \param eliminated Blocks that the rest determines. \param interest The other ones. Constant ones count in
    neither. \param residuals In the order in which redundancy() counts their rows.
  */
  vpNormalEquations(ceres::Problem &problem, const std::vector<double *> &eliminated,
                    const std::vector<double *> &interest,
                    const std::vector<ceres::ResidualBlockId> &residuals);

  //! Information of the blocks of interest, in their tangent spaces: the Schur complement.
  const Eigen::MatrixXd &information() const { return m_information; }

  //! Weighted residuals, row by row.
  const std::vector<double> &residuals() const { return m_residuals; }

  /*!
    Redundancy of some rows: their number less what the parameters take away, n - tr(J C J^T), by Hutchinson's
    estimator of the trace (1990) with fixed signs.
  */
  double redundancy(const std::vector<size_t> &rows) const;

private:
  using Sparse = Eigen::SparseMatrix<double>;

  Sparse m_jacobian;
  Sparse m_normal;                                                  // J^T J
  mutable std::unique_ptr<Eigen::SimplicialLDLT<Sparse>> m_factors; // of m_normal, once asked for
  Eigen::MatrixXd m_information;
  std::vector<double> m_residuals;
};

//! Covariance of what has that information, whatever its units; very large where nothing is known.
Eigen::MatrixXd vpInverseOf(const Eigen::MatrixXd &information);

END_VISP_NAMESPACE

#endif
