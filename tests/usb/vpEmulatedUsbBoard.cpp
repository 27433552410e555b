/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "usb/vpEmulatedUsbBoard.h"

#include <algorithm>
#include <cerrno>

namespace
{
constexpr size_t packetSize = 64;

// CDC-ACM of VID:PID 0483:5740: device, configuration, control interface with its interrupt endpoint 0x82,
// data interface with bulk endpoints 0x01 and 0x81.
std::string descriptors(const std::string &serial)
{
  return "12010002020000408304405700020102" + std::string(serial.empty() ? "00" : "03") + "01" +
         "090243000201 00C032"
         "0904000001020201 00"
         "0524001001 0524010001 04240202 0524060001"
         "07058203080010"
         "09040100020A000000"
         "07050102400000 07058102400000";
}
} // namespace

vpEmulatedUsbBoard::vpEmulatedUsbBoard(vpRealTimeBoard &board, const std::string &serial)
    : vpEmulatedUsbDevice(descriptors(serial), serial, 12), m_board(board)
{
}

vpEmulatedUsbBoard::~vpEmulatedUsbBoard()
{
  unplug();
}

void vpEmulatedUsbBoard::plugged()
{
  m_state = State();
}

vpEmulatedUsbBoard::Result vpEmulatedUsbBoard::claim(unsigned int interface)
{
  return m_state.owner[interface & 1] == Owner::nobody ? disconnectAndClaim(interface) : Result{-1, EBUSY};
}

//! cdc_acm has both interfaces or none: without the one it lets go of the other.
vpEmulatedUsbBoard::Result vpEmulatedUsbBoard::disconnectAndClaim(unsigned int interface)
{
  if (interface > 1) {
    return {-1, EINVAL};
  }
  if (m_state.owner[interface] == Owner::program) {
    return {-1, EBUSY};
  }
  if (m_state.owner[interface] == Owner::kernel) {
    m_state.owner = {Owner::nobody, Owner::nobody};
  }
  m_state.owner[interface] = Owner::program;
  ++m_state.claims;
  return {0, 0};
}

vpEmulatedUsbBoard::Result vpEmulatedUsbBoard::release(unsigned int interface)
{
  if (interface > 1 || m_state.owner[interface] != Owner::program) {
    return {-1, EINVAL};
  }
  m_state.owner[interface] = Owner::nobody;
  return {0, 0};
}

//! cdc_acm takes the control interface, and the other with it.
vpEmulatedUsbBoard::Result vpEmulatedUsbBoard::connectDriver(unsigned int interface)
{
  if (interface > 1) {
    return {-1, EINVAL};
  }
  if (m_state.owner[interface] != Owner::nobody) {
    return {-1, EBUSY};
  }
  if (interface == 1 || m_state.owner[1] != Owner::nobody) {
    return {0, 0}; // no driver took it
  }
  m_state.owner = {Owner::kernel, Owner::kernel};
  return {1, 0};
}

bool vpEmulatedUsbBoard::control(const Setup &setup, std::vector<std::uint8_t> &data)
{
  if (setup.type == 0x21 && setup.request == 0x20 && data.size() == m_state.lineCoding.size()) {
    std::copy(data.begin(), data.end(), m_state.lineCoding.begin());
    return true;
  }
  if (setup.type == 0x21 && setup.request == 0x22) {
    m_state.dtr = (setup.value & 1) != 0;
    m_state.rts = (setup.value & 2) != 0;
    m_state.rtsRaised += m_state.rts;
    return true;
  }
  return false;
}

bool vpEmulatedUsbBoard::mayTransfer() const
{
  return m_state.owner[1] == Owner::program;
}

bool vpEmulatedUsbBoard::receive(const std::vector<std::uint8_t> &data)
{
  if (m_state.stalled) {
    return false;
  }
  m_board.receive(data);
  return true;
}

//! Nothing leaves the board without DTR.
std::vector<std::uint8_t> vpEmulatedUsbBoard::send(size_t room)
{
  return m_state.dtr && !m_state.stalled ? m_board.send(std::min(packetSize, room))
                                         : std::vector<std::uint8_t>();
}

vpEmulatedUsbBoard::State vpEmulatedUsbBoard::state() const
{
  const std::lock_guard<std::mutex> lock(m_mutex);
  return m_state;
}

void vpEmulatedUsbBoard::setState(const State &state)
{
  const std::lock_guard<std::mutex> lock(m_mutex);
  m_state = state;
}
