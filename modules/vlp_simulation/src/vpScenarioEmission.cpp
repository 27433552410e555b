/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <cmath>
#include <string>
#include <vector>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

#include "vpScenarioYaml.h"

BEGIN_VISP_NAMESPACE

namespace
{
using Range = vpYamlNode::Range;

vpEmission patternOf(const vpYamlNode &node)
{
  enum Type { even, hotSpot, ringOfDies, gridOfDies, dome, edgeLit, cracked, tube };
  const auto number = [&node](const char *key) { return node.number(key, Range::any); };
  switch (node.choice(
      "type", {"even", "hot_spot", "ring_of_dies", "grid_of_dies", "dome", "edge_lit", "cracked", "tube"})) {
  case hotSpot: {
    const std::vector<double> place = node.numbers("place", 2);
    return vpEmission::hotSpot({place[0], place[1]}, number("width"), number("rest"));
  }
  case ringOfDies:
    return vpEmission::ringOfDies(node.wholeNumber("dies"), number("radius"), number("width"),
                                  number("rest"));
  case gridOfDies:
    return vpEmission::gridOfDies(node.wholeNumber("across"), number("width"), number("rest"));
  case dome:
    return vpEmission::dome(number("rim"), number("power"));
  case edgeLit:
    return vpEmission::edgeLit(number("depth"), number("rest"), number("other"));
  case cracked:
    return vpEmission::cracked(node.wholeNumber("patches"), number("spread"), node.wholeNumber("seed"));
  case tube:
    return vpEmission::tube(number("width"));
  default:
    return {};
  }
}
} // namespace

vpEmission vpScenarioYaml::readEmission(const vpYamlNode &parent, const vpEmission &otherwise)
{
  if (!parent.has("emission")) {
    return otherwise;
  }
  const vpYamlNode node = parent.mapping("emission");
  vpEmission emission;
  try {
    emission = patternOf(node);
  } catch (const vpException &error) {
    // vpEmission knows the ranges and begins with the number's name; the file and the line are this one's.
    const std::string &message = error.getStringMessage();
    const size_t colon = message.find(": ");
    const std::string key = message.substr(0, colon);
    if (key.find_first_of(":/.") != std::string::npos || !node.has(key)) {
      throw;
    }
    node.fail(key, message.substr(colon + 2));
  }
  node.finish();
  if (!emission.even() && parent.has("rim")) {
    parent.fail("rim", "beside an emission that is not even, expected one of them");
  }
  return emission;
}

vpScenario::SecondImage vpScenarioYaml::readSecondImage(const vpYamlNode &node,
                                                        const std::vector<vpScenario::Lamp> &lamps)
{
  vpScenario::SecondImage image;
  const std::string id = node.text("lamp");
  while (image.lamp < lamps.size() && lamps[image.lamp].simulated.lamp.id != id) {
    ++image.lamp;
  }
  if (image.lamp == lamps.size()) {
    node.fail("lamp", vpShown(id) + ", expected a lamp of the map or of more_lamps");
  }
  const std::vector<double> shift = node.numbers("shift_m", 3);
  expectNear(node, "shift_m", shift);
  image.shift = Eigen::Vector3d(shift[0], shift[1], shift[2]);
  node.number("share"); // has no default
  image.share = between(node, "share", 0, 1, 0);
  image.blur = between(node, "blur_px", 0, 100, 0);
  image.mirrored = node.has("mirrored") && node.boolean("mirrored");
  if (image.mirrored && !(image.shift.head<2>().norm() > 0)) {
    node.fail("shift_m", "of a mirrored image straight above or below its lamp, expected a shift in x or y");
  }
  node.finish();
  return image;
}

END_VISP_NAMESPACE
