/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpVlpLocalizer_h
#define vpVlpLocalizer_h

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include <visp3/vlp_core/vpVlpFrame.h>
#include <visp3/vlp_detection/vpLedDetector.h>
#include <visp3/vlp_localization/vpLampMatcher.h>
#include <visp3/vlp_localization/vpManyLampSolver.h>
#include <visp3/vlp_localization/vpTwoLampSolver.h>

BEGIN_VISP_NAMESPACE

//! What one frame gave.
struct VISP_EXPORT vpVlpLocation {
  double timestamp = 0;                        // s, of the frame
  vpVlpFix fix;                                // fix.valid false and fix.refusal where there is no position
  std::vector<vpLampObservation> observations; // every lamp-like region, accepted where it counts for the fix
};

/*!
  The whole system: a frame goes in, a pose comes out. process() is the paper's section 2, top to bottom.

  A map may use one identifier for several lamps, and a reflection shows the identifier of its lamp. Where a
  picture holds such lamps, `matcher` tells by their places which lamp each is. The last pose serves it as a
  hint and nothing else: pictures whose lamps are told apart by their stripes alone are located each by
  itself.
*/
class VISP_EXPORT vpVlpLocalizer
{
public:
  enum class Solver {
    all, //!< least squares over all lamps seen
    two  //!< the paper's double-lamp solver on the pair of best geometry
  };

  Solver solver = Solver::all;
  vpLedDetector detector;
  vpManyLampSolver manyLamps; // its attitude: mount or free
  vpTwoLampSolver twoLamps;
  vpLampMatcher matcher; // under the mount's attitude, with a map tolerance of its own; free: does not run
  double mapTolerance = 0.03; // m, how far lamps may hang from where the map says before they disagree, sigma
  double outlierLikelihood = 1e-4; // lamps disagree where their residuals are less likely than this

  double hintReach = 0.3; // m, how far from the last pose lamps that blink alike are looked for first,
  double maxSpeed = 1;    // m/s, and more by this for the time since then
  double hintTurn = 0.3;  // rad, likewise about the last heading
  double maxTurnRate = 3; // rad/s

  vpVlpLocalizer(const vpVlpRig &rig, const vpLampMap &map);

  /*!
    \throw vpException (dimensionError) where the picture has not the size that the rig states. Whatever else
    is in a picture leads to a position or to a refusal.
  */
  vpVlpLocation process(const vpVlpFrame &frame);

private:
  struct LastPose {
    vpHomogeneousMatrix wMb;
    double time = 0; // s
  };

  vpLampMatch matchByPlace(const std::vector<vpLampObservation> &observations,
                           const std::vector<size_t> &usable, double time) const;

  //! The map's lamp of each, by its id; nullptr: none.
  std::vector<const vpLamp *> lampsOf(const std::vector<vpLampObservation> &observations) const;

  vpVlpRig m_rig;
  vpLampMap m_map;
  std::unordered_map<std::string, size_t> m_lampOf; // index into the map, by id
  std::optional<LastPose> m_lastPose;
};

END_VISP_NAMESPACE

#endif
