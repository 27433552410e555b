/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpBundleStart_h
#define vpBundleStart_h

#include <string>
#include <vector>

#include <visp3/vlp_calibration/vpLampBundle.h>

#include "vpOdometryPath.h"

BEGIN_VISP_NAMESPACE

//! A view as the bundle adjustment uses it.
struct vpBundleView {
  size_t run = 0, view = 0;            // indices into what was given
  double time = 0;                     // s, of its pose
  vpPlanarPose start;                  // of its pose
  std::vector<vpPlanarStep> since;     // to each of its images
  std::vector<bool> used;              // each of its images
  std::vector<Eigen::Vector2d> points; // px, of each of its images, as the rig that was found last has them
};

/*!
  Where Levenberg-Marquardt starts from: poses of the frames, and places of lamps whose map position is no
  prior. A frame that shows two lamps whose places are known has its pose from these (vpManyLampSolver); a
  lamp without a prior is where the rays from such poses come nearest to each other, and is known then. So it
  goes on from the lamps that have a prior; what is left follows its neighbours along the odometry.
*/
struct vpBundleStart {
  std::string refusal; // one line, where there is no start
  std::vector<vpBundleView> views;
  std::vector<vpOdometryPath> paths; // of each run
  vpVlpRig rig;                      // as given, its heading turned where the way shows that it is far off
  vpLampMap map;

  vpBundleStart(const vpLampBundle &bundle, const std::vector<vpLampRun> &runs, const vpVlpRig &rig,
                const vpLampMap &map);

private:
  bool placeByLamps(const std::vector<vpLampRun> &runs);
  void placeByWheels(const std::vector<vpLampRun> &runs);
  void followWheels(const std::vector<vpLampRun> &runs);
  void dropUnplaced();
  void turnHeading(const vpLampBundle &bundle, const std::vector<vpLampRun> &runs);
  bool placeLamps(const vpLampBundle &bundle, const std::vector<vpLampRun> &runs);
  void alignToDistance(const vpLampBundle &bundle, const vpLampMap &given);
  void followImages(const std::vector<vpLampRun> &runs);

  std::vector<bool> m_placed; // each view
  std::vector<bool> m_known;  // each lamp whose map position is a prior, or that was placed
};

END_VISP_NAMESPACE

#endif
