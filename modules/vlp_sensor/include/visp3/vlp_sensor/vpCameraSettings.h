/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpCameraSettings_h
#define vpCameraSettings_h

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! The part of the sensor that is read, pixels. A sensor that skips lines has another row time.
struct VISP_EXPORT vpCameraRegion {
  unsigned int left = 0;
  unsigned int top = 0;
  unsigned int width = 0;
  unsigned int height = 0;
};

/*!
  Settings requested from a camera, or reported by it. What is left out stays as the camera has it. Automatic
  exposure and gain are always switched off: they would change stripes from frame to frame.
*/
struct VISP_EXPORT vpCameraSettings {
  std::optional<double> exposure;  // s
  std::optional<double> gain;      // in the camera's own unit: dB, or a number without one
  std::optional<double> frameRate; // Hz
  std::optional<vpCameraRegion> region;

  //! \throw vpException (badValue) with one line: the field, what came and what was expected.
  void check() const;
};

//! What became of the frames that a camera took.
struct VISP_EXPORT vpCameraCounters {
  std::uint64_t delivered = 0; // handed on by next()
  std::uint64_t dropped = 0;   // that the camera numbered and that never arrived
  std::uint64_t broken = 0;    // that arrived with parts missing
  std::uint64_t late = 0;      // whole, yet a newer one was there when next() asked
  unsigned int reconnects = 0; // times that the camera went away and came back

  //! One line that names those which are not 0; empty where every frame was delivered.
  std::string text() const;
};

//! How long a camera is waited for, and on what clock its frames are.
struct VISP_EXPORT vpCameraPatience {
  double silence = 1;      // s without a frame (and five times its period) after which a camera is lost
  double opening = 8;      // s, until a camera that somebody else held a moment ago lets go of it
  double betweenTries = 1; // s, between two tries to find a lost camera again

  //! Clock of the time stamps, s. Empty: vpHostTime().
  std::function<double()> clock;
  //! Asked about twenty times a second while a frame is waited for: true ends the wait. Empty: never.
  std::function<bool()> stop;
};

END_VISP_NAMESPACE

#endif
