/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpEmulatedUsbBoard_h
#define vpEmulatedUsbBoard_h

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "opencr/vpRealTimeBoard.h"
#include "usb/vpEmulatedUsbDevice.h"

//! A board as a USB device.
class vpEmulatedUsbBoard : public vpEmulatedUsbDevice
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
    int rtsRaised = 0;    // times
    int claims = 0;       // of interfaces
    bool stalled = false; // takes nothing and sends nothing
  };

  //! Not plugged in. \e serial: its serial number, empty for none.
  vpEmulatedUsbBoard(vpRealTimeBoard &board, const std::string &serial);
  ~vpEmulatedUsbBoard() override;

  State state() const;
  void setState(const State &state);

private:
  void plugged() override;
  Result claim(unsigned int interface) override;
  Result disconnectAndClaim(unsigned int interface) override;
  Result release(unsigned int interface) override;
  Result connectDriver(unsigned int interface) override;
  bool control(const Setup &setup, std::vector<std::uint8_t> &data) override;
  bool mayTransfer() const override;
  bool receive(const std::vector<std::uint8_t> &data) override;
  std::vector<std::uint8_t> send(size_t room) override;

  vpRealTimeBoard &m_board;
  State m_state;
};

#endif
