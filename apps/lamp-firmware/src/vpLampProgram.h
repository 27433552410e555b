/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampProgram_h
#define vpLampProgram_h

#include <stdint.h>

/*!
  What one lamp sends, in whole cycles of its clock. Plain C++14 without a library, for the controller and for
  tests on a computer alike.
*/
struct vpLampProgram {
  enum Kind : uint8_t { unmodulated, onePulse, twoPulse, word };
  enum Code : uint8_t { manchester, ook };
  static const uint8_t idSize = 16, bitsSize = 49; // with the 0 at the end
  static const uint8_t mostChips = 2 * (bitsSize - 1);

  uint8_t kind;
  uint8_t code;
  uint16_t top;        // cycles less one: of a period; of a chip
  uint16_t lit;        // cycles of each pulse
  uint16_t apart;      // twoPulse: cycles from the start of the first pulse to that of the second
  char bits[bitsSize]; // of a word, '0' and '1'
  char id[idSize];     // of the map's lamp; may be empty

  uint32_t cycles() const { return static_cast<uint32_t>(top) + 1; }

  //! 100 % lit, as a lamp is that nobody has told anything.
  void clear();
};

//! Cycles from edge to edge of one repetition, the first of them lit: of twoPulse and word.
struct vpLampEdges {
  uint8_t count; // even
  uint16_t cycles[vpLampProgram::mostChips];

  //! \return False where nothing changes, or one stretch is longer than the counter or shorter than an
  //! interrupt takes.
  bool of(const vpLampProgram &program);
};

//! What was wrong with a line.
struct vpLampError {
  char field[18];       // empty: nothing
  const char *expected; // in the controller's flash memory
};

/*!
  Reads `set` lines: `frequency_hz=2270 duty=0.6`, with `phase_difference=0.35` two pulses a period;
  `bits=01111010110010 chip_rate_hz=8000 code=manchester`; `unmodulated=true`; with each `id=L3`. Numbers are
  plain decimals with up to six digits after the point. The nearest whole number of cycles is taken.
  \param clock Hz. \param line Is taken apart. \return False, and \e error says which field; \e program is as
  it was.
*/
bool vpReadLampProgram(char *line, uint32_t clock, vpLampProgram &program, vpLampError &error);

#endif
