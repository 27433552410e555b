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

  //! The true pose of the base at a time (s) up to now; empty where nobody knows it.
  virtual std::function<vpHomogeneousMatrix(double)> truth() { return {}; }
  //! V, of the battery; empty where nobody knows it.
  virtual std::function<double()> battery() { return {}; }
};

/*!
  The one place where robots are opened: what `--robot` and `--camera` say. \throw vpException with one line
  where it cannot be opened, or this build has no driver for it.
*/
std::unique_ptr<vpServoWorld> vpOpenServoWorld(const vpVlpServoOptions &options, const vpPath &path);

END_VISP_NAMESPACE

#endif
