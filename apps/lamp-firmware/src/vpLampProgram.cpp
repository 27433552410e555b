/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLampProgram.h"

#include <string.h>

#ifdef __AVR__
#include <avr/pgmspace.h>
#else
#define PSTR(text) text
#endif

namespace
{
const uint64_t million = 1000000;
const uint16_t leastCycles = 160; // from edge to edge: an interrupt, after that of the serial port

struct Fields {
  const char *frequency, *duty, *phaseDifference, *bits, *chipRate, *code, *unmodulated, *id;
};

bool fails(vpLampError &error, const char *field, const char *expected)
{
  strncpy(error.field, field, sizeof error.field - 1);
  error.field[sizeof error.field - 1] = 0;
  error.expected = expected;
  return false;
}

//! A plain decimal, in millionths.
bool readMillionths(const char *text, uint64_t &value)
{
  static const uint8_t mostDigits = 8, decimals = 6;
  uint8_t digits = 0, after = 0;
  bool point = false;
  value = 0;
  for (; *text != 0; ++text) {
    if (*text == '.' && !point) {
      point = true;
    } else if (*text >= '0' && *text <= '9' && (point ? after++ < decimals : digits++ < mostDigits)) {
      value = 10 * value + static_cast<uint64_t>(*text - '0');
    } else {
      return false;
    }
  }
  for (uint8_t k = after; k < decimals; ++k) {
    value *= 10;
  }
  return digits + after > 0;
}

//! Cycles of one turn at a rate in millionths of a hertz, less one. False: none or more than the counter has.
bool readTop(uint32_t clock, uint64_t rate, uint16_t &top)
{
  if (rate == 0) {
    return false;
  }
  const uint64_t cycles = (million * clock + rate / 2) / rate;
  top = static_cast<uint16_t>(cycles - 1);
  return cycles >= 2 * leastCycles && cycles <= 65536;
}

//! A share of some cycles, at least one of them, and not all.
bool readShare(const char *text, uint32_t cycles, uint16_t &share)
{
  uint64_t millionths;
  if (!readMillionths(text, millionths) || millionths == 0 || millionths >= million) {
    return false;
  }
  const uint64_t whole = (millionths * cycles + million / 2) / million;
  share = static_cast<uint16_t>(whole < 1 ? 1 : whole >= cycles ? cycles - 1 : whole);
  return true;
}

//! Takes the line apart: each value is left as a text of its own.
bool split(char *line, Fields &fields, vpLampError &error)
{
  struct Name {
    char name[18];
    const char *Fields::*value;
  };
  static const Name names[] = {{"frequency_hz", &Fields::frequency},
                               {"duty", &Fields::duty},
                               {"phase_difference", &Fields::phaseDifference},
                               {"bits", &Fields::bits},
                               {"chip_rate_hz", &Fields::chipRate},
                               {"code", &Fields::code},
                               {"unmodulated", &Fields::unmodulated},
                               {"id", &Fields::id}};
  for (char *field = strtok(line, " \t"); field != nullptr; field = strtok(nullptr, " \t")) {
    char *value = strchr(field, '=');
    if (value == nullptr) {
      return fails(error, field, PSTR("name=value"));
    }
    *value++ = 0;
    bool known = false;
    for (const Name &each : names) {
      if (strcmp(field, each.name) == 0) {
        if (fields.*each.value != nullptr) {
          return fails(error, field, PSTR("to be given once"));
        }
        fields.*each.value = value;
        known = true;
      }
    }
    if (!known) {
      return fails(error, field,
                   PSTR("frequency_hz, duty, phase_difference, bits, chip_rate_hz, code, unmodulated or id"));
    }
  }
  return true;
}

bool readPulses(const Fields &fields, uint32_t clock, vpLampProgram &program, vpLampError &error)
{
  uint64_t rate;
  if (!readMillionths(fields.frequency, rate) || !readTop(clock, rate, program.top)) {
    return fails(error, "frequency_hz",
                 PSTR("a decimal number; the clock's cycles of a period, 320 to 65536"));
  }
  uint16_t lit;
  if (fields.duty == nullptr || !readShare(fields.duty, program.cycles(), lit)) {
    return fails(error, "duty", PSTR("a decimal number above 0 and below 1"));
  }
  program.kind = vpLampProgram::onePulse;
  program.lit = lit;
  if (fields.phaseDifference == nullptr) {
    return true;
  }
  program.kind = vpLampProgram::twoPulse;
  program.lit = static_cast<uint16_t>((lit + 1) / 2);
  vpLampEdges edges;
  if (!readShare(fields.phaseDifference, program.cycles(), program.apart) || !edges.of(program)) {
    return fails(error, "phase_difference",
                 PSTR("a decimal number below 0.5 and above half the duty, by 160 cycles of the clock each"));
  }
  return true;
}

bool readWord(const Fields &fields, uint32_t clock, vpLampProgram &program, vpLampError &error)
{
  const size_t length = strlen(fields.bits);
  if (length == 0 || length >= vpLampProgram::bitsSize || strspn(fields.bits, "01") != length) {
    return fails(error, "bits", PSTR("up to 48 digits 0 and 1"));
  }
  strcpy(program.bits, fields.bits);
  if (fields.code == nullptr || (strcmp(fields.code, "manchester") != 0 && strcmp(fields.code, "ook") != 0)) {
    return fails(error, "code", PSTR("manchester or ook"));
  }
  program.code = fields.code[0] == 'm' ? vpLampProgram::manchester : vpLampProgram::ook;
  program.kind = vpLampProgram::word;
  uint64_t rate;
  vpLampEdges edges;
  if (fields.chipRate == nullptr || !readMillionths(fields.chipRate, rate) || rate == 0) {
    return fails(error, "chip_rate_hz", PSTR("a decimal number above 0"));
  }
  const uint64_t cycles = (million * clock + rate / 2) / rate;
  program.top = static_cast<uint16_t>(cycles - 1);
  if (cycles < leastCycles || cycles > 65536 || !edges.of(program)) {
    return fails(
        error, "chip_rate_hz",
        PSTR("160 cycles of the clock a chip or more, and no light or dark of over 65535; bits of both"));
  }
  return true;
}
} // namespace

