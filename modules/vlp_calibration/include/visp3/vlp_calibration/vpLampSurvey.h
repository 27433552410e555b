/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampSurvey_h
#define vpLampSurvey_h

#include <optional>
#include <string>
#include <vector>

#include <visp3/vlp_calibration/vpLampBundle.h>

BEGIN_VISP_NAMESPACE

//! A surveyed lamp compared with the map.
struct VISP_EXPORT vpSurveyedLamp {
  enum class State {
    measured,     //!< it was given
    found,        //!< where the map has it, within both uncertainties
    displaced,    //!< elsewhere
    undetermined, //!< seen too little: it stays where the map has it
    unseen        //!< likewise
  };
  State state = State::unseen;
  Eigen::Vector3d offset = Eigen::Vector3d::Zero(); // m, from where the map has it to where it is
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();  // m, of where it is
  size_t images = 0;
};

//! What a survey found.
struct VISP_EXPORT vpSurveyResult {
  vpBundleResult bundle;             // its map: lamps where they hang, with their sigma
  std::vector<vpSurveyedLamp> lamps; // in the order of the map
};

/*!
  Where lamps hang, from a drive with odometry under them and two lamps or more measured by hand, or one
  distance: a bundle adjustment over the whole run. Of the other lamps the map's positions are not used, only
  compared with the result in the end.

  The rig's mount takes part with the standard deviations that its file states: calibrate the mount first.
*/
class VISP_EXPORT vpLampSurvey
{
public:
  vpLampBundle bundle;                    // its rigSigma: the rig's own; its lampSigma is set by solve()
  std::vector<size_t> measured;           // indices into the map of lamps whose place is exact
  std::optional<vpLampDistance> distance; // in their place
  double mapSigma = 0.005;                // m, of a map that states no position_sigma_m, for this comparison
  double gate = 4;                        // standard deviations beyond which a lamp is displaced
  double worstSigma = 0.1;                // m, from which on a lamp is undetermined
  size_t fewestViews = 20;                // frames that show two lamps or more

  /*!
    Where measured lamps do not explain the pictures, their sigma is inflated until they do
    (vpBundleResult::inflatedLampSigma). Refuses, with one line that says what to do: too few frames, a robot
    that stands still, odometry of another clock, unit or sign, measured lamps that are swapped. \throw
    vpException (badValue) where neither two measured lamps nor a distance is given, or both.
  */
  vpSurveyResult solve(const std::vector<vpLampRun> &runs, const vpVlpRig &rig, const vpLampMap &map) const;

private:
  vpLampBundle bundleOf(const vpLampMap &map) const;
  std::string swappedLamps(const std::vector<vpLampRun> &runs, const vpVlpRig &rig, const vpLampMap &map,
                           double offset) const;
  std::vector<vpSurveyedLamp> heldAgainst(const vpLampMap &map, const vpBundleResult &result) const;
};

END_VISP_NAMESPACE

#endif
