/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "common/vpInterrupt.h"

#include <csignal>
#include <initializer_list>

BEGIN_VISP_NAMESPACE

namespace
{
volatile std::sig_atomic_t interrupted = 0;

void interrupt(int)
{
  interrupted = 1;
}
} // namespace

void vpInterrupt::install()
{
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction before;
    if (sigaction(signal, nullptr, &before) != 0 || before.sa_handler == SIG_IGN) {
      continue;
    }
    struct sigaction action = {};
    action.sa_handler = interrupt;
    action.sa_flags = SA_RESETHAND; // no SA_RESTART: a read that waits for a camera returns
    sigemptyset(&action.sa_mask);
    sigaction(signal, &action, nullptr);
  }
}

bool vpInterrupt::requested()
{
  return interrupted != 0;
}

END_VISP_NAMESPACE
