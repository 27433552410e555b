/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPulseWave_h
#define vpPulseWave_h

#include <Eigen/Core>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! A wave that is 1 in the first part of each period and 0 in the rest, averaged over windows of time; and
//! its derivatives. One entry a window.
struct vpPulseWave {
  Eigen::ArrayXd value;
  Eigen::ArrayXd byTurn;  // by how many periods have passed
  Eigen::ArrayXd byWidth; // by the window's width, periods
  Eigen::ArrayXd byDuty;

  //! \param time Of the windows' middles, s. \param phase Periods that have passed at time 0. \param width Of
  //! the windows, periods. \param duty The part that is 1.
  void evaluate(const Eigen::ArrayXd &time, double frequency, double phase, double width, double duty);
  //! The same into memory of one's own. \param n Windows.
  static void evaluate(const double *time, Eigen::Index n, double frequency, double phase, double width,
                       double duty, double *value, double *byTurn, double *byWidth, double *byDuty);
  //! The same without the derivatives, added to what \e sum holds.
  static void addValue(const Eigen::ArrayXd &time, double frequency, double phase, double width, double duty,
                       Eigen::ArrayXd &sum);
};

END_VISP_NAMESPACE

#endif
