/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpTellLamps.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <vector>

#include <spdlog/spdlog.h>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_core/vpPrintable.h>
#include <visp3/vlp_robot/vpSerialTransport.h>

#include "vpLampBoard.h"

BEGIN_VISP_NAMESPACE

namespace
{
vpLampBoard boardAt(const std::string &port)
{
  static const unsigned int baud = 38400; // the firmware's
  return vpLampBoard(std::make_unique<vpSerialTransport>(port, baud));
}

//! Serial ports of boards, and what the kernel knows of each.
vpExitCode listPorts()
{
  namespace fs = std::filesystem;
  std::vector<std::string> names;
  std::error_code none;
  for (const fs::directory_entry &entry : fs::directory_iterator("/sys/class/tty", none)) {
    const std::string name = entry.path().filename();
    if (name.rfind("ttyUSB", 0) == 0 || name.rfind("ttyACM", 0) == 0) {
      names.push_back(name);
    }
  }
  std::sort(names.begin(), names.end());
  for (const std::string &name : names) {
    std::string product;
    for (const char *up :
         {"../product", "../../product", "../../../product"}) { // of the USB device above the port
      std::ifstream file(fs::path("/sys/class/tty") / name / "device" / up);
      if (std::getline(file, product)) {
        break;
      }
    }
    std::cout << "/dev/" << name << (product.empty() ? "" : "  " + vpPrintable(product)) << "\n";
  }
  if (names.empty()) {
    spdlog::error("no serial port: is the lamp plugged in?");
    return vpExitCode::nothingFound;
  }
  return vpExitCode::done;
}

//! Says where a clock makes another rate of it than the map's by more than its oscillator is off.
void warnOfRounding(const vpLamp &lamp, const std::string &sent)
{
  const bool word = lamp.modulation.kind == vpModulation::Kind::word;
  const double wanted = word ? lamp.modulation.chipRate : lamp.modulation.frequency,
               rate = vpLampBoard::valueOf(sent, word ? "chip_rate_hz" : "frequency_hz"),
               ppm = 1e6 * std::abs(rate - wanted) / wanted;
  if (ppm > lamp.oscillatorPpm) {
    spdlog::warn("lamp {}: sends {} Hz, the map has {}: {:.0f} ppm apart, oscillator_ppm {}: expected the "
                 "rate that is "
                 "sent in the map",
                 vpShown(lamp.id), vpNumberText(rate), vpNumberText(wanted), ppm,
                 vpNumberText(lamp.oscillatorPpm));
  }
}

void tell(const std::string &port, const vpLamp &lamp)
{
  const std::string sent = boardAt(port).set(lamp);
  std::cout << vpPrintable(lamp.id) << "  " << vpPrintable(sent) << std::endl;
  warnOfRounding(lamp, sent);
}

const vpLamp &lampOf(const vpLampMap &map, const vpLampOptions &options)
{
  if (const vpLamp *lamp = map.find(options.lamp)) {
    return *lamp;
  }
  throw vpException(vpException::badValue,
                    "--lamp: " + vpShown(options.lamp) + ", expected a lamp of " + options.map);
}

//! One lamp after the other, each when it is plugged in; once more where that did not work.
void tellAll(const vpLampMap &map, const vpLampOptions &options)
{
  for (size_t told = 0; told < map.lamps.size();) {
    const vpLamp &lamp = map.lamps[told];
    std::cerr << "plug in " << vpPrintable(lamp.id) << " (" << told + 1 << " of " << map.lamps.size()
              << "), press Enter" << std::endl;
    std::string line;
    if (!std::getline(std::cin, line)) {
      throw vpException(vpException::ioError, "input: ended, " + std::to_string(map.lamps.size() - told) +
                                                  " lamps are left, expected Enter for each");
    }
    try {
      tell(options.port, lamp);
      ++told;
    } catch (const vpException &problem) {
      spdlog::error(problem.getStringMessage());
    }
  }
}
} // namespace

vpExitCode vpTellLamps(const vpLampOptions &options)
{
  if (options.listPorts) {
    return listPorts();
  }
  if (options.show) {
    std::cout << vpPrintable(boardAt(options.port).show()) << "\n";
    return vpExitCode::done;
  }
  const vpLampMap map = vpLampMap::load(options.map);
  if (options.all) {
    for (const vpLamp &lamp : map.lamps) {
      vpLampBoard::lineOf(lamp); // nothing is told where the map does not say all
    }
    tellAll(map, options);
  } else {
    tell(options.port, lampOf(map, options));
  }
  return vpExitCode::done;
}

END_VISP_NAMESPACE
