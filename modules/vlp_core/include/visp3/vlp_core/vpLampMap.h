/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampMap_h
#define vpLampMap_h

#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <visp3/vlp_core/vpModulation.h>

BEGIN_VISP_NAMESPACE

class vpYamlNode;

//! A lamp of the map: where it hangs, how it looks, how it blinks.
struct VISP_EXPORT vpLamp {
  enum class Shape { disk, square };

  std::string id;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();     // m, the lamp's middle in the map frame w (z up)
  double positionSigma = 0;                               // m, standard deviation of each coordinate
  Shape shape = Shape::disk;                              // lies flat, its light going straight down
  double size = std::numeric_limits<double>::quiet_NaN(); // m, diameter or side; NaN: not measured
  double yaw = 0; // rad about z, of a square: its sides along x and y at 0
  vpModulation modulation;
  double oscillatorPpm = 50; // standard deviation of its clock; 50: a crystal, 10000: RC

  //! Reads one entry of a lamps.yaml and finishes it. \throw vpException as vpLampMap::load().
  static vpLamp read(const vpYamlNode &node);
};

//! Lamps of a map that send the same signal: stripes distinguish them from all others, and only their
//! positions from each other.
struct VISP_EXPORT vpIdentifier {
  vpModulation modulation;
  double oscillatorPpm = 50;
  std::vector<size_t> lamps; // indices into vpLampMap::lamps, ascending
};

//! The lamps of a place, as read from and written to a lamps.yaml.
struct VISP_EXPORT vpLampMap {
  std::vector<vpLamp> lamps;

  /*!
    The identifiers that the lamps carry, in the order in which the lamps first show them: lamps of equal
    modulation (vpModulation::sameSignal()) and equal oscillator share one. Unmodulated lamps have none.
  */
  std::vector<vpIdentifier> identifiers() const;

  //! The lamp of that id, or nullptr.
  const vpLamp *find(const std::string &id) const;

  /*!
    Reads a lamps.yaml. \throw vpException (badValue or ioError) with one line that names file, line, field,
    what came and what was expected: unknown or missing key, wrong type, duplicate id, number out of its
    range.
  */
  static vpLampMap load(const std::string &filename);

  /*!
    Writes a lamps.yaml that load() reads back unchanged; to a temporary name first, then renamed.
    \param comment Lines that head the file, each behind a #.
  */
  void save(const std::string &filename, const std::vector<std::string> &comment = {}) const;
};

END_VISP_NAMESPACE

#endif
