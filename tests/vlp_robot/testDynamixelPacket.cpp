/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <algorithm>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <visp3/vlp_robot/vpDynamixelPacket.h>
#include <visp3/vlp_robot/vpOpenCrTable.h>

#include "common/vpExpectError.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
using Bytes = std::vector<std::uint8_t>;

//! "FF 0A [3 x 00]" as bytes.
Bytes bytesOf(const std::string &text)
{
  Bytes bytes;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    size_t times = 1;
    if (word[0] == '[') {
      times = std::stoul(word.substr(1));
      words >> word >> word;
    }
    bytes.insert(bytes.end(), times, static_cast<std::uint8_t>(std::stoul(word, nullptr, 16)));
  }
  return bytes;
}

vpDynamixelPacket request(std::uint8_t id, std::uint8_t instruction, const Bytes &parameters = {})
{
  return {id, instruction, 0, parameters};
}

vpDynamixelPacket status(std::uint8_t id, const Bytes &parameters = {}, std::uint8_t error = 0)
{
  return {id, vpDynamixelPacket::status, error, parameters};
}

//! All packets that a parser finds in \e bytes.
std::vector<vpDynamixelPacket> parsed(const Bytes &bytes, size_t piece = 1 << 20)
{
  vpDynamixelParser parser;
  std::vector<vpDynamixelPacket> packets;
  for (size_t i = 0; i < bytes.size(); i += piece) {
    parser.push(bytes.data() + i, std::min(piece, bytes.size() - i));
    while (const auto packet = parser.next()) {
      packets.push_back(*packet);
    }
  }
  return packets;
}

void expectSame(const vpDynamixelPacket &a, const vpDynamixelPacket &b)
{
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.instruction, b.instruction);
  EXPECT_EQ(a.error, b.error);
  EXPECT_EQ(a.parameters, b.parameters);
}

//! Packets full of what has to be stuffed.
vpDynamixelPacket randomPacket(std::mt19937_64 &random)
{
  static const std::uint8_t likely[] = {0xFF, 0xFF, 0xFF, 0xFD, 0xFD, 0x00, 0x55, 0x12};
  vpDynamixelPacket packet =
      request(200, random() % 2 ? vpDynamixelPacket::status : vpDynamixelPacket::write);
  packet.error = packet.instruction == vpDynamixelPacket::status ? likely[random() % 8] : 0;
  for (size_t left = random() % 200; left > 0; --left) {
    packet.parameters.push_back(likely[random() % 8]);
  }
  return packet;
}
} // namespace

TEST(DynamixelPacket, CrcHasItsCheckValue)
{
  const std::string digits = "123456789";
  EXPECT_EQ(vpDynamixelPacket::crc(reinterpret_cast<const std::uint8_t *>(digits.data()), digits.size()),
            0xFEE8);
}

TEST(DynamixelPacket, IsThatOfTheManual)
{
  vpControlBlock drive(vpOpenCrTable::commandAddress, vpOpenCrTable::commandLength);
  drive.set(vpOpenCrTable::commandV, 10);
  drive.set(vpOpenCrTable::commandW, 50);
  Bytes driving = {150, 0};
  driving.insert(driving.end(), drive.bytes().begin(), drive.bytes().end());
  const Bytes table = {vpOpenCrTable::snapshotAddress, 0, vpOpenCrTable::snapshotLength, 0};

  const std::vector<std::pair<vpDynamixelPacket, std::string>> all = {
      {request(1, vpDynamixelPacket::ping), "FF FF FD 00 01 03 00 01 19 4E"},
      {status(1, {0x06, 0x04, 0x26}), "FF FF FD 00 01 07 00 55 00 06 04 26 65 5D"},
      {request(1, vpDynamixelPacket::read, {0x84, 0, 4, 0}), "FF FF FD 00 01 07 00 02 84 00 04 00 1D 15"},
      {status(1, {0xA6, 0, 0, 0}), "FF FF FD 00 01 08 00 55 00 A6 00 00 00 8C C0"},
      {request(1, vpDynamixelPacket::write, {0x74, 0, 0, 2, 0, 0}),
       "FF FF FD 00 01 09 00 03 74 00 00 02 00 00 CA 89"},
      {status(1), "FF FF FD 00 01 04 00 55 00 A1 0C"},
      {request(200, vpDynamixelPacket::ping), "FF FF FD 00 C8 03 00 01 3B FA"},
      {status(200, {0x00, 0x50, 0x05}), "FF FF FD 00 C8 07 00 55 00 00 50 05 4C B7"},
      {request(200, vpDynamixelPacket::write, {0x13, 0, 1}), "FF FF FD 00 C8 06 00 03 13 00 01 37 A7"},
      {status(200), "FF FF FD 00 C8 04 00 55 00 19 2D"},
      {request(200, vpDynamixelPacket::read, table), "FF FF FD 00 C8 07 00 02 0A 00 AC 00 B6 2F"},
      {request(200, vpDynamixelPacket::write, driving),
       "FF FF FD 00 C8 1D 00 03 96 00 0A [19 x 00] 32 00 00 00 4D 37"},
      {status(200, {0xFF, 0xFF, 0xFD, 0xFF}), "FF FF FD 00 C8 09 00 55 00 FF FF FD FD FF 94 F1"}, // -131073
  };
  for (const auto &[packet, text] : all) {
    SCOPED_TRACE(text);
    EXPECT_EQ(packet.encoded(), bytesOf(text));
    const auto back = parsed(bytesOf(text));
    ASSERT_EQ(back.size(), 1u);
    expectSame(back[0], packet);
  }
}

