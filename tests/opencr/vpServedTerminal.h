/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpServedTerminal_h
#define vpServedTerminal_h

#include <atomic>
#include <memory>
#include <thread>

#include "common/vpPseudoTerminal.h"
#include "opencr/vpRealTimeBoard.h"

//! A pseudo-terminal with a board behind it, until the cable is pulled.
class vpServedTerminal
{
public:
  explicit vpServedTerminal(vpRealTimeBoard &board) : m_board(board), m_terminal(new vpPseudoTerminal) {}
  ~vpServedTerminal() { pullCable(); }

  std::string device() const { return m_terminal->device(); }

  //! From now on bytes go through. Apart from the constructor, for who has to fork before there is a thread.
  void serve()
  {
    m_serving = true;
    m_thread = std::thread([this] {
      while (m_serving) {
        const std::vector<std::uint8_t> bytes = m_terminal->readSome(1);
        if (!bytes.empty()) {
          m_board.receive(bytes);
        }
        const std::vector<std::uint8_t> answer = m_board.send();
        if (!answer.empty()) {
          m_terminal->write(answer);
        }
        if (m_terminal->hungUp()) { // nobody has the device open; poll() would return at once
          std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
      }
    });
  }

  //! The device hangs up; the board lives on.
  void pullCable()
  {
    m_serving = false;
    if (m_thread.joinable()) {
      m_thread.join();
    }
    m_terminal.reset();
  }

private:
  vpRealTimeBoard &m_board;
  std::unique_ptr<vpPseudoTerminal> m_terminal;
  std::atomic<bool> m_serving{false};
  std::thread m_thread;
};

#endif
