/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpDynamixelPacket_h
#define vpDynamixelPacket_h

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  A packet of DYNAMIXEL protocol 2.0 (ROBOTIS e-manual):

      FF FF FD 00 | id | length lo hi | instruction | [error] parameters | CRC lo hi

  The length counts from the instruction to the CRC. Status packets carry the error. After every FF FF FD from
  the instruction to the last parameter the sender stuffs an FD, so that no header appears inside a packet.
*/
struct VISP_EXPORT vpDynamixelPacket {
  enum Instruction : std::uint8_t { ping = 0x01, read = 0x02, write = 0x03, status = 0x55 };
  //! Bits 0 to 6 of a status packet's error. Bit 7, the alert, reports a fault of the
  //! hardware.
  enum Error : std::uint8_t {
    none = 0,
    resultFail = 1,
    instructionError = 2,
    crcError = 3,
    dataRange = 4,
    dataLength = 5,
    dataLimit = 6,
    access = 7
  };

  static constexpr size_t largestLength = 1024; // of the length field; longer ones are taken for corrupted

  std::uint8_t id = 0;
  std::uint8_t instruction = ping;
  std::uint8_t error = none; // of a status packet
  std::vector<std::uint8_t> parameters;

  //! The bytes on the wire. \throw vpException (badValue) where the length passes largestLength.
  std::vector<std::uint8_t> encoded() const;

  //! CRC-16 of the protocol: polynomial 0x8005, from 0, not reflected. "123456789" gives 0xFEE8.
  static std::uint16_t crc(const std::uint8_t *bytes, size_t size);
};

/*!
  Finds the packets in a stream of bytes, whatever else is in it. Bytes that make no packet are skipped one by
  one, those of a packet that failed its CRC too: a header that is none cannot hide the packet behind it.
  Nothing here throws; what was wrong is counted.
*/
class VISP_EXPORT vpDynamixelParser
{
public:
  void push(const std::uint8_t *bytes, size_t size);

  //! The next whole packet whose CRC is right, none where more bytes are needed.
  std::optional<vpDynamixelPacket> next();

  //! Forgets the bytes that are no packet yet.
  void reset();

  //! Of the bytes since the last packet, all that still may become one.
  size_t pending() const { return m_bytes.size() - m_begin; }

  std::uint64_t crcErrors() const { return m_crcErrors; }       //!< Since the beginning.
  std::uint64_t skippedBytes() const { return m_skippedBytes; } //!< Since the beginning.

private:
  void skip(size_t size);

  std::vector<std::uint8_t> m_bytes;
  size_t m_begin = 0; // of what is not done with
  std::uint64_t m_crcErrors = 0, m_skippedBytes = 0;
};

END_VISP_NAMESPACE

#endif
