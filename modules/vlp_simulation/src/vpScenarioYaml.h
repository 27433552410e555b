/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpScenarioYaml_h
#define vpScenarioYaml_h

#include <optional>

#include <visp3/vlp_core/vpYamlNode.h>
#include <visp3/vlp_simulation/vpScenario.h>

BEGIN_VISP_NAMESPACE

//! Parts of a scenario file. Each finishes the node that it reads.
namespace vpScenarioYaml
{

//! `motion` and, of a driven robot, `robot`. \e frameRate: Hz, for stations held for a number of frames.
vpScenario::Motion readMotion(const vpYamlNode &top, double frameRate);

//! `light`, `windows`, `people`, and the `lamps` and `more_lamps` of \e truth, which it finishes.
void readScene(const vpYamlNode &top, const std::optional<vpYamlNode> &truth, vpScenario &scenario);

} // namespace vpScenarioYaml

END_VISP_NAMESPACE

#endif
