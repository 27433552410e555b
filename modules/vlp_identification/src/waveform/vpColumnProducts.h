/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpColumnProducts_h
#define vpColumnProducts_h

#include <Eigen/Core>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! Scalar products of \e count columns, of \e rows numbers each and one behind the other, with \e x.
void vpColumnProducts(const double *columns, Eigen::Index rows, Eigen::Index count, const double *x,
                      double *sums);

END_VISP_NAMESPACE

#endif
