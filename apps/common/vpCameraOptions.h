/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpCameraOptions_h
#define vpCameraOptions_h

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <visp3/vlp_core/vpVlpRig.h>
#include <visp3/vlp_sensor/vpFrameSource.h>

#include "common/vpProgram.h"

BEGIN_VISP_NAMESPACE

//! Frames from a camera, as the programs' command lines ask for them: --camera, --camera-exposure and so on.
struct vpCameraOptions {
  std::string uri;                // or the folder of a run in its place; empty: no camera was asked for
  std::optional<double> exposure; // s; as it comes the rig's
  std::optional<double> gain;     // in the camera's own unit; as it comes what the camera has
  std::optional<double> rate;     // Hz; likewise

  void add(CLI::App &app);

  //! \throw vpException (badValue) where something is asked of a camera that was not asked for.
  void check() const;

  /*!
    Opens it, with vpHostTime() as its clock: the sensor's whole picture where the rig states a resize, which
    is then done here, else a picture of the rig's size, or of the camera's where \e rig states none. Waiting
    for a frame ends with vpInterrupt, or where \e stop says so. \throw vpException as vpCameraSource.
  */
  std::unique_ptr<vpFrameSource> open(const vpVlpRig &rig, const std::function<bool()> &stop = {}) const;

  //! Prints all cameras that are found, with what they can do. \return nothingFound where there is none.
  static vpExitCode list();
};

END_VISP_NAMESPACE

#endif
