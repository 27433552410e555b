/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef trackedScenes_h
#define trackedScenes_h

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <visp3/vlp_tracking/vpCamshiftKalmanTracker.h>

#include "common/vpTargetScene.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace trackedScenes
{
//! Small pictures, quickly made.
inline vpTargetScene scene(unsigned int seed)
{
  vpTargetScene scene(seed);
  scene.width = 400;
  scene.height = 300;
  scene.size = 40;
  scene.path = [](int k) { return Eigen::Vector2d(60.3 + 3.2 * k, 120.4 + 0.7 * k); };
  return scene;
}

inline vpTargetScene textured(unsigned int seed)
{
  vpTargetScene made = scene(seed);
  made.square = true;
  made.target = {cv::Scalar::all(150), 40, 6};
  return made;
}

inline vpTargetScene stripedLamp(unsigned int seed)
{
  vpTargetScene made = scene(seed);
  made.background = {cv::Scalar::all(12), 2, 8};
  made.target = {cv::Scalar::all(200), 0, 8};
  made.obstacle = {cv::Scalar::all(45), 8, 8}; // exposed so shortly, all but lamps is dark
  made.stripePeriod = 3.5 + 1.5 * seed;
  return made;
}

//! What a tracker made of the frames from the second on.
struct Track {
  std::vector<double> errors; // px, off the middle
  std::vector<bool> seen;
  std::vector<double> similarity;

  double meanError() const
  {
    double sum = 0;
    for (double error : errors)
      sum += error;
    return sum / static_cast<double>(errors.size());
  }
  double worstError() const { return *std::max_element(errors.begin(), errors.end()); }
  bool alwaysSeen() const { return std::find(seen.begin(), seen.end(), false) == seen.end(); }
};

inline double errorOf(const vpTargetTracker &tracker, const vpTargetScene &scene, int frame)
{
  const Eigen::Vector2d truth = scene.path(frame);
  return std::hypot(tracker.center().get_u() - truth.x(), tracker.center().get_v() - truth.y());
}

inline Track run(vpTargetTracker &tracker, const vpTargetScene &scene, int frames, bool colour = false)
{
  Track track;
  if (colour)
    tracker.initTracking(scene.colour(0), scene.firstWindow());
  else
    tracker.initTracking(scene.grey(0), scene.firstWindow());
  for (int k = 1; k < frames; ++k) {
    track.seen.push_back(colour ? tracker.track(scene.colour(k)) : tracker.track(scene.grey(k)));
    track.errors.push_back(errorOf(tracker, scene, k));
    track.similarity.push_back(tracker.similarity());
  }
  return track;
}

inline void expectFinite(const vpCamshiftKalmanTracker &tracker)
{
  for (const double value : {tracker.center().get_u(), tracker.center().get_v(), tracker.window().getWidth(),
                             tracker.window().getHeight(), tracker.window().getLeft(),
                             tracker.window().getTop(), tracker.velocity().get_u(),
                             tracker.velocity().get_v(), tracker.positionSigma(), tracker.similarity()})
    EXPECT_TRUE(std::isfinite(value));
  EXPECT_GE(tracker.similarity(), 0);
  EXPECT_LE(tracker.similarity(), 1);
}
} // namespace trackedScenes

#endif
