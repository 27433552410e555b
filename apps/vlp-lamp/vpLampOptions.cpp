/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLampOptions.h"

#include <CLI/CLI.hpp>

#include "common/vpCommandLine.h"
#include "common/vpProgram.h"

BEGIN_VISP_NAMESPACE

namespace
{
const char *const description = "Tells lamps with the firmware of apps/lamp-firmware how to blink.\n";

const char *const footer = R"(
Examples:
  vlp-lamp --list-ports
  vlp-lamp --port /dev/ttyUSB0 --map lamps.yaml --lamp L3
  vlp-lamp --port /dev/ttyUSB0 --map lamps.yaml --all
  vlp-lamp --port /dev/ttyUSB0 --show

A lamp keeps what it was told, without power too. It answers with what it really sends: whole cycles of its
clock. Each lamp that was told is a row on stdout: its id, and that answer. Where the clock makes another
frequency than the map's, by more than the map's oscillator_ppm, a line on stderr says so.

Exit code: 0 done; 2 bad usage or bad input, no lamp at the port, or one that sends something else than it was
told; 3 no port.
)";
} // namespace

bool vpLampOptions::parse(int argc, char **argv)
{
  CLI::App app(description, "vlp-lamp");
  app.footer(footer);
  app.get_formatter()->column_width(28);
  vpAddName(app, "--port", port, "DEVICE", "serial port of the lamp, as /dev/ttyUSB0");
  vpAddInput(app, "--map", map, "FILE", "the lamp map");
  vpAddName(app, "--lamp", lamp, "ID", "the lamp of the map that this one is to be");
  app.add_flag("--all", all, "all lamps of the map: asks for one after the other");
  app.add_flag("--show", show, "print what the lamp sends, and change nothing");
  app.add_flag("--list-ports", listPorts, "print the serial ports, and what is plugged in there");
  if (!vpParseCommandLine(app, argc, argv)) {
    return false;
  }
  if (static_cast<int>(all) + static_cast<int>(show) + static_cast<int>(listPorts) +
          static_cast<int>(!lamp.empty()) !=
      1) {
    vpBadInput("--lamp: expected just one of --lamp, --all, --show and --list-ports (--help explains them)");
  }
  if (!listPorts && port.empty()) {
    vpBadInput("--port: nothing, expected the lamp's serial port; --list-ports prints those there are");
  }
  if ((all || !lamp.empty()) && map.empty()) {
    vpBadInput("--map: nothing, expected the file of a lamp map");
  }
  return true;
}

END_VISP_NAMESPACE
