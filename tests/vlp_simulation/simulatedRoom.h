/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef simulatedRoom_h
#define simulatedRoom_h

/*!
  \file simulatedRoom.h
  A small room for the tests of scenarios: two lamps, a camera of 96 x 72 pixels, quickly drawn.
*/

#include <string>

#include <visp3/vlp_simulation/vpScenario.h>

#include "common/vpTemporaryFolder.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace simulatedRoom
{
// A good scenario, part by part; the first is two lines, the others one each.
const std::string head = "rig: rig.yaml\nlamps: lamps.yaml\n";
const std::string frames = "frames: {rate_hz: 12}\n";
const std::string still = "motion: {type: stations, points: [{at_m: [0, 0]}], frames_each: 3}\n";

//! With the rig and the lamps that a scenario there names.
class Folder : public vpTemporaryFolder
{
public:
  Folder()
  {
    write("camera.xml",
          "<?xml version=\"1.0\"?>\n<root><camera><name>small</name><image_width>96</image_width>"
          "<image_height>72</image_height><model><type>perspectiveProjWithoutDistortion</type><px>80</"
          "px><py>80</py>"
          "<u0>47</u0><v0>36</v0></model></camera></root>\n");
    write("rig.yaml",
          "camera: {file: camera.xml, name: small}\n"
          "shutter: {row_time_s: 50e-6, row_time_sigma_s: 2e-9, exposure_s: 50e-6, readout: rows}\n"
          "mount: {translation_m: [0.02, 0, 0.19], rotation_rpy_deg: [0, 0, 90]}\n");
    write("lamps.yaml",
          "lamps:\n"
          "  - {id: A, position_m: [-0.3, -0.2, 1.5], diameter_m: 0.3, frequency_hz: 1000, duty: 0.5}\n"
          "  - {id: B, position_m: [0.3, 0.2, 1.5], diameter_m: 0.3, frequency_hz: 1600, duty: 0.4}\n");
  }

  vpScenario load(const std::string &text) const { return vpScenario::load(write("scenario.yaml", text)); }
};
} // namespace simulatedRoom

#endif