TEST(DynamixelPacket, TooLongOnesAreRefused)
{
  EXPECT_EQ(parsed(request(1, vpDynamixelPacket::write, Bytes(1021, 7)).encoded()).size(), 1u);
  vpExpectError([] { request(1, vpDynamixelPacket::write, Bytes(1022, 7)).encoded(); },
                {"DYNAMIXEL packet: length 1025, expected 1024 or less"});
}

TEST(DynamixelParser, GivesBackWhatWasSent)
{
  std::mt19937_64 random(1);
  for (int i = 0; i < 3000; ++i) {
    const vpDynamixelPacket packet = randomPacket(random);
    const Bytes bytes = packet.encoded();
    const Bytes header = {0xFF, 0xFF, 0xFD, 0x00}; // appears nowhere inside
    EXPECT_EQ(std::search(bytes.begin() + 4, bytes.end() - 2, header.begin(), header.end()), bytes.end() - 2);
    const auto back = parsed(bytes, 1 + random() % 9);
    ASSERT_EQ(back.size(), 1u);
    expectSame(back[0], packet);
  }
}

TEST(DynamixelParser, FindsPacketsInGarbage)
{
  std::mt19937_64 random(2);
  static const std::uint8_t likely[] = {0xFF, 0xFF, 0xFD, 0x00, 0xC8, 0x01, 0x55, 0x03};
  int found = 0;
  for (int i = 0; i < 2000; ++i) {
    Bytes stream;
    for (size_t left = random() % 40; left > 0; --left) {
      stream.push_back(likely[random() % 8]);
    }
    const vpDynamixelPacket packet = randomPacket(random);
    const Bytes bytes = packet.encoded();
    stream.insert(stream.end(), bytes.begin(), bytes.end());
    stream.insert(stream.end(), vpDynamixelPacket::largestLength + 7, 0); // a false length waits for no more
    const auto packets = parsed(stream, 1 + random() % 64);
    // The garbage may end so that the packet's own beginning belongs to it; by chance it may be a packet.
    for (const vpDynamixelPacket &one : packets) {
      found += one.parameters == packet.parameters && one.instruction == packet.instruction;
    }
  }
  EXPECT_EQ(found, 2000);
}

TEST(DynamixelParser, FalseHeaderHidesNothing)
{
  const Bytes packet = status(200, {1, 2, 3}).encoded();
  Bytes stream = bytesOf("FF FF FD 00 C8 20 00 55"); // of a packet whose rest was lost
  stream.insert(stream.end(), packet.begin(), packet.end());
  stream.insert(stream.end(), packet.begin(), packet.end());
  stream.insert(stream.end(), packet.begin(), packet.end());
  EXPECT_EQ(parsed(stream).size(), 3u);
  EXPECT_EQ(parsed(stream, 1).size(), 3u);

  vpDynamixelParser parser;
  parser.push(stream.data(), stream.size());
  while (parser.next()) {
  }
  EXPECT_EQ(parser.crcErrors(), 1u);
  EXPECT_EQ(parser.skippedBytes(), 8u);
  parser.push(packet.data(), 5); // given up
  parser.reset();
  parser.push(packet.data(), packet.size());
  EXPECT_TRUE(parser.next().has_value());
}

//! A CRC of 16 bits sees every burst of up to 16 bits; of others all but 1 in 65536.
TEST(DynamixelParser, EveryShortBurstIsSeen)
{
  std::mt19937_64 random(3);
  for (int i = 0; i < 20000; ++i) {
    Bytes bytes = randomPacket(random).encoded();
    const size_t bit = random() % (8 * bytes.size() - 16);
    const std::uint32_t burst = static_cast<std::uint32_t>(1 + random() % 0xFFFF);
    for (size_t k = 0; k < 16; ++k) { // most significant bit first, as the CRC runs
      bytes[(bit + k) / 8] ^= static_cast<std::uint8_t>(((burst >> k) & 1) << (7 - (bit + k) % 8));
    }
    ASSERT_TRUE(parsed(bytes).empty());
  }
}

TEST(DynamixelParser, NoiseDoesNoHarm)
{
  std::mt19937_64 random(4);
  vpDynamixelParser parser;
  std::uint64_t bytes = 0;
  for (int i = 0; i < 20000; ++i) {
    Bytes noise(random() % 50);
    std::generate(noise.begin(), noise.end(),
                  [&] { return random() % 3 ? 0xFF - 2 * (random() % 2) : random(); });
    parser.push(noise.data(), noise.size());
    bytes += noise.size();
    while (parser.next()) {
    }
    ASSERT_LE(parser.pending(), vpDynamixelPacket::largestLength + 7); // it does not pile up
  }
  parser.reset();
  EXPECT_GT(bytes, 400000u);
  EXPECT_EQ(parser.pending(), 0u);
}
