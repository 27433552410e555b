/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpScenario_h
#define vpScenario_h

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_core/vpVlpRig.h>
#include <visp3/vlp_simulation/vpRobotMotion.h>
#include <visp3/vlp_simulation/vpRollingShutterRenderer.h>
#include <visp3/vlp_simulation/vpSimulatedScene.h>

BEGIN_VISP_NAMESPACE

/*!
  What a scenario file states: the robot's files, where the simulated world differs from them, how the robot
  moves, and what is drawn at random. A seed makes a vpSimulation of it.
*/
struct VISP_EXPORT vpScenario {
  //! Where the camera and the robot differ from the rig file. Added to, or multiplied with, its values.
  struct Deviation {
    Eigen::Vector2d tilt = Eigen::Vector2d::Zero();           // rad, the camera turned about x and y of b
    Eigen::Vector2d principalPoint = Eigen::Vector2d::Zero(); // px of the sensor
    double focalLength = 1;
    double rowTime = 1;
  };

  //! Standard deviations of what each seed draws anew.
  struct Draw {
    double tilt = 0;           // rad, each of the two
    double principalPoint = 0; // px of the sensor, each of the two
    double focalLength = 0;    // share
    double rowTime = 0;        // share
    double lampShift = 0;      // m, each coordinate of each lamp
    bool clocks = true;        // the lamps' clocks run as their oscillator_ppm allows
  };

  //! How the lamps of the map shine, and where they truly hang.
  struct Lamp {
    vpSimulatedLamp simulated;                       // its light still without clock and phase
    Eigen::Vector3d shift = Eigen::Vector3d::Zero(); // m, from where the map has it
    double clockPpm = 0;                             // ppm, on top of what is drawn
    std::vector<std::pair<double, double>> dark;     // s, from and until
  };

  //! What a pane or a shiny plate shows of a lamp, wherever that truly hangs.
  struct SecondImage {
    size_t lamp = 0;                                 // index into lamps
    Eigen::Vector3d shift = Eigen::Vector3d::Zero(); // m, from the lamp
    double share = 0;                                // of the lamp's brightness
    double blur = 0;                                 // px of the sensor, standard deviation
    bool mirrored = false;
  };

  //! How the robot moves: held in places, or driven.
  struct Motion {
    std::vector<vpHomogeneousMatrix> stations; // wMb; empty: it is driven
    double hold = 0;                           // s at each station
    std::vector<vpTimedVelocity> commands;
    vpSimulatorTurtleBot3Settings robot;
  };

  vpVlpRig rig;  // as the robot's files state; its exposure already in whole lines where the camera has it so
  vpLampMap map; // as the robot's files state
  Deviation deviation;
  Draw draw;
  vpSimulatedCamera camera; // all but its rig
  vpSimulatedScene scene;   // all but its lamps
  std::vector<Lamp> lamps;  // those of the map and those in no map
  std::vector<SecondImage> secondImages;
  Motion motion;
  double frameRate = 12; // Hz
  size_t frames = 0;

  /*!
    Reads a scenario file (data/README.md explains each key); the files that it names are relative to it.
    \throw vpException with one line that names file, line, field, what came and what was expected.
  */
  static vpScenario load(const std::string &filename);

  /*!
    Draws the errors of a typical rig in place of the scenario's own: standard deviations of 0.15 degree of
    roll and of pitch, 2 mm of each lamp's x, y and z, 1 px of the sensor's principal point, 0.3 % of the
    focal length, 0.05 % of the row time. The robot's rig and map state these standard
    deviations, not the errors drawn.
  */
  void useTypicalRig();

  std::unique_ptr<vpRobotMotion> makeMotion() const;
};

END_VISP_NAMESPACE

#endif
