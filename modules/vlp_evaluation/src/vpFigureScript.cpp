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

std::string colour(const char *name)
{
  return std::string(" lc rgb '") + name + "'";
}

std::string points(const std::string &data, size_t count, const char *colourName, const std::string &text,
                   bool joined)
{
  const std::string dots = " pt 7 ps ";
  const std::string size = count < 100 ? "0.8" : (count <= 300 ? "0.5" : "0.35");
  return data + (joined ? " with linespoints lw 1" : " with points") + dots + size + colour(colourName) +
         " notitle, keyentry with points" + dots + "0.9" + colour(colourName) + title(text);
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
