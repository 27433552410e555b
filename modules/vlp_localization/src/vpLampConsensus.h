/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampConsensus_h
#define vpLampConsensus_h

#include <functional>
#include <string>
#include <vector>

#include <visp3/vlp_localization/vpVlpFix.h>

BEGIN_VISP_NAMESPACE

/*!
  Which of the lamps seen agree on one pose. A lamp with the wrong id, a reflection, a lamp that hangs
  elsewhere than the map says: each spoils the pose, and no covariance shows it.
*/
class vpLampConsensus
{
public:
  static constexpr const char *elsewhere = "not where the other lamps expect it"; // a remark

  using Solve = std::function<vpVlpFix(const std::vector<vpLampSight> &)>;

  //! \param lamps The map's lamp of each observation; nullptr: none.
  vpLampConsensus(std::vector<const vpLamp *> lamps, const vpVlpRig &rig,
                  const std::vector<vpLampObservation> &observations, double mapTolerance,
                  double outlierLikelihood);

  /*!
    Observations that may be a lamp of the map, whose place is known to a fraction of the lamp. Sets the
    remark of those whose place is not.
    \param which Takes their indices.
  */
  static void usable(std::vector<vpLampObservation> &observations, std::vector<size_t> &which);

  /*!
    The pose of all usable lamps where their residuals are likely under all stated doubts and `mapTolerance`.
    Otherwise that of those that do agree, up to a quarter of the lamps left out one by one; otherwise a
    refusal. One that contradicts all others under the stated doubts alone, which agree without it, is left
    out within `mapTolerance`, too. Lamps that look much larger or smaller than the map says are left out too,
    as long as more do not. A fix whose lamps disagree beyond the stated doubts has its covariance scaled up
    to what they show (Birge's ratio).
  */
  vpVlpFix solve(const std::vector<size_t> &usable, const Solve &solver) const;

  //! Sets `accepted` of the lamps of the fix and the remark of usable lamps that are not among them.
  static void explain(const vpVlpFix &fix, const std::vector<size_t> &usable,
                      std::vector<vpLampObservation> &observations);

private:
  std::vector<vpLampSight> sights(const std::vector<size_t> &which) const;
  double misfit(const vpVlpFix &fix, const std::vector<vpLampSight> &lamps) const;
  bool agree(const vpVlpFix &fix, const std::vector<vpLampSight> &lamps) const;
  vpVlpFix withoutMisplaced(const vpVlpFix &all, std::vector<vpLampSight> &lamps, const Solve &solver) const;
  vpVlpFix withoutWorst(std::vector<vpLampSight> &lamps, const Solve &solver) const;
  std::vector<std::string> wrongSizes(const vpVlpFix &fix, const std::vector<size_t> &usable,
                                      std::string &remark) const;
  vpVlpFix withoutWrongSizes(const vpVlpFix &fix, const std::vector<size_t> &usable,
                             std::vector<vpLampSight> &lamps, const Solve &solver) const;

  const std::vector<const vpLamp *> m_lamps; // of each observation
  const vpVlpRig &m_rig;
  const std::vector<vpLampObservation> &m_observations;
  double m_tolerance;  // m
  double m_likelihood; // probability of residuals below which lamps disagree
};

END_VISP_NAMESPACE

#endif
