/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpMountCalibration_h
#define vpMountCalibration_h

#include <vector>

#include <visp3/vlp_calibration/vpLampBundle.h>

BEGIN_VISP_NAMESPACE

/*!
  How a camera sits on its robot, and its principal point and focal length, from lamps alone: by spinning on
  the spot and driving a square, or from known places. The paper's authors did the latter by hand for the
  principal point.

  Which motion shows which parameter. A lean of the camera traces a circle while the robot spins, and bends
  the picture of the lamps; its offset on the base traces one as well, of the same size for near lamps and far
  ones; its heading shows in the direction that a rolling base goes; principal point and focal length separate
  from offset and height only where lamps hang at different heights. Parameters that the pictures do not
  separate are refused, unless they are held or have a prior.

  \code
  vpMountCalibration calibration;
  calibration.bundle.rigSigma(int(vpRigParameter::focal)) = 0; // held
  const vpBundleResult found = calibration.solve(runs, rig, map);
  \endcode
*/
class VISP_EXPORT vpMountCalibration
{
public:
  vpLampBundle bundle;     // its rigSigma: all free; its lampSigma is set by solve()
  size_t fewestViews = 20; // frames that show two lamps or more

  vpMountCalibration() { bundle.rigSigma.setConstant(vpLampBundle::free); }

  /*!
    Lamps of \e map that state a sigma take part with it, others count as exact, unless the pictures show that
    they are not: then their sigma is inflated (vpBundleResult::inflatedLampSigma). Refuses, with one line
    that says what to do: too few frames, a robot that stands still, odometry of another clock, unit or sign,
    lamps that are swapped in the map, lamps that hang elsewhere, parameters that the pictures do not
    separate.
  */
  vpBundleResult solve(const std::vector<vpLampRun> &runs, const vpVlpRig &rig, const vpLampMap &map) const;

private:
  std::string swappedLamps(const std::vector<vpLampRun> &runs, const vpVlpRig &rig,
                           const vpLampMap &map) const;
};

END_VISP_NAMESPACE

#endif
