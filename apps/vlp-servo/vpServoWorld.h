/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpServoWorld_h
#define vpServoWorld_h

#include <functional>
#include <memory>

#include <visp3/vlp_robot/vpMobileBase.h>
#include <visp3/vlp_servo/vpPictureFeed.h>
#include <visp3/vlp_servo/vpPoseSource.h>
#include <visp3/vlp_servo/vpServoClock.h>

#include "vpVlpServoOptions.h"

BEGIN_VISP_NAMESPACE

//! A robot with its camera and its time, real or simulated.
class vpServoWorld
{
public:
  virtual ~vpServoWorld() = default;

  virtual vpMobileBase &base() = 0;
  virtual vpServoClock &clock() = 0;
  virtual vpPictureFeed &pictures() = 0;
  virtual const vpLampMap &map() const = 0;
  //! Its pose by the lamps.
  virtual std::unique_ptr<vpPoseSource> poses() { return std::make_unique<vpVlpPose>(pictures()); }

  //! The true pose of the base at a time (s) up to now; empty where nobody knows it.
  virtual std::function<vpHomogeneousMatrix(double)> truth() { return {}; }
  //! V, of the battery; empty where nobody knows it.
  virtual std::function<double()> battery() { return {}; }
};

//! Of a robot that is driven without a camera, or whose pictures others look at.
class vpNoPictures : public vpPictureFeed
{
public:
  void addOdometry(const vpOdometry &) override {}
  std::optional<vpLocatedPicture> next(double) override { return std::nullopt; }
};

/*!
  The one place where robots are opened: what `--robot` and `--camera` say. \throw vpException with one line
  where it cannot be opened, or this build has no driver for it.
*/
std::unique_ptr<vpServoWorld> vpOpenServoWorld(const vpVlpServoOptions &options, const vpPath &path);

END_VISP_NAMESPACE

#endif
