/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLampPlaces.h"

#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpCsvTable.h>
#include <visp3/vlp_core/vpNumberText.h>

BEGIN_VISP_NAMESPACE

namespace
{
vpLampMap csvPlaces(const std::string &filename)
{
  const vpCsvTable table = vpCsvTable::load(filename, {"id", "x_m", "y_m", "z_m"});
  vpLampMap map;
  std::set<std::string> ids;
  for (size_t row = 0; row < table.rows(); ++row) {
    vpLamp lamp;
    lamp.id = table.text(row, 0);
    if (!ids.insert(lamp.id).second || lamp.id.empty()) {
      table.fail(row, 0, "expected an id of its own");
    }
    lamp.position = {table.number(row, 1), table.number(row, 2), table.number(row, 3)};
    map.lamps.push_back(lamp);
  }
  if (map.lamps.empty()) {
    throw vpException(vpException::badValue, filename + ": no rows, expected one lamp or more");
  }
  return map;
}
} // namespace

vpLampPlaces vpLampPlaces::load(const std::string &filename, double diameter)
{
  const bool csv = std::filesystem::path(filename).extension() == ".csv";
  vpLampPlaces places;
  places.map = csv ? csvPlaces(filename) : vpLampMap::load(filename);
  std::map<std::array<double, 3>, std::string> taken;
  for (vpLamp &lamp : places.map.lamps) {
    const auto &[other, own] =
        taken.emplace(std::array{lamp.position.x(), lamp.position.y(), lamp.position.z()}, lamp.id);
    if (!own) {
      throw vpException(vpException::badValue, filename + ": lamp " + vpShown(lamp.id) +
                                                   ": position_m: where lamp " + vpShown(other->second) +
                                                   " hangs, expected a place of its own");
    }
    lamp.size = std::isnan(lamp.size) ? diameter : lamp.size;
    if (std::isnan(lamp.size)) {
      throw vpException(vpException::badValue,
                        "--diameter: nothing, expected the diameter of the lamps (m): " + filename +
                            " has none for lamp " + vpShown(lamp.id));
    }
  }
  return places;
}

vpLampPlaces vpLampPlaces::grid(size_t count, double diameter, double z)
{
  const auto columns = static_cast<size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  const size_t rows = columns == 0 ? 0 : (count + columns - 1) / columns;
  const size_t digits = std::to_string(count).size();
  vpLampPlaces places;
  places.comment = {"Placeholder positions: a grid a metre apart. Put each lamp where it hangs."};
  for (size_t i = 0; i < count; ++i) {
    vpLamp lamp;
    const std::string number = std::to_string(i + 1);
    lamp.id = "L" + std::string(digits - number.size(), '0') + number;
    lamp.position = {static_cast<double>(i % columns) - 0.5 * static_cast<double>(columns - 1),
                     static_cast<double>(i / columns) - 0.5 * static_cast<double>(rows - 1), z};
    lamp.size = diameter;
    places.map.lamps.push_back(lamp);
  }
  return places;
}

END_VISP_NAMESPACE
