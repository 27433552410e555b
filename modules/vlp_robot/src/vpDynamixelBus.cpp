/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_robot/vpDynamixelBus.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <visp3/core/vpException.h>

BEGIN_VISP_NAMESPACE

namespace
{
constexpr double byteTime = 1e-5;       // s at 1 Mbit/s, ten bits each
constexpr size_t aroundParameters = 11; // bytes of a status packet beside its parameters

// Sent before a request that follows an unanswered one. A device that read a wrong length waits for bytes
// that never were, and would swallow the request; these end the wait, and are nothing to a device that does
// not.
constexpr size_t padding = 256;

void append(std::vector<std::uint8_t> &bytes, std::uint16_t value)
{
  bytes.push_back(static_cast<std::uint8_t>(value & 0xFF));
  bytes.push_back(static_cast<std::uint8_t>(value >> 8));
}

vpDynamixelPacket writeRequest(std::uint8_t id, std::uint16_t address, const std::vector<std::uint8_t> &bytes)
{
  vpDynamixelPacket request;
  request.id = id;
  request.instruction = vpDynamixelPacket::write;
  append(request.parameters, address);
  request.parameters.insert(request.parameters.end(), bytes.begin(), bytes.end());
  return request;
}

//! "write of 24 bytes at 150 to device 200"
std::string described(const vpDynamixelPacket &request)
{
  const std::vector<std::uint8_t> &given = request.parameters;
  const std::string device = " device " + std::to_string(request.id);
  if (request.instruction == vpDynamixelPacket::ping) {
    return "ping of" + device;
  }
  const std::string at = " bytes at " + std::to_string(given[0] + 256 * given[1]);
  return request.instruction == vpDynamixelPacket::read
             ? "read of " + std::to_string(given[2] + 256 * given[3]) + at + " of" + device
             : "write of " + std::to_string(given.size() - 2) + at + " to" + device;
}

std::string meaning(std::uint8_t error)
{
  static const std::array<const char *, 8> names = {"none",
                                                    "result fail: it could not process the packet",
                                                    "instruction error: it knows no such instruction",
                                                    "CRC error",
                                                    "data range error: a value is outside its range",
                                                    "data length error: fewer bytes than the item has",
                                                    "data limit error: a value passes its limit",
                                                    "access error: it cannot be written now"};
  return error < names.size() ? names[error] : "unknown error " + std::to_string(error);
}
} // namespace

vpDynamixelBus::vpDynamixelBus(std::unique_ptr<vpByteTransport> transport) : m_transport(std::move(transport))
{
  m_staleUntil = -std::numeric_limits<double>::infinity();
}

vpDynamixelBus::Identity vpDynamixelBus::ping(std::uint8_t id, double deadline)
{
  vpDynamixelPacket request;
  request.id = id;
  const std::vector<std::uint8_t> got = transact(request, 3, deadline).parameters;
  return {static_cast<std::uint16_t>(got[0] + 256 * got[1]), got[2]};
}

std::vector<std::uint8_t> vpDynamixelBus::read(std::uint8_t id, std::uint16_t address, std::uint16_t length,
                                               double deadline)
{
  vpDynamixelPacket request;
  request.id = id;
  request.instruction = vpDynamixelPacket::read;
  append(request.parameters, address);
  append(request.parameters, length);
  return transact(request, length, deadline).parameters;
}

void vpDynamixelBus::write(std::uint8_t id, std::uint16_t address, const std::vector<std::uint8_t> &bytes,
                           double deadline)
{
  transact(writeRequest(id, address, bytes), 0, deadline);
}

void vpDynamixelBus::writeOnce(std::uint8_t id, std::uint16_t address, const std::vector<std::uint8_t> &bytes,
                               double deadline)
{
  transact(writeRequest(id, address, bytes), 0, deadline, false);
}

