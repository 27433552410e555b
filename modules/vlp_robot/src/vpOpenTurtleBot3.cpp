/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_robot/vpOpenTurtleBot3.h>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_robot/vpSerialTransport.h>
#include <visp3/vlp_robot/vpUsbTransport.h>

BEGIN_VISP_NAMESPACE

namespace
{
const std::string scheme = "opencr:", usb = "opencr:usb";

bool beginsWith(const std::string &text, const std::string &beginning)
{
  return text.compare(0, beginning.size(), beginning) == 0;
}
} // namespace

std::unique_ptr<vpByteTransport> vpOpenCrTransport(const std::string &uri)
{
  if (uri == usb) {
    return std::make_unique<vpUsbTransport>();
  }
  if (beginsWith(uri, usb + ":") && uri.size() > usb.size() + 1) {
    return std::make_unique<vpUsbTransport>(uri.substr(usb.size() + 1));
  }
  if (beginsWith(uri, scheme + "/")) {
    return std::make_unique<vpSerialTransport>(uri.substr(scheme.size()));
  }
  throw vpException(vpException::badValue,
                    "robot: " + vpShown(uri) +
                        ", expected opencr:usb, opencr:usb:SERIAL or a serial device as opencr:/dev/ttyACM0");
}

std::unique_ptr<vpRobotTurtleBot3> vpOpenTurtleBot3(const std::string &uri,
                                                    const vpRobotTurtleBot3Settings &settings)
{
  settings.check(); // before anything is opened
  return std::make_unique<vpRobotTurtleBot3>(vpOpenCrTransport(uri), settings);
}

std::vector<vpAttachedBoard> vpAttachedBoards()
{
  std::vector<vpAttachedBoard> boards;
  for (const vpUsbBoard &board : vpUsbTransport::boards()) {
    const std::string place =
        "USB bus " + std::to_string(board.bus) + " device " + std::to_string(board.address);
    boards.push_back({board.serial.empty() ? usb : usb + ":" + board.serial,
                      place + (board.problem.empty() ? "" : ": " + board.problem)});
  }
  return boards;
}

END_VISP_NAMESPACE
