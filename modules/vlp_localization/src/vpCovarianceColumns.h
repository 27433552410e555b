/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpCovarianceColumns_h
#define vpCovarianceColumns_h

#include <Eigen/Core>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! Where vpVlpFilter spends its time: columns of its covariance, of \e size numbers each, all matrices by
//! columns.
namespace vpCovarianceColumns
{
/*!
  Sums of columns of \e P, into as many columns of \e sums as there are \e values, 2 or 3.
  \param at, count Which columns. \param weights One row for each of these, \e stride rows by \e values.
*/
void sum(const double *P, Eigen::Index size, const Eigen::Index *at, int count, const double *weights,
         int stride, int values, double *sums);

//! P - K W' - W K', of its columns from \e from on. \param K, W \e size rows by \e values, 2 or 3.
void subtract(double *P, Eigen::Index size, Eigen::Index from, Eigen::Index until, const double *K,
              const double *W, int values);
} // namespace vpCovarianceColumns

END_VISP_NAMESPACE

#endif
