/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpEmulatedUsbBoard_h
#define vpEmulatedUsbBoard_h

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "opencr/vpRealTimeBoard.h"

/*!
  A board as a USB device under umockdev: what the kernel's usbfs would answer, as far as libusb asks for it.
  The program has to run under umockdev-wrapper.
*/
class vpEmulatedUsbBoard
{
public:
  //! Who has an interface.
  enum class Owner { nobody, kernel, program };

  //! The device's state on the host's side of the cable.
  struct State {
    std::array<Owner, 2> owner = {Owner::kernel,
                                  Owner::kernel}; // of the interfaces, the kernel's driver: cdc_acm
    std::array<std::uint8_t, 7> lineCoding{};
    bool dtr = false, rts = false;
    int rtsRaised = 0;      // times
    int claims = 0;         // of interfaces
    bool stalled = false;   // takes nothing and sends nothing
    bool unplugged = false; // since the last plug()
  };

  //! Not plugged in. \e serial: its serial number, empty for none.
  vpEmulatedUsbBoard(vpRealTimeBoard &board, const std::string &serial);
  ~vpEmulatedUsbBoard();

  //! As device \e number of bus 1.
  void plug(int number);
  void unplug();

  State state() const;
  void setState(const State &state);

private:
  class Impl;
  std::unique_ptr<Impl> m_impl;
};

#endif