void vpLampProgram::clear()
{
  memset(this, 0, sizeof *this);
}

bool vpLampEdges::of(const vpLampProgram &program)
{
  count = 0;
  if (program.kind == vpLampProgram::twoPulse) {
    const uint32_t gap = program.apart - program.lit, rest = program.cycles() - program.apart - program.lit;
    if (program.apart < program.lit + leastCycles || 2ul * program.apart >= program.cycles() ||
        rest < leastCycles || program.lit < leastCycles) {
      return false;
    }
    cycles[0] = cycles[2] = program.lit;
    cycles[1] = static_cast<uint16_t>(gap);
    cycles[3] = static_cast<uint16_t>(rest);
    count = 4;
    return true;
  }
  // A word: from the first chip that is lit after a dark one.
  const uint8_t bits = static_cast<uint8_t>(strlen(program.bits));
  const bool two = program.code == vpLampProgram::manchester;
  const uint8_t chips = two ? 2 * bits : bits;
  const auto isLit = [&](uint8_t chip) {
    chip %= chips;
    return two ? (program.bits[chip / 2] == '1') == (chip % 2 == 0) : program.bits[chip] == '1';
  };
  uint8_t first = 0;
  while (first < chips && !(isLit(first) && !isLit(first + chips - 1))) {
    ++first;
  }
  if (first == chips) {
    return false;
  }
  uint32_t run = 0;
  for (uint8_t k = 0; k < chips; ++k) {
    run += program.cycles();
    if (isLit(first + k) != isLit(first + k + 1)) {
      if (run > 65535 || run < leastCycles) {
        return false;
      }
      cycles[count++] = static_cast<uint16_t>(run);
      run = 0;
    }
  }
  return true;
}

bool vpReadLampProgram(char *line, uint32_t clock, vpLampProgram &program, vpLampError &error)
{
  Fields fields = {};
  vpLampProgram read;
  read.clear();
  error.field[0] = 0;
  if (!split(line, fields, error)) {
    return false;
  }
  const uint8_t kinds =
      (fields.frequency != nullptr) + (fields.bits != nullptr) + (fields.unmodulated != nullptr);
  if (kinds != 1) {
    return fails(error, "set", PSTR("one of frequency_hz, bits and unmodulated"));
  }
  if (fields.id != nullptr) {
    if (strlen(fields.id) >= vpLampProgram::idSize) {
      return fails(error, "id", PSTR("up to 15 characters"));
    }
    strcpy(read.id, fields.id);
  }
  if (fields.frequency == nullptr && (fields.duty != nullptr || fields.phaseDifference != nullptr)) {
    return fails(error, fields.duty != nullptr ? "duty" : "phase_difference",
                 PSTR("to stand beside frequency_hz"));
  }
  if (fields.bits == nullptr && (fields.chipRate != nullptr || fields.code != nullptr)) {
    return fails(error, fields.code != nullptr ? "code" : "chip_rate_hz", PSTR("to stand beside bits"));
  }
  if (fields.unmodulated != nullptr && strcmp(fields.unmodulated, "true") != 0) {
    return fails(error, "unmodulated", PSTR("true"));
  }
  if ((fields.frequency != nullptr && !readPulses(fields, clock, read, error)) ||
      (fields.bits != nullptr && !readWord(fields, clock, read, error))) {
    return false;
  }
  program = read;
  return true;
}