vpDynamixelPacket vpDynamixelBus::transact(const vpDynamixelPacket &request, size_t parameters,
                                           double deadline, bool repeat)
{
  std::vector<std::uint8_t> bytes = request.encoded();
  const double wire = byteTime * static_cast<double>(bytes.size() + padding + aroundParameters + parameters);
  ++m_statistics.transactions;
  const double began = now();
  int corrupted = 0, silent = 0;
  do {
    if (corrupted + silent > 0 || answerMayBeStale()) {
      m_transport->discard();
    }
    vpDynamixelPacket answer;
    const double until = repeat ? std::min(deadline, now() + answerTime + wire) : deadline;
    switch (attempt(bytes, request.id, parameters, until, answer)) {
    case Outcome::answered:
      if (const std::uint8_t error = answer.error & 0x7F; error != vpDynamixelPacket::none) {
        throw vpException(vpException::ioError, name() + ": " + described(request) + ": answered with " +
                                                    meaning(error) + ", expected none");
      }
      return answer;
    case Outcome::corrupted:
      ++corrupted;
      break;
    case Outcome::silent:
      if (silent++ == 0) {
        bytes.insert(bytes.begin(), padding, 0);
      }
      break;
    }
  } while (repeat && now() < deadline);
  ++m_statistics.failures;
  const long milliseconds = std::lround(1e3 * (now() - began));
  throw vpException(vpException::ioError,
                    name() + ": " + described(request) + ": " + std::to_string(silent + corrupted) +
                        " attempts within " + std::to_string(milliseconds) + " ms, " +
                        std::to_string(silent) + " unanswered and " + std::to_string(corrupted) +
                        " corrupted, expected a valid answer");
}

//! Sends a request once and waits for its answer. What came of it is counted, and what may still come.
vpDynamixelBus::Outcome vpDynamixelBus::attempt(const std::vector<std::uint8_t> &bytes, std::uint8_t id,
                                                size_t parameters, double until, vpDynamixelPacket &answer)
{
  ++m_statistics.attempts;
  m_parser.reset();
  const double sent = now();
  Outcome outcome = Outcome::silent;
  if (m_transport->write(bytes.data(), bytes.size(), until)) {
    outcome = await(id, parameters, until, answer);
  }
  if (outcome == Outcome::answered && (answer.error & 0x7F) == vpDynamixelPacket::crcError) {
    outcome = Outcome::corrupted; // of the request, on its way
  }
  switch (outcome) {
  case Outcome::answered:
    m_answered = now();
    m_statistics.alert |= (answer.error & 0x80) != 0;
    break;
  case Outcome::corrupted: // this attempt's answer, unless that of another one may have come before it
    ++m_statistics.crcErrors;
    m_staleUntil = answerMayBeStale() ? sent + lateAnswerTime : m_staleUntil;
    break;
  case Outcome::silent:
    ++m_statistics.timeouts;
    m_staleUntil = sent + lateAnswerTime;
    break;
  }
  return outcome;
}

vpDynamixelBus::Outcome vpDynamixelBus::await(std::uint8_t id, size_t parameters, double deadline,
                                              vpDynamixelPacket &answer)
{
  const std::uint64_t crcErrors = m_parser.crcErrors();
  std::array<std::uint8_t, 512> bytes;
  for (double patience = deadline;;) {
    const size_t size = m_transport->read(bytes.data(), bytes.size(), patience);
    if (size == 0) {
      return Outcome::silent;
    }
    m_parser.push(bytes.data(), size);
    while (const std::optional<vpDynamixelPacket> packet = m_parser.next()) {
      const bool isAnswer = packet->instruction == vpDynamixelPacket::status && packet->id == id;
      const bool failed = (packet->error & 0x7F) != 0; // which carries no parameters
      if (isAnswer && (failed || packet->parameters.size() == parameters)) {
        answer = *packet;
        return Outcome::answered;
      }
      ++m_statistics.foreign;
    }
    if (m_parser.crcErrors() != crcErrors) {
      return Outcome::corrupted;
    }
    patience = std::min(deadline, now() + silence);
  }
}

bool vpDynamixelBus::answerMayBeStale() const
{
  return now() < m_staleUntil;
}

void vpDynamixelBus::settle()
{
  std::array<std::uint8_t, 512> bytes;
  while (answerMayBeStale()) {
    m_transport->read(bytes.data(), bytes.size(), m_staleUntil);
  }
}

void vpDynamixelBus::reopen()
{
  m_transport->reopen();
  m_parser.reset();
  m_staleUntil = -std::numeric_limits<double>::infinity();
}

vpDynamixelStatistics vpDynamixelBus::statistics() const
{
  vpDynamixelStatistics statistics = m_statistics;
  statistics.skippedBytes = m_parser.skippedBytes();
  return statistics;
}

END_VISP_NAMESPACE
