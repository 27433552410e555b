/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_robot/vpDynamixelPacket.h>

#include <algorithm>
#include <array>
#include <string>

#include <visp3/core/vpException.h>

BEGIN_VISP_NAMESPACE

namespace
{
constexpr std::array<std::uint8_t, 4> header = {0xFF, 0xFF, 0xFD, 0x00};
constexpr std::array<std::uint8_t, 3> stuffed = {0xFF, 0xFF, 0xFD}; // what an FD follows inside a packet
constexpr size_t beforeInstruction = 7;                             // header, id, length
constexpr size_t shortestLength = 3;                                // instruction and CRC

constexpr std::array<std::uint16_t, 256> makeCrcTable()
{
  std::array<std::uint16_t, 256> table{};
  for (unsigned int byte = 0; byte < 256; ++byte) {
    unsigned int crc = byte << 8;
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc & 0x8000) ? (crc << 1) ^ 0x8005 : crc << 1;
    }
    table[byte] = static_cast<std::uint16_t>(crc);
  }
  return table;
}
constexpr std::array<std::uint16_t, 256> crcTable = makeCrcTable();

//! What stands between length and CRC, each FF FF FD followed by an FD.
std::vector<std::uint8_t> stuff(const std::vector<std::uint8_t> &body)
{
  std::vector<std::uint8_t> out;
  out.reserve(body.size() + body.size() / 3 + 1);
  for (const std::uint8_t byte : body) {
    out.push_back(byte);
    if (out.size() >= stuffed.size() && std::equal(stuffed.begin(), stuffed.end(), out.end() - 3)) {
      out.push_back(0xFD);
    }
  }
  return out;
}

//! And back.
std::vector<std::uint8_t> unstuff(const std::uint8_t *begin, const std::uint8_t *end)
{
  std::vector<std::uint8_t> out;
  out.reserve(static_cast<size_t>(end - begin));
  for (; begin != end; ++begin) {
    out.push_back(*begin);
    const bool matches =
        out.size() >= stuffed.size() && std::equal(stuffed.begin(), stuffed.end(), out.end() - 3);
    if (matches && begin + 1 != end && begin[1] == 0xFD) {
      ++begin;
    }
  }
  return out;
}
} // namespace

std::uint16_t vpDynamixelPacket::crc(const std::uint8_t *bytes, size_t size)
{
  std::uint16_t value = 0;
  for (size_t i = 0; i < size; ++i) {
    value = static_cast<std::uint16_t>((value << 8) ^ crcTable[(value >> 8) ^ bytes[i]]);
  }
  return value;
}

std::vector<std::uint8_t> vpDynamixelPacket::encoded() const
{
  std::vector<std::uint8_t> body = {instruction};
  if (instruction == status) {
    body.push_back(error);
  }
  body.insert(body.end(), parameters.begin(), parameters.end());
  body = stuff(body);

  const size_t length = body.size() + 2;
  if (length > largestLength) {
    throw vpException(vpException::badValue, "DYNAMIXEL packet: length " + std::to_string(length) +
                                                 ", expected " + std::to_string(largestLength) + " or less");
  }
  std::vector<std::uint8_t> bytes(header.begin(), header.end());
  bytes.push_back(id);
  bytes.push_back(static_cast<std::uint8_t>(length & 0xFF));
  bytes.push_back(static_cast<std::uint8_t>(length >> 8));
  bytes.insert(bytes.end(), body.begin(), body.end());
  const std::uint16_t check = crc(bytes.data(), bytes.size());
  bytes.push_back(static_cast<std::uint8_t>(check & 0xFF));
  bytes.push_back(static_cast<std::uint8_t>(check >> 8));
  return bytes;
}

void vpDynamixelParser::push(const std::uint8_t *bytes, size_t size)
{
  m_bytes.erase(m_bytes.begin(), m_bytes.begin() + static_cast<std::ptrdiff_t>(m_begin));
  m_begin = 0;
  m_bytes.insert(m_bytes.end(), bytes, bytes + size);
}

std::optional<vpDynamixelPacket> vpDynamixelParser::next()
{
  for (;;) {
    const std::uint8_t *const begin = m_bytes.data() + m_begin, *const end = m_bytes.data() + m_bytes.size();
    const std::uint8_t *const found = std::search(begin, end, header.begin(), header.end());
    if (found == end) { // the last three bytes may be the beginning of a header
      skip(pending() - std::min<size_t>(pending(), header.size() - 1));
      return std::nullopt;
    }
    skip(static_cast<size_t>(found - begin));
    if (pending() < beforeInstruction) {
      return std::nullopt;
    }
    const size_t length = found[5] + 256u * found[6];
    if (length < shortestLength || length > vpDynamixelPacket::largestLength) {
      skip(1);
      continue;
    }
    const size_t size = beforeInstruction + length;
    if (pending() < size) {
      return std::nullopt;
    }
    if (vpDynamixelPacket::crc(found, size - 2) != found[size - 2] + 256u * found[size - 1]) {
      ++m_crcErrors;
      skip(1);
      continue;
    }
    const std::vector<std::uint8_t> body = unstuff(found + beforeInstruction, found + size - 2);
    vpDynamixelPacket packet;
    packet.id = found[4];
    packet.instruction = body[0];
    const bool isStatus = packet.instruction == vpDynamixelPacket::status;
    if (isStatus && body.size() < 2) {
      skip(1);
      continue;
    }
    packet.error = isStatus ? body[1] : 0;
    packet.parameters.assign(body.begin() + (isStatus ? 2 : 1), body.end());
    m_begin += size;
    return packet;
  }
}

void vpDynamixelParser::reset()
{
  skip(pending());
}

void vpDynamixelParser::skip(size_t size)
{
  m_begin += size;
  m_skippedBytes += size;
}

END_VISP_NAMESPACE
