/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampPlaces_h
#define vpLampPlaces_h

#include <string>
#include <vector>

#include <visp3/vlp_core/vpLampMap.h>

BEGIN_VISP_NAMESPACE

//! Lamps that hang somewhere and do not blink yet.
struct vpLampPlaces {
  vpLampMap map;
  std::vector<std::string> comment; // lines to head the file

  /*!
    Places from a lamp map, or from a CSV with the header id,x_m,y_m,z_m. \param diameter m, of lamps that
    have none there; NaN: none. \throw vpException where the file is bad, or a lamp has no size.
  */
  static vpLampPlaces load(const std::string &filename, double diameter);

  //! A grid of that many lamps, a metre apart, about x = y = 0 at that height (m).
  static vpLampPlaces grid(size_t count, double diameter, double z);
};

END_VISP_NAMESPACE

#endif
