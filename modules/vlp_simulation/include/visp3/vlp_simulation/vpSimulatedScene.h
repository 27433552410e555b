/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpSimulatedScene_h
#define vpSimulatedScene_h

#include <string>
#include <vector>

#include <Eigen/Core>
#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_simulation/vpEmission.h>
#include <visp3/vlp_simulation/vpLampLight.h>

BEGIN_VISP_NAMESPACE

//! A lamp that hangs there and shines straight down, in a map or not.
struct VISP_EXPORT vpSimulatedLamp {
  vpLamp lamp;        // its size must be known
  vpLampLight light;  // over time
  double level = 180; // grey value that it alone has at the picture's middle, lit and seen from below
                      // at its brightest place
  double rim = 0;     // share by which an even disc is dimmer at its rim, with the square of the distance
  double halfPower =
      1.0471975511965976; // rad off its axis where it shines half as strong; 60 degrees: Lambert's law
  vpEmission emission;    // which of its places shine how much; only an even one has a `rim`
  double blur = 0;        // px of the sensor, standard deviation, on top of the lens's
  bool glows = true;      // on the ceiling about it

  /*!
    Its image in a pane or a shiny plate: the same light, \e share as bright, \e shift (m) beside it, without
    a glow on the ceiling. A mirrored one is turned as an upright mirror half-way there turns it.
    \throw vpException (badValue) where it is mirrored and the shift is upright.
  */
  vpSimulatedLamp image(const Eigen::Vector3d &shift, double share, double extraBlur, bool mirrored) const;
};

//! A flat rectangle that shines without blinking: a window, a door to daylight, a light panel.
struct VISP_EXPORT vpSimulatedWindow {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();       // m, in the map
  Eigen::Vector3d halfWidth = Eigen::Vector3d(0.5, 0, 0); // m, from the centre to the middle of a side
  Eigen::Vector3d halfHeight =
      Eigen::Vector3d(0, 0.5, 0); // m, the same to a neighbouring one, at a right angle
  double level = 300;             // grey value as of a lamp; above 255: saturated
  vpLampLight light;              // dark while it is shut
};

//! Someone who walks under the lamps: an upright cylinder, seen as a dark silhouette.
struct VISP_EXPORT vpSimulatedPerson {
  struct Step {
    double time;              // s
    Eigen::Vector2d position; // m, of the axis
  };
  double radius = 0.25;   // m
  double height = 1.7;    // m above the map's z = 0
  double level = 3;       // grey value of the silhouette
  std::vector<Step> path; // in order of time; stands still before the first and after the last

  //! m, of the axis. \throw vpException (badValue) where the path is empty.
  Eigen::Vector2d at(double time) const;
};

//! What the camera looks up at.
struct VISP_EXPORT vpSimulatedScene {
  std::vector<vpSimulatedLamp> lamps;
  std::vector<vpSimulatedLamp> images; // of lamps, in panes and shiny plates
  std::vector<vpSimulatedWindow> windows;
  std::vector<vpSimulatedPerson> people;
  double ambient = 6; // grey value of the ceiling
  double ceilingShare =
      0; // light that the ceiling beside a lamp's middle gives back, share of the lamp's level
  double ceilingRadius = 0.3; // m: the share falls with the distance d as 1 / (1 + (d / radius)^2)^2
};

END_VISP_NAMESPACE

#endif
