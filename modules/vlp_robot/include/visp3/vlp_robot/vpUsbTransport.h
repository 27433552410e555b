/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpUsbTransport_h
#define vpUsbTransport_h

#include <memory>
#include <string>
#include <vector>

#include <visp3/vlp_robot/vpByteTransport.h>

BEGIN_VISP_NAMESPACE

//! An attached USB device that may be an OpenCR board. A ping shows whether it is one.
struct VISP_EXPORT vpUsbBoard {
  int bus = 0;
  int address = 0;
  std::string serial;  // empty where it has none, or where it could not be asked
  std::string problem; // why it could not be asked, else empty
};

/*!
  An OpenCR board on USB, without the kernel's driver: a CDC-ACM device of VID:PID 0483:5740. Takes both of
  its interfaces from the kernel's driver and gives them back when closed. After a process that was killed the
  driver stays detached until the next one that closes it, or until the cable was pulled.

  Sets 1 000 000 baud 8N1 (1200 would reset the board) and of the line state DTR only, before which the board
  sends nothing (RTS would arm its bootloader).

  Needs libusb-1.0 at build time. A build without it has the class, and each of its methods throws.
*/
class VISP_EXPORT vpUsbTransport : public vpByteTransport
{
public:
  static constexpr std::uint16_t vendor = 0x0483, product = 0x5740;

  /*!
    \param serial The device's serial number; empty: the only one that is attached.
    \throw vpException (ioError) where there is none, several, or where it cannot be used.
  */
  explicit vpUsbTransport(const std::string &serial = "");
  ~vpUsbTransport() override;

  //! \throw vpException (ioError) where the system has no USB.
  static std::vector<vpUsbBoard> boards();

  bool write(const std::uint8_t *bytes, size_t size, double deadline) override;
  size_t read(std::uint8_t *bytes, size_t most, double deadline) override;
  void discard() override;
  //! Opens the device of the same serial number, wherever it was plugged in meanwhile.
  void reopen() override;
  std::string name() const override;

private:
  class Impl;
  std::unique_ptr<Impl> m_impl;
};

END_VISP_NAMESPACE

#endif
