/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpVlpLocalizer_h
#define vpVlpLocalizer_h

#include <vector>

#include <visp3/vlp_core/vpVlpFrame.h>
#include <visp3/vlp_detection/vpLedDetector.h>
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
  double mapTolerance = 0.03; // m, how far lamps may hang from where the map says before they disagree, sigma
  double outlierLikelihood = 1e-4; // lamps disagree where their residuals are less likely than this

  vpVlpLocalizer(const vpVlpRig &rig, const vpLampMap &map);

  /*!
    \throw vpException (dimensionError) where the picture has not the size that the rig states. Whatever else
    is in a picture leads to a position or to a refusal.
  */
  vpVlpLocation process(const vpVlpFrame &frame);

private:
  vpVlpRig m_rig;
  vpLampMap m_map;
};

END_VISP_NAMESPACE

#endif
