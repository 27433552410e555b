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
    The pose of all usable lamps where their residuals are likely under all stated covariances and
    `mapTolerance`. Otherwise that of those that do agree, up to a quarter of the lamps left out one by one;
    otherwise a refusal. One that contradicts all others under the stated covariances alone, which agree
    without it, is left out within `mapTolerance`, too. Lamps that look much larger or smaller than the map
    says are left out too, as long as more do not. A fix whose lamps disagree beyond these has its covariance
    scaled up to what they show (Birge's ratio).
  */
  vpVlpFix solve(const std::vector<size_t> &usable, const Solve &solver) const;

  //! Sets `accepted` of the lamps of the fix and the remark of usable lamps that are not among them.
  static void explain(const vpVlpFix &fix, const std::vector<size_t> &usable,
                      std::vector<vpLampObservation> &observations);

private:
  //! Some of the observations, by their indices, and their pose.
  struct Group {
    std::vector<size_t> which;
    vpVlpFix fix;
  };

  Group solved(const std::vector<size_t> &which, const Solve &solver) const;
  std::vector<Group> allButOne(const Group &all, const Solve &solver) const;
  double misfit(const Group &group) const;
  Group withoutMisplaced(const Group &all, const Solve &solver) const;
  Group withoutWrongSizes(const Group &all, const Solve &solver) const;

  const std::vector<const vpLamp *> m_lamps; // of each observation
  std::vector<vpLampSight> m_sights;         // likewise, where there is a lamp
  const vpVlpRig &m_rig;
  const std::vector<vpLampObservation> &m_observations;
  double m_tolerance;  // m
  double m_likelihood; // probability of residuals below which lamps disagree
};

END_VISP_NAMESPACE

#endif
