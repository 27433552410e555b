/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpFigureScript.h"

#include <array>
#include <cstdio>

#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_evaluation/vpGnuplot.h>

BEGIN_VISP_NAMESPACE

namespace vpFigureScript
{
std::string length(double metres, const Unit &unit)
{
  std::array<char, 64> buffer;
  std::snprintf(buffer.data(), buffer.size(), "%.3g %s", metres * unit.perMetre, unit.name);
  return buffer.data();
}

std::string row(const std::vector<double> &values)
{
  std::string text;
  for (const double value : values) {
    text += (text.empty() ? "" : " ") + vpNumberText(value);
  }
  return text + "\n";
}

std::string block(const std::string &name, const std::string &rows)
{
  return "$" + name + " << END\n" + rows + "END\n";
}

std::string axisLabel(const char *axis, const std::string &text)
{
  return std::string("set ") + axis + "label " + vpGnuplot::quoted(text) + "\n";
}

std::string range(const char *axis, double low, double high)
{
  return std::string("set ") + axis + "range [" + vpNumberText(low) + ":" + vpNumberText(high) + "]\n";
}

std::string title(const std::string &text)
{
  return " title " + vpGnuplot::quoted(text);
}

std::string dots(size_t count)
{
  return count < 100 ? " pt 7 ps 0.8" : " pt 7 ps 0.4";
}

std::string colour(const char *name)
{
  return std::string(" lc rgb '") + name + "'";
}

std::string joined(const std::vector<std::string> &plots)
{
  std::string text = "plot ";
  for (size_t i = 0; i < plots.size(); ++i) {
    text += (i == 0 ? "" : ", \\\n     ") + plots[i];
  }
  return text + "\n";
}
} // namespace vpFigureScript

END_VISP_NAMESPACE
