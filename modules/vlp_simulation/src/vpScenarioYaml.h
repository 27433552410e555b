/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpScenarioYaml_h
#define vpScenarioYaml_h

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <visp3/vlp_core/vpYamlNode.h>
#include <visp3/vlp_simulation/vpScenario.h>

BEGIN_VISP_NAMESPACE

//! Parts of a scenario file. Each finishes the node that it reads.
namespace vpScenarioYaml
{
static constexpr double degree = M_PI / 180; // rad
static constexpr double farthest = 1e4;      // m, of any coordinate: no farther does the renderer see
static constexpr double brightest = 1e6;     // grey value of anything
static constexpr double longestRun = 21000;  // s; the simulated robot ends after 6 hours
static constexpr double mostFrames = 1e6;    // of a run

//! A number from \e least to \e most, \e otherwise where it is left out.
double between(const vpYamlNode &node, const std::string &key, double least, double most, double otherwise);

//! Refuses a coordinate (m) that no picture shows.
void expectNear(const vpYamlNode &node, const std::string &key, const std::vector<double> &coordinates);

//! `motion` and, of a driven robot, `robot`. \e frameRate: Hz, for stations held for a number of frames.
vpScenario::Motion readMotion(const vpYamlNode &top, double frameRate);

//! `emission` of a lamp or of all lamps, \e otherwise where it is left out.
vpEmission readEmission(const vpYamlNode &parent, const vpEmission &otherwise);

//! An entry of `second_images`.
vpScenario::SecondImage readSecondImage(const vpYamlNode &node, const std::vector<vpScenario::Lamp> &lamps);

//! `light`, `windows`, `people`, and the `lamps`, `more_lamps` and `second_images` of \e truth, which it
//! finishes.
void readScene(const vpYamlNode &top, const std::optional<vpYamlNode> &truth, vpScenario &scenario);

} // namespace vpScenarioYaml

END_VISP_NAMESPACE

#endif
