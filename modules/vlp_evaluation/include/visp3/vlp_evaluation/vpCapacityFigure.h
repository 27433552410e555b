/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpCapacityFigure_h
#define vpCapacityFigure_h

#include <string>
#include <vector>

#include <visp3/vlp_evaluation/vpEvaluationFigures.h>

BEGIN_VISP_NAMESPACE

//! How many identifiers there are for lamps of so many lines.
struct VISP_EXPORT vpCapacityCurve {
  struct Point {
    double lines, identifiers;
  };
  std::string name;
  std::vector<Point> points; // ascending in lines
  bool dashed = false;       // of others, for comparison
};

/*!
  Identifiers against the lines of a lamp, the count on a logarithmic axis; points without identifiers are
  left out. \param lamps Lines of the smallest and the largest lamp that a rig will see, shaded; empty: none.
*/
VISP_EXPORT vpFigure vpCapacityFigure(const std::vector<vpCapacityCurve> &curves,
                                      const std::vector<double> &lamps);

END_VISP_NAMESPACE

#endif
