/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "usb/vpEmulatedUvcCamera.h"

#include <algorithm>
#include <cerrno>
#include <cmath>

namespace
{
using Clock = std::chrono::steady_clock;

constexpr unsigned int payloadSize = 1024, headerSize = 2;
constexpr std::uint8_t endOfHeader = 0x80, endOfFrame = 0x02, frameId = 0x01; // of a payload's header
constexpr unsigned int pictureSize = vpEmulatedUvcCamera::width * vpEmulatedUvcCamera::height;
constexpr unsigned int interval = 200000; // 100 ns: 50 Hz

// Requests and units of the class.
constexpr unsigned int setCurrent = 0x01, getCurrent = 0x81, getMinimum = 0x82, getMaximum = 0x83,
                       toInterface = 0x21, fromInterface = 0xA1;
constexpr unsigned int probe = 0x0100, commit = 0x0200, streaming = 1;          // value, index
constexpr unsigned int aeMode = 0x0200, aePriority = 0x0300, exposure = 0x0400; // of the camera terminal
constexpr unsigned int gain = 0x0400;                                           // of the processing unit
constexpr unsigned int terminal = 0x0100, processing = 0x0200;                  // index

/*
 * Device 1bcf:2b8a of class "miscellaneous"; configuration with a video control interface (header, camera
 * terminal 1 that knows AE mode, AE priority and exposure, processing unit 2 that knows gain, output terminal
 * 3) and a video streaming interface (input header, format of GUID Y800, one frame size, bulk endpoint 0x81).
 */
std::string descriptors(const std::string &serial)
{
  return "1201 0002 EF0201 40 CF1B 8A2B 0001 00 00" + std::string(serial.empty() ? "00" : "03") +
         "01"
         "0902 A400 02 01 00 80 FA"
         "080B 00 02 0E 03 00 00"
         "0904 00 00 00 0E 01 00 00"
         "0D24 01 0001 3300 00127A00 01 01"
         "1224 02 01 0102 00 00 0000 0000 0000 03 0E0000"
         "0B24 05 02 01 0000 02 0002 00"
         "0924 03 03 0101 00 02 00"
         "0904 01 00 01 0E 02 00 00"
         "0E24 01 01 4700 81 00 03 00 00 00 01 00"
         "1B24 04 01 01 5938303000001000800000AA00389B71 08 01 00 00 00 00"
         "1E24 05 01 00 4000 3000 00C01200 00C01200 000C0000 400D0300 01 400D0300"
         "0705 81 02 0002 00";
}

void put(std::vector<std::uint8_t> &data, size_t at, unsigned int value, size_t size)
{
  for (size_t i = 0; i < size && at + i < data.size(); ++i) {
    data[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
  }
}

unsigned int number(const std::vector<std::uint8_t> &data)
{
  unsigned int value = 0;
  for (size_t i = 0; i < std::min<size_t>(4, data.size()); ++i) {
    value |= static_cast<unsigned int>(data[i]) << (8 * i);
  }
  return value;
}

//! A control of so many bytes: what it is, at least and at most.
bool adjust(unsigned int request, std::vector<std::uint8_t> &data, unsigned int &now, unsigned int least,
            unsigned int most)
{
  if (request == setCurrent) {
    const unsigned int asked = number(data);
    if (asked < least || asked > most) {
      return false;
    }
    now = asked;
    return true;
  }
  put(data, 0, request == getMinimum ? least : request == getMaximum ? most : now, data.size());
  return true;
}
} // namespace

vpEmulatedUvcCamera::vpEmulatedUvcCamera(const std::string &serial)
    : vpEmulatedUsbDevice(descriptors(serial), serial, 480)
{
}

vpEmulatedUvcCamera::~vpEmulatedUvcCamera()
{
  unplug();
}

void vpEmulatedUvcCamera::plugged()
{
  m_state = State();
  m_owned = {};
  m_picture.clear();
  m_number = 0;
}

vpEmulatedUvcCamera::Result vpEmulatedUvcCamera::claim(unsigned int interface)
{
  if (interface >= m_owned.size() || m_owned[interface]) {
    return {-1, interface < m_owned.size() ? EBUSY : EINVAL};
  }
  m_owned[interface] = true;
  m_state.claimed = m_owned[streaming];
  return {0, 0};
}

vpEmulatedUvcCamera::Result vpEmulatedUvcCamera::release(unsigned int interface)
{
  if (interface >= m_owned.size() || !m_owned[interface]) {
    return {-1, EINVAL};
  }
  m_owned[interface] = false;
  m_state.claimed = m_owned[streaming];
  return {0, 0};
}

bool vpEmulatedUvcCamera::control(const Setup &setup, std::vector<std::uint8_t> &data)
{
  if (setup.type != toInterface && setup.type != fromInterface) {
    return false;
  }
  if (setup.index == streaming && (setup.value == probe || setup.value == commit)) {
    if (setup.request == setCurrent) {
      m_state.commits += setup.value == commit;
      m_due = Clock::now();
      return true;
    }
    std::fill(data.begin(), data.end(), std::uint8_t(0));
    put(data, 2, 1, 1); // format, frame
    put(data, 3, 1, 1);
    put(data, 4, interval, 4);
    put(data, 18, pictureSize, 4);
    put(data, 22, payloadSize, 4);
    return true;
  }
  unsigned int none = 0;
  if (setup.index == terminal) {
    switch (setup.value) {
    case aeMode: // manual or by itself only
      return (setup.request != setCurrent || number(data) == 1 || number(data) == 8) &&
             adjust(setup.request, data, m_state.aeMode, 1, 8);
    case aePriority:
      return adjust(setup.request, data, none, 0, 1);
    case exposure: // refused while the camera sets it
      return (setup.request != setCurrent || m_state.aeMode == 1) &&
             adjust(setup.request, data, m_state.exposure, 1, 200);
    default:
      return false;
    }
  }
  return setup.index == processing && setup.value == gain && adjust(setup.request, data, m_state.gain, 0, 64);
}

//! A payload, of the picture that is on its way or of the next one that is due.
std::vector<std::uint8_t> vpEmulatedUvcCamera::send(size_t room)
{
  if (m_state.commits == 0) {
    return {};
  }
  if (m_sent >= m_picture.size()) {
    m_due += std::chrono::milliseconds(std::lround(1000 * m_state.pause));
    m_state.pause = 0;
    if (Clock::now() < m_due) {
      return {};
    }
    ++m_number;
    m_due += std::chrono::microseconds(static_cast<int>(1e6 / rate));
    m_picture.assign(pictureSize, 100);
    const unsigned int told[] = {m_number, m_state.exposure, m_state.gain};
    for (size_t line = 0; line < 3; ++line) {
      std::fill_n(m_picture.begin() + static_cast<std::ptrdiff_t>(line * width), width,
                  static_cast<std::uint8_t>(told[line]));
    }
    if (m_state.shortFrame) {
      m_state.shortFrame = false;
      m_picture.resize(m_picture.size() / 2);
    }
    m_sent = 0;
  }
  const size_t size = std::min({room, static_cast<size_t>(payloadSize)}) - headerSize;
  const size_t piece = std::min(size, m_picture.size() - m_sent);
  std::vector<std::uint8_t> payload = {headerSize, endOfHeader};
  payload[1] |= (m_number & 1) != 0 ? frameId : 0;
  payload[1] |= m_sent + piece == m_picture.size() ? endOfFrame : 0;
  const auto from = m_picture.begin() + static_cast<std::ptrdiff_t>(m_sent);
  payload.insert(payload.end(), from, from + static_cast<std::ptrdiff_t>(piece));
  m_sent += piece;
  return payload;
}

vpEmulatedUvcCamera::State vpEmulatedUvcCamera::state() const
{
  const std::lock_guard<std::mutex> lock(m_mutex);
  return m_state;
}

void vpEmulatedUvcCamera::setState(const State &state)
{
  const std::lock_guard<std::mutex> lock(m_mutex);
  m_state = state;
}
