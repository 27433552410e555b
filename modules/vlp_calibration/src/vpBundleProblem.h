/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpBundleProblem_h
#define vpBundleProblem_h

#include <array>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <ceres/problem.h>
#include <visp3/vlp_calibration/vpLampBundle.h>

#include "vpBundleStart.h"
#include "vpNormalEquations.h"

BEGIN_VISP_NAMESPACE

struct vpImageResidual;

/*!
  The Ceres problem of vpLampBundle, and the values that it moves. Solved, weighed and solved again.
*/
class vpBundleProblem
{
public:
  vpBundleProblem(const vpLampBundle &bundle, const std::vector<vpLampRun> &runs, const vpVlpRig &prior,
                  const vpLampMap &priorMap, vpBundleStart &start);

  //! Builds the problem of the images still used and solves it. \return False where there is no solution.
  bool solve();

  //! Weighs images and odometry by what their residuals show. \return Whether the weights were right before.
  bool weigh();

  //! Leaves out images that are too far off. \return How many.
  size_t dropOutliers();

  vpBundleResult result();

private:
  using Vector5d = Eigen::Matrix<double, 5, 1>;
  //! Rows of the residuals, in the order of m_blocks.
  enum class Row { image, rates, along, sideways, turn, slip, other };
  //! A view's values: those of a spin share one position.
  struct Pose {
    double *position;
    double heading;
  };

  void build();
  Eigen::Vector2d ratesSigma(const vpBundleView &view) const;
  void placeMiddles();
  vpImageResidual imageResidual(size_t view, size_t image) const;
  void addImages();
  void addMotion();
  void addStep(size_t view);
  double *slipAt(size_t view, double since);
  void addPriors();
  void hold();
  void add(ceres::CostFunction *cost, bool robust, const std::vector<double *> &blocks,
           const std::vector<Row> &rows);
  vpNormalEquations equations();
  Eigen::MatrixXd covariance();
  std::vector<size_t> rowsOf(Row kind) const;
  std::vector<std::string> unseparated();
  vpRigMatrix covarianceOf(const Eigen::MatrixXd &covariance) const;
  vpBundleResidual residualOf(size_t view, size_t image);

  const vpLampBundle &m_bundle;
  const std::vector<vpLampRun> &m_runs;
  const vpVlpRig &m_prior; // the middle of the priors
  const vpLampMap &m_priorMap;
  vpBundleStart &m_start;

  vpRigVector m_rig;                      // step from the start's rig
  Vector5d m_odometry = Vector5d::Zero(); // as vpOdometryError
  std::vector<Eigen::Vector3d> m_lamps;
  std::deque<Eigen::Vector2d> m_positions; // a deque: its places in memory stay
  std::vector<Pose> m_poses;
  std::vector<std::optional<vpPlanarStep>> m_steps; // of the odometry, to each view from the one before
  std::vector<Eigen::Vector2d> m_slips;             // of the wheels over these, a share
  std::vector<Eigen::Vector2d> m_rates;             // what speed and turn rate are off by within each view

  double m_imageWeight = 0.03;  // at first: from a start that is far off, exact images are a long narrow way
  double m_imageRedundancy = 0; // rows of images less what they determine
  double m_ratesWeight = 1;
  double m_slipWeight = 1;
  //! Along, sideways, turn. A base that can hardly go sideways comes to no end from a start that is far off:
  //! at first it may.
  Eigen::Vector3d m_stepWeight = Eigen::Vector3d(1, 0.02, 1);
  bool m_rolls = false;                // it may no more
  std::array<double, 6> m_lastSteps{}; // of each kind's logarithm of the weight; 0: none to go by
  bool m_converged = false;            // to a minimum, the last time

  std::unique_ptr<ceres::Problem> m_problem;
  std::vector<ceres::ResidualBlockId> m_blocks;
  std::vector<Row> m_rows;
  std::vector<int> m_freeRig; // indices of rig parameters that are free, ascending
};

END_VISP_NAMESPACE

#endif
