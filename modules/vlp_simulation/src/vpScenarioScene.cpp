/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <Eigen/Geometry>
#include <visp3/vlp_core/vpNumberText.h>

#include "vpScenarioYaml.h"

BEGIN_VISP_NAMESPACE

namespace
{
using vpScenarioYaml::degree;
using Range = vpYamlNode::Range;

double halfPowerOf(const vpYamlNode &node, double otherwise)
{
  const double angle = node.number("half_power_deg", Range::positive, otherwise / degree);
  static const double narrowest = 1; // degree
  if (angle < narrowest || angle >= 90) {
    node.fail("half_power_deg",
              vpNumberText(angle) + ", expected a number from " + vpNumberText(narrowest) + " to below 90");
  }
  return angle * degree;
}

double shareOf(const vpYamlNode &node, const std::string &key, double otherwise)
{
  const double share = node.number(key, Range::notNegative, otherwise);
  if (share > 1) {
    node.fail(key, vpNumberText(share) + ", expected a number from 0 to 1");
  }
  return share;
}

//! A grey value.
double levelOf(const vpYamlNode &node, const std::string &key, double otherwise)
{
  return vpScenarioYaml::between(node, key, 0, vpScenarioYaml::brightest, otherwise);
}

//! Lists of {from_s, until_s}.
std::vector<std::pair<double, double>> readTimes(const vpYamlNode &node, const std::string &key)
{
  std::vector<std::pair<double, double>> times;
  if (!node.has(key)) {
    return times;
  }
  for (const vpYamlNode &entry : node.mappings(key)) {
    const double from = entry.number("from_s");
    const double until = entry.number("until_s", Range::any, 1e9); // left out: for good
    if (!(until > from)) {
      entry.fail("until_s", vpNumberText(until) + ", expected more than from_s, " + vpNumberText(from));
    }
    entry.finish();
    times.emplace_back(from, until);
  }
  return times;
}

//! How all lamps shine, where nothing else is said of one.
vpSimulatedLamp readLight(const vpYamlNode &top, vpSimulatedScene &scene)
{
  vpSimulatedLamp common;
  if (!top.has("light")) {
    return common;
  }
  const vpYamlNode node = top.mapping("light");
  common.level = levelOf(node, "lamp_level", common.level);
  common.rim = shareOf(node, "rim", common.rim);
  common.emission = vpScenarioYaml::readEmission(node, common.emission);
  common.halfPower = halfPowerOf(node, common.halfPower);
  scene.ambient = levelOf(node, "ambient", scene.ambient);
  if (node.has("ceiling")) {
    const vpYamlNode ceiling = node.mapping("ceiling");
    scene.ceilingShare = ceiling.number("share", Range::openUnit);
    scene.ceilingRadius = ceiling.number("radius_m", Range::positive);
    ceiling.finish();
  }
  node.finish();
  return common;
}

void readLamp(const vpYamlNode &node, std::vector<vpScenario::Lamp> &lamps)
{
  const std::string id = node.text("id");
  const auto found = std::find_if(lamps.begin(), lamps.end(), [&id](const vpScenario::Lamp &lamp) {
    return lamp.simulated.lamp.id == id;
  });
  if (found == lamps.end()) {
    node.fail("id", vpShown(id) + ", expected a lamp of the map or of more_lamps");
  }
  if (node.has("shift_m")) {
    const std::vector<double> shift = node.numbers("shift_m", 3);
    found->shift = Eigen::Vector3d(shift[0], shift[1], shift[2]);
  }
  vpSimulatedLamp &lamp = found->simulated;
  static const double mostPpm = 1e5; // with what is drawn on top, it still runs forwards
  found->clockPpm = vpScenarioYaml::between(node, "clock_ppm", -mostPpm, mostPpm, 0);
  found->dark = readTimes(node, "dark");
  lamp.level = levelOf(node, "level", lamp.level);
  lamp.rim = shareOf(node, "rim", lamp.rim);
  lamp.emission = vpScenarioYaml::readEmission(node, lamp.emission);
  lamp.halfPower = halfPowerOf(node, lamp.halfPower);
  node.finish();
}

void readLamps(const std::optional<vpYamlNode> &truth, const vpSimulatedLamp &common, vpScenario &scenario)
{
  auto add = [&](const vpLamp &lamp) {
    scenario.lamps.emplace_back();
    scenario.lamps.back().simulated = common;
    scenario.lamps.back().simulated.lamp = lamp;
  };
  for (const vpLamp &lamp : scenario.map.lamps) {
    add(lamp);
  }
  if (!truth) {
    return;
  }
  if (truth->has("more_lamps")) {
    for (const vpYamlNode &node : truth->mappings("more_lamps")) {
      const vpEmission emission = vpScenarioYaml::readEmission(node, common.emission);
      const vpLamp lamp = vpLamp::read(node);
      for (const vpScenario::Lamp &other : scenario.lamps) {
        if (other.simulated.lamp.id == lamp.id) {
          node.fail("id", vpShown(lamp.id) + " a second time, expected an id of its own");
        }
      }
      add(lamp);
      scenario.lamps.back().simulated.emission = emission;
    }
  }
  if (truth->has("lamps")) {
    std::set<std::string> read;
    for (const vpYamlNode &node : truth->mappings("lamps")) {
      if (!read.insert(node.text("id")).second) { // its first entry would be lost
        node.fail("id", vpShown(node.text("id")) + " a second time, expected each lamp once");
      }
      readLamp(node, scenario.lamps);
    }
  }
}

Eigen::Vector3d vectorOf(const vpYamlNode &node, const std::string &key)
{
  const std::vector<double> values = node.numbers(key, 3);
  vpScenarioYaml::expectNear(node, key, values);
  return {values[0], values[1], values[2]};
}

vpSimulatedWindow readWindow(const vpYamlNode &node)
{
  vpSimulatedWindow window;
  window.centre = vectorOf(node, "centre_m");
  window.halfWidth = vectorOf(node, "half_width_m");
  window.halfHeight = vectorOf(node, "half_height_m");
  window.level = levelOf(node, "level", window.level);
  const double width = window.halfWidth.norm(), height = window.halfHeight.norm();
  static const double skew = 1e-6;
  if (!(width > 0 && height > 0) ||
      std::abs(window.halfWidth.dot(window.halfHeight)) > skew * width * height) {
    node.fail("half_height_m", "with half_width_m, expected two vectors longer than 0 and at right angles");
  }
  for (const auto &[from, until] : readTimes(node, "shut")) {
    window.light.addDark(from, until);
  }
  node.finish();
  return window;
}

vpSimulatedPerson readPerson(const vpYamlNode &node)
{
  vpSimulatedPerson person;
  person.radius = node.number("radius_m", Range::positive, person.radius);
  person.height = node.number("height_m", Range::positive, person.height);
  person.level = levelOf(node, "level", person.level);
  for (const vpYamlNode &entry : node.mappings("path")) {
    const std::vector<double> place = entry.numbers("at_m", 2);
    const double time = entry.number("time_s");
    if (!person.path.empty() && time < person.path.back().time) {
      entry.fail("time_s", vpNumberText(time) + ", expected no less than " +
                               vpNumberText(person.path.back().time) + " of the step before");
    }
    entry.finish();
    person.path.push_back({time, Eigen::Vector2d(place[0], place[1])});
  }
  if (person.path.empty()) {
    node.fail("path", "an empty list, expected one step or more");
  }
  node.finish();
  return person;
}
} // namespace

void vpScenarioYaml::readScene(const vpYamlNode &top, const std::optional<vpYamlNode> &truth,
                               vpScenario &scenario)
{
  const vpSimulatedLamp common = readLight(top, scenario.scene);
  readLamps(truth, common, scenario);
  if (truth) {
    if (truth->has("second_images")) {
      for (const vpYamlNode &node : truth->mappings("second_images")) {
        scenario.secondImages.push_back(readSecondImage(node, scenario.lamps));
      }
    }
    truth->finish();
  }
  if (top.has("windows")) {
    for (const vpYamlNode &node : top.mappings("windows")) {
      scenario.scene.windows.push_back(readWindow(node));
    }
  }
  if (top.has("people")) {
    for (const vpYamlNode &node : top.mappings("people")) {
      scenario.scene.people.push_back(readPerson(node));
    }
  }
}

END_VISP_NAMESPACE
