/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpEvaluation_h
#define vpEvaluation_h

#include <optional>
#include <string>
#include <vector>

#include <visp3/vlp_evaluation/vpConsistency.h>
#include <visp3/vlp_evaluation/vpDispersion.h>
#include <visp3/vlp_evaluation/vpErrorStatistics.h>
#include <visp3/vlp_evaluation/vpFixLog.h>
#include <visp3/vlp_evaluation/vpPosePairs.h>
#include <visp3/vlp_evaluation/vpTrackLine.h>

BEGIN_VISP_NAMESPACE

//! How poses are compared with the truth.
struct VISP_EXPORT vpEvaluationSettings {
  vpAlignment alignment = vpAlignment::none;
  double longestGap = 1;           // s, of the truth, over which it is interpolated
  std::optional<vpTrackLine> line; // that the robot was to drive; default: vpTrackLine::of the truth
};

//! Statistics of a run's log beyond its poses.
struct VISP_EXPORT vpFixStatistics {
  size_t frames = 0;
  size_t fixes = 0;          // frames with a position that is the only one
  size_t ambiguous = 0;      // frames with two
  vpErrorStatistics compute; // s, over all frames
  vpConsistency position{2}; // NEES of (x, y)
  vpConsistency height{1};   // of z
  vpConsistency yaw{1};      // of yaw

  double share() const { return frames == 0 ? 0 : static_cast<double>(fixes) / static_cast<double>(frames); }
};

//! A number of an evaluation for other programs.
struct VISP_EXPORT vpStatistic {
  std::string name; // as horizontal_rmse
  std::string unit; // m, rad, s, or 1
  double value = 0;
};

/*!
  An estimated trajectory compared with the truth: the statistics of the paper's section 3, and those that it
  lacks. Errors are the estimate minus the truth of the same time (m, rad, along the axes of w).
*/
struct VISP_EXPORT vpEvaluation {
  size_t truthPoses = 0;
  size_t estimatePoses = 0;
  size_t outside = 0; // of the estimate's poses, without truth: as vpPosePairs
  size_t inGaps = 0;
  double longestGap = 0; // s

  vpAlignment alignment = vpAlignment::none;
  vpHomogeneousMatrix tTe; // of that alignment
  vpTrajectory truth;
  std::vector<vpPosePair> pairs; // the estimate aligned

  vpErrorStatistics x, y, z;            // m
  vpErrorStatistics yaw;                // rad
  vpErrorStatistics horizontal;         // m, distances
  vpErrorDistribution distribution{{}}; // of the horizontal distances

  //! Of the errors (x, y). For a robot that stands still these are its positions shifted by one vector, so
  //! that it is the paper's dispersion; for one that moves it is that of its errors.
  vpDispersion dispersion;

  std::optional<vpTrackLine> line;    // given, or of the truth
  vpErrorDistribution offLine{{}};    // m, distances of the estimate from it
  vpErrorStatistics lineDistance;     // of the same
  std::optional<vpFittedLine> fitted; // to the estimate, where there is a line

  std::optional<vpFixStatistics> fixes; // where a log is given

  /*!
    \param fixes Log of the same run, or nullptr. Its poses are compared with the truth unaligned; under an
    alignment their covariances belong to another map, and no consistency is stated. Neither do fixes count
    there that are ambiguous, or have no sigma above 0.
    \return Without any pair of poses, the log's statistics and 0 for all errors.
    \throw vpException (badValue) where the longest gap is not above 0, or an error is beyond all numbers.
  */
  static vpEvaluation of(const vpTrajectory &truth, const vpTrajectory &estimate,
                         const vpFixLog *fixes = nullptr,
                         const vpEvaluationSettings &settings = vpEvaluationSettings());

  /*!
    All numbers, in base units. For x, y, z, yaw, horizontal and line: _mean, _median, _rmse, _std, _p90,
    _p95, _max, as vpErrorStatistics defines them. What does not apply is left out.
  */
  std::vector<vpStatistic> statistics() const;

  //! The same as CSV, `name,unit,value`.
  std::string csv() const;
};

END_VISP_NAMESPACE

#endif
