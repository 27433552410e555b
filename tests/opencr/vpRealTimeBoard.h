/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpRealTimeBoard_h
#define vpRealTimeBoard_h

#include <chrono>
#include <deque>
#include <mutex>
#include <vector>

#include "opencr/vpFaultyLine.h"
#include "opencr/vpOpenCrEmulator.h"

/*!
  A simulated TurtleBot3 with its emulated board that lives in real time. Whenever somebody looks at it, it
  has run up to now: it needs no thread, and several may use it.
*/
class vpRealTimeBoard
{
public:
  explicit vpRealTimeBoard(const vpSimulatorTurtleBot3Settings &world = vpSimulatorTurtleBot3Settings(),
                           const vpOpenCrEmulator::Settings &settings = vpOpenCrEmulator::Settings())
      : m_robot(world), m_board(m_robot, settings), m_begin(Clock::now())
  {
  }

  //! Calls \e act with robot and board as they are now.
  template <class Act>
  auto with(Act act)
  {
    const std::lock_guard<std::mutex> lock(m_mutex);
    m_board.advance(m_robot.time() + std::max(sinceBegin() - (m_robot.time() - m_startTime), 0.0));
    return act(m_robot, m_board);
  }

  //! Bytes of the host that arrive now.
  void receive(const std::vector<std::uint8_t> &bytes)
  {
    with([&](vpSimulatorTurtleBot3 &, vpOpenCrEmulator &board) {
      for (vpOpenCrEmulator::Answer &answer : board.receive(m_line.pass(bytes))) {
        answer.due += m_line.holdUp();
        answer.due = m_going.empty() ? answer.due : std::max(answer.due, m_going.back().due);
        answer.bytes = m_line.pass(answer.bytes);
        m_going.push_back(std::move(answer));
      }
    });
  }

  //! Up to \e most of the bytes that have left the board by now.
  std::vector<std::uint8_t> send(size_t most = 4096)
  {
    std::vector<std::uint8_t> bytes;
    with([&](vpSimulatorTurtleBot3 &robot, vpOpenCrEmulator &) {
      while (!m_going.empty() && m_going.front().due <= robot.time() && bytes.size() < most) {
        std::vector<std::uint8_t> &next = m_going.front().bytes;
        const size_t size = std::min(most - bytes.size(), next.size());
        bytes.insert(bytes.end(), next.begin(), next.begin() + static_cast<std::ptrdiff_t>(size));
        next.erase(next.begin(), next.begin() + static_cast<std::ptrdiff_t>(size));
        if (next.empty()) {
          m_going.pop_front();
        }
      }
    });
    return bytes;
  }

  void setFaults(const vpFaultyLine::Faults &faults)
  {
    with([&](vpSimulatorTurtleBot3 &, vpOpenCrEmulator &) { m_line = vpFaultyLine(faults); });
  }

private:
  using Clock = std::chrono::steady_clock;
  double sinceBegin() const { return std::chrono::duration<double>(Clock::now() - m_begin).count(); }

  std::mutex m_mutex;
  vpSimulatorTurtleBot3 m_robot;
  vpOpenCrEmulator m_board;
  vpFaultyLine m_line;
  std::deque<vpOpenCrEmulator::Answer> m_going;
  double m_startTime = m_robot.time();
  Clock::time_point m_begin;
};

#endif
