/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpServoDisplay_h
#define vpServoDisplay_h

#include <functional>
#include <memory>
#include <vector>

#include <visp3/vlp_servo/vpServoRun.h>

#include "vpServoWorld.h"

BEGIN_VISP_NAMESPACE

/*!
  What a person watches of a run: the camera's picture with its lamps, the map with path and robot
  (vpVlpDashboard), and ViSP's plot of velocities and errors. Without a screen it says so once, and shows
  nothing.
*/
class vpServoDisplay
{
public:
  //! \param wanted False: shows nothing, and needs no screen. \e world outlives this.
  vpServoDisplay(bool wanted, const vpPath &path, vpServoWorld &world);
  ~vpServoDisplay();
  vpServoDisplay(const vpServoDisplay &) = delete;
  vpServoDisplay &operator=(const vpServoDisplay &) = delete;

  //! One period. \return False once somebody has clicked.
  bool show(const vpServoStep &step, const std::vector<vpLocatedPicture> &pictures);

private:
  struct Impl;
  std::function<vpHomogeneousMatrix(double)> m_truth; // may be empty
  std::unique_ptr<Impl> m_impl;                       // none where nothing is shown
};

END_VISP_NAMESPACE

#endif
