/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpOpenTurtleBot3_h
#define vpOpenTurtleBot3_h

#include <memory>
#include <string>
#include <vector>

#include <visp3/vlp_robot/vpRobotTurtleBot3.h>

BEGIN_VISP_NAMESPACE

/*!
  The TurtleBot3 that \e uri names:
  - `opencr:usb`: the only board that is attached, over libusb;
  - `opencr:usb:SERIAL`: the one of that serial number;
  - `opencr:/dev/ttyACM0`: on a serial device.
  \throw vpException (badValue) for other texts; (ioError) as vpRobotTurtleBot3, vpUsbTransport and
  vpSerialTransport say.
*/
VISP_EXPORT std::unique_ptr<vpRobotTurtleBot3>
vpOpenTurtleBot3(const std::string &uri,
                 const vpRobotTurtleBot3Settings &settings = vpRobotTurtleBot3Settings());

//! The line alone. \throw vpException as vpOpenTurtleBot3().
VISP_EXPORT std::unique_ptr<vpByteTransport> vpOpenCrTransport(const std::string &uri);

//! A board that vpOpenTurtleBot3() may find.
struct VISP_EXPORT vpAttachedBoard {
  std::string uri;
  std::string remark; // where it is, and why it could not be asked
};

/*!
  The USB devices that may be OpenCR boards (VID:PID 0483:5740, which other boards with an STM32 share).
  \throw vpException (ioError) where the system has no USB, or this build no libusb.
*/
VISP_EXPORT std::vector<vpAttachedBoard> vpAttachedBoards();

END_VISP_NAMESPACE

#endif
