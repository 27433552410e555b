/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampIndex_h
#define vpLampIndex_h

#include <complex>
#include <string>
#include <unordered_map>
#include <vector>

#include <visp3/vlp_core/vpLampMap.h>

BEGIN_VISP_NAMESPACE

//! The blinking lamps of a map by identifier, and each identifier's in the order of x. Private to the module.
class vpLampIndex
{
public:
  struct Lamp {
    std::complex<double> place; // x + iy, m
    double height = 0;          // m
    double positionSigma = 0;   // m
    size_t identifier = 0;      // index into vpLampMap::identifiers(); nowhere of a lamp that does not blink
  };
  static constexpr size_t nowhere = static_cast<size_t>(-1);

  explicit vpLampIndex(const vpLampMap &map);

  //! By the lamp's index in the map.
  const Lamp &lamp(size_t index) const { return m_lamps[index]; }
  //! Index in the map of the blinking lamp of that id; nowhere where there is none.
  size_t find(const std::string &id) const;
  //! Blinking lamps.
  size_t size() const { return m_byName.size(); }
  //! Of these, the lamps of an identifier.
  size_t carriers(size_t identifier) const;
  double lowest() const { return m_lowest; }               // m, height of the lowest blinking lamp
  double highest() const { return m_highest; }             // m
  double greatestSigma() const { return m_greatestSigma; } // m, of the blinking lamps' positions
  //! Of the rectangle that lies \e margin (m) around the blinking lamps, m^2.
  double area(double margin) const { return (m_length + 2 * margin) * (m_width + 2 * margin); }

  //! Lamps of \e identifier no farther than \e radius (m) from \e place, into \e found.
  void within(size_t identifier, const std::complex<double> &place, double radius,
              std::vector<size_t> &found) const;

private:
  std::vector<Lamp> m_lamps;
  std::unordered_map<std::string, size_t> m_byName;
  std::vector<std::vector<size_t>> m_byIdentifier;
  double m_lowest = 0;
  double m_highest = 0;
  double m_greatestSigma = 0;
  double m_length = 0; // m, along x
  double m_width = 0;  // m, along y
};

END_VISP_NAMESPACE

#endif
