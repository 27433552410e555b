/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpEmulatedTransport_h
#define vpEmulatedTransport_h

#include <algorithm>
#include <deque>

#include <visp3/core/vpException.h>
#include <visp3/vlp_robot/vpByteTransport.h>

#include "opencr/vpFaultyLine.h"
#include "opencr/vpOpenCrEmulator.h"

//! A line to an emulated board, both in the simulated robot's time: reading waits by letting the world run.
class vpEmulatedTransport : public vpByteTransport
{
public:
  vpEmulatedTransport(vpSimulatorTurtleBot3 &robot, vpOpenCrEmulator &board,
                      const vpFaultyLine::Faults &faults = vpFaultyLine::Faults())
      : m_board(board), m_line(faults), m_now(robot.time())
  {
  }

  double now() const override { return m_now; }

  //! The host does something else up to \e time, s.
  void advance(double time)
  {
    m_now = std::max(m_now, time);
    m_board.advance(m_now);
  }

  //! From now on the cable is as bad as that.
  void setFaults(const vpFaultyLine::Faults &faults) { m_line = vpFaultyLine(faults); }
  const vpFaultyLine &cable() const { return m_line; }
  void pullCable() { m_plugged = m_open = false; }
  void plugCable() { m_plugged = true; }

  bool write(const std::uint8_t *bytes, size_t size, double deadline) override
  {
    requireOpen();
    advance(m_now + wireTime * static_cast<double>(size));
    for (vpOpenCrEmulator::Answer &answer : m_board.receive(m_line.pass({bytes, bytes + size}))) {
      answer.due += usbTime + m_line.holdUp() + wireTime * static_cast<double>(answer.bytes.size());
      answer.due = m_coming.empty() ? answer.due : std::max(answer.due, m_coming.back().due);
      answer.bytes = m_line.pass(answer.bytes);
      m_coming.push_back(std::move(answer));
    }
    return m_now <= deadline;
  }

  size_t read(std::uint8_t *bytes, size_t most, double deadline) override
  {
    requireOpen();
    while (!m_coming.empty() && m_coming.front().bytes.empty()) {
      m_coming.pop_front();
    }
    if (m_coming.empty() || m_coming.front().due > deadline) {
      advance(deadline);
      return 0;
    }
    vpOpenCrEmulator::Answer &answer = m_coming.front();
    advance(answer.due);
    const size_t size = std::min(most, answer.bytes.size());
    std::copy_n(answer.bytes.begin(), size, bytes);
    answer.bytes.erase(answer.bytes.begin(), answer.bytes.begin() + static_cast<std::ptrdiff_t>(size));
    return size;
  }

  void discard() override
  {
    requireOpen();
    while (!m_coming.empty() && m_coming.front().due <= m_now) {
      m_coming.pop_front();
    }
  }

  void reopen() override
  {
    m_open = m_plugged;
    m_coming.clear();
    requireOpen();
  }

  std::string name() const override { return "emulated board"; }

private:
  static constexpr double wireTime = 1e-5; // s a byte
  static constexpr double usbTime = 1e-3;  // s until the host fetches what is there

  void requireOpen() const
  {
    if (!m_open) {
      throw vpException(vpException::ioError, "emulated board: is gone, expected a plugged cable");
    }
  }

  vpOpenCrEmulator &m_board;
  vpFaultyLine m_line;
  double m_now;
  std::deque<vpOpenCrEmulator::Answer> m_coming;
  bool m_plugged = true, m_open = true;
};

#endif
