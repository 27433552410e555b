/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpSerial_h
#define vpSerial_h

#include <stdint.h>

//! Lines over the serial port, 38400 baud, 8N1.
namespace vpSerial
{
void start();
/*!
  The line that has come, without its end; null: none yet. It stays until done() is called, and what comes
  before that is lost. A line that is too long is cut off: \e whole is false.
*/
char *line(bool &whole);
void done();
//! Appends to the line that is being answered.
void write(const char *text);
void writeFlash(const char *text); // PSTR
void writeNumber(uint64_t value);
//! \e value over ten to the number of \e decimals.
void writeDecimal(uint64_t value, uint8_t decimals);
} // namespace vpSerial

#endif
