/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLight_h
#define vpLight_h

#include "vpLampProgram.h"

/*!
  The lamp on pin D9 (PB1, OC1A), by timer 1 without a divider. Each edge is made by the timer's own compare
  unit: a pulse by its PWM mode, two pulses and words by toggling where an interrupt has said beforehand. So
  no edge is early or late, as long as interrupts are through before it.
*/
namespace vpLight
{
//! From dark to 100 % lit within 32 ms.
void start();
//! 100 % lit in between.
void send(const vpLampProgram &program);
//! Whether the edges still come: an interrupt that is lost stops them.
bool isAlive();
} // namespace vpLight

#endif
