/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpDynamixelBus_h
#define vpDynamixelBus_h

#include <memory>
#include <string>
#include <vector>

#include <visp3/vlp_robot/vpByteTransport.h>
#include <visp3/vlp_robot/vpDynamixelPacket.h>

BEGIN_VISP_NAMESPACE

//! What happened on a bus since it was opened.
struct VISP_EXPORT vpDynamixelStatistics {
  std::uint64_t transactions = 0; // asked for
  std::uint64_t attempts = 0;     // requests sent
  std::uint64_t timeouts = 0;     // attempts without a whole answer
  std::uint64_t crcErrors = 0;    // attempts with a CRC error, found by the host or by the device
  std::uint64_t foreign = 0;      // valid packets that answer something else
  std::uint64_t skippedBytes = 0; // that belong to no packet
  std::uint64_t failures = 0;     // transactions without an answer at their deadline
  bool alert = false;             // a device has reported a fault of its hardware
};

/*!
  Ping, Read and Write of DYNAMIXEL protocol 2.0, each confirmed by the device's answer. An attempt without a
  valid answer is repeated until the deadline, which is a time of now().

  The protocol has no sequence numbers: an answer that comes after its attempt was given up looks like that of
  the next attempt. So for some time after an attempt that went unanswered, answerMayBeStale() is true, and an
  answer shows that the device took some request of late, perhaps not the last one. A caller that has to know
  then reads back what it wrote. An answer of the wrong length is never taken.

  All of them throw vpException (ioError) where no valid answer came by the deadline, where the line is gone,
  or where the device answers with an error.
*/
class VISP_EXPORT vpDynamixelBus
{
public:
  struct Identity {
    std::uint16_t model = 0;
    std::uint8_t firmware = 0;
  };

  double answerTime = 0.034;   // s, an answer's first byte comes within it; the wire's time is added
  double silence = 0.01;       // s without a byte in the midst of an answer: the rest was lost
  double lateAnswerTime = 0.2; // s after its request that an answer may come at the latest

  explicit vpDynamixelBus(std::unique_ptr<vpByteTransport> transport);

  Identity ping(std::uint8_t id, double deadline);
  std::vector<std::uint8_t> read(std::uint8_t id, std::uint16_t address, std::uint16_t length,
                                 double deadline);
  void write(std::uint8_t id, std::uint16_t address, const std::vector<std::uint8_t> &bytes, double deadline);
  //! As write(), sent once and waited for until the deadline: for what must not be done twice.
  void writeOnce(std::uint8_t id, std::uint16_t address, const std::vector<std::uint8_t> &bytes,
                 double deadline);

  //! Whether an answer to a request given up may still come.
  bool answerMayBeStale() const;
  //! Waits until it is not, for lateAnswerTime at most. \throw vpException (ioError) where the line is gone.
  void settle();

  //! s, of now(), when the last answer was there.
  double answered() const { return m_answered; }

  //! Opens the line anew. \throw vpException (ioError).
  void reopen();

  double now() const { return m_transport->now(); }
  std::string name() const { return m_transport->name(); }
  vpDynamixelStatistics statistics() const;

private:
  enum class Outcome { answered, silent, corrupted };

  vpDynamixelPacket transact(const vpDynamixelPacket &request, size_t parameters, double deadline,
                             bool repeat = true);
  Outcome attempt(const std::vector<std::uint8_t> &bytes, std::uint8_t id, size_t parameters, double until,
                  vpDynamixelPacket &answer);
  Outcome await(std::uint8_t id, size_t parameters, double deadline, vpDynamixelPacket &answer);

  std::unique_ptr<vpByteTransport> m_transport;
  vpDynamixelParser m_parser;
  vpDynamixelStatistics m_statistics;
  double m_staleUntil = 0; // s, till when an answer to a request given up may come
  double m_answered = 0;   // s
};

END_VISP_NAMESPACE

#endif
