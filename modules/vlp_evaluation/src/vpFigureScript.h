/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpFigureScript_h
#define vpFigureScript_h

#include <string>
#include <vector>

#include <visp3/vlp_core/vpVlpNamespace.h>

/*!
  \file vpFigureScript.h
  The pieces that gnuplot scripts of figures are made of.
*/

BEGIN_VISP_NAMESPACE

namespace vpFigureScript
{
constexpr const char *blue = "#2563a8", *pale = "#7fb2e5", *red = "#c0392b", *green = "#23895b",
                     *orange = "#d9730d", *grey = "#8a8f98", *dark = "#2b2f36";

//! The unit in which lengths up to some magnitude (m) are read best.
struct Unit {
  const char *name;
  double perMetre;

  static Unit ofErrors(double largest)
  {
    return largest < 0.1 ? Unit{"mm", 1000} : (largest < 1 ? Unit{"cm", 100} : Unit{"m", 1});
  }
  static Unit ofMap(double extent) { return extent < 5 ? Unit{"cm", 100} : Unit{"m", 1}; }
};

//! A length (m) with its unit, to three digits.
std::string length(double metres, const Unit &unit);

//! A line of data.
std::string row(const std::vector<double> &values);

//! Data that plots name as `$name`.
std::string block(const std::string &name, const std::string &rows);

std::string axisLabel(const char *axis, const std::string &text);
std::string range(const char *axis, double low, double high);

//! Parts of a plot: its entry in the legend, its colour.
std::string title(const std::string &text);
std::string colour(const char *name);

//! A plot of \e count points, small where they are many, yet with a large one in the legend.
std::string points(const std::string &data, size_t count, const char *colourName, const std::string &text,
                   bool joined = false);

//! The plots as one command.
std::string joined(const std::vector<std::string> &plots);
} // namespace vpFigureScript

END_VISP_NAMESPACE

#endif
