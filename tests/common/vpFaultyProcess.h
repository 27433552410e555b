/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpFaultyProcess_h
#define vpFaultyProcess_h

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <map>
#include <ostream>
#include <string>
#include <thread>
#include <vector>

#include "common/vpProcess.h"

//! Which call fails, and how: the variables of tests/faults/shim/vpFaults.cpp.
struct vpFault {
  std::string call, as, at;
};

inline void PrintTo(const vpFault &fault, std::ostream *stream)
{
  *stream << fault.call << " " << fault.at << ": " << fault.as;
}

//! How a program came to its end.
struct vpEnding {
  int code = 0;
  bool hit = false; // a call was made to fail
  std::string out, err;
};

//! While it lives, programs that are begun have that fault in what is under the folder \e under.
class vpFaultyCalls
{
public:
  vpFaultyCalls(const vpFault &fault, const std::string &under)
      : m_variables({{"LD_PRELOAD", VLP_FAULTS},
                     {"VLP_FAULT_CALL", fault.call},
                     {"VLP_FAULT_AS", fault.as},
                     {"VLP_FAULT_AT", fault.at},
                     {"VLP_FAULT_UNDER", under},
                     {"VLP_FAULT_HIT", m_marks / "hit"}})
  {
    for (const auto &[name, value] : m_variables) {
      setenv(name.c_str(), value.c_str(), 1);
    }
  }
  ~vpFaultyCalls()
  {
    for (const auto &[name, value] : m_variables) {
      unsetenv(name.c_str());
    }
  }
  vpFaultyCalls(const vpFaultyCalls &) = delete;
  vpFaultyCalls &operator=(const vpFaultyCalls &) = delete;

  //! Whether a call was made to fail.
  bool hit() const { return m_marks.count() > 0; }

private:
  vpTemporaryFolder m_marks;
  std::map<std::string, std::string> m_variables;
};

//! Runs a program with a fault. One that hangs is ended after a time that none of them needs.
inline vpEnding vpRunWith(const vpFault &fault, const std::string &under, const std::string &program,
                          const std::vector<std::string> &arguments)
{
  const vpFaultyCalls calls(fault, under);
  vpProcess process(program, arguments);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!process.ended() && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  if (!process.ended()) {
    process.signal(SIGKILL);
  }
  return {process.wait(), calls.hit(), process.out(), process.err()};
}

#endif
