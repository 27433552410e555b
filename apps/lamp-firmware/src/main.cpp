/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// A lamp of an Arduino Nano or Uno: what it sends is told once over its serial port, and kept. README.md says
// how.

#include <avr/interrupt.h>
#include <avr/pgmspace.h>
#include <avr/wdt.h>
#include <string.h>

#include "vpLight.h"
#include "vpSerial.h"
#include "vpStore.h"

namespace
{
vpLampProgram program;

//! The watchdog starts the controller anew where it is not fed for a second.
void feed()
{
  if (vpLight::isAlive()) {
    wdt_reset();
  }
}

void writeField(const char *name, const char *value)
{
  vpSerial::writeFlash(name);
  vpSerial::write(value);
}

void writeRate(const char *name)
{
  vpSerial::writeFlash(name);
  vpSerial::writeDecimal((1000ull * F_CPU + program.cycles() / 2) / program.cycles(), 3);
}

void writeShare(const char *name, uint32_t of)
{
  vpSerial::writeFlash(name);
  vpSerial::writeDecimal((1000000ull * of + program.cycles() / 2) / program.cycles(), 6);
}

//! What is sent, to the cycle.
void show()
{
  vpSerial::writeFlash(PSTR("lamp"));
  if (program.id[0] != 0) {
    writeField(PSTR(" id="), program.id);
  }
  switch (program.kind) {
  case vpLampProgram::unmodulated:
    vpSerial::writeFlash(PSTR(" unmodulated=true"));
    break;
  case vpLampProgram::word:
    writeField(PSTR(" bits="), program.bits);
    writeRate(PSTR(" chip_rate_hz="));
    vpSerial::writeFlash(program.code == vpLampProgram::manchester ? PSTR(" code=manchester")
                                                                   : PSTR(" code=ook"));
    break;
  default: {
    const bool two = program.kind == vpLampProgram::twoPulse;
    writeRate(PSTR(" frequency_hz="));
    writeShare(PSTR(" duty="), two ? 2ul * program.lit : program.lit);
    if (two) {
      writeShare(PSTR(" phase_difference="), program.apart);
    }
  }
  }
  vpSerial::writeFlash(PSTR(" clock_hz="));
  vpSerial::writeNumber(F_CPU);
  vpSerial::writeFlash(PSTR("\r\n"));
}

void fail(const char *field, const char *expected)
{
  vpSerial::writeFlash(PSTR("error "));
  vpSerial::write(field);
  vpSerial::writeFlash(PSTR(": expected "));
  vpSerial::writeFlash(expected);
  vpSerial::writeFlash(PSTR("\r\n"));
}

void set(char *fields)
{
  vpLampProgram told;
  vpLampError error;
  if (!vpReadLampProgram(fields, F_CPU, told, error)) {
    fail(error.field, error.expected);
  } else if (!vpStore::save(told, feed)) {
    fail("set", PSTR("an EEPROM that keeps what is written to it"));
  } else {
    program = told;
    vpLight::send(program);
    show();
  }
}

void answer(char *line, bool whole)
{
  char *const fields = line + strcspn(line, " \t");
  const bool more = *fields != 0;
  *fields = 0;
  if (!whole) {
    fail("line", PSTR("up to 159 characters"));
  } else if (strcmp_P(line, PSTR("set")) == 0 && more) {
    set(fields + 1);
  } else if (strcmp_P(line, PSTR("show")) == 0 && !more) {
    show();
  } else {
    fail("line",
         PSTR("show, or set with frequency_hz=2270 duty=0.6, with bits=0111 chip_rate_hz=8000 code=ook, "
              "or with unmodulated=true"));
  }
}
} // namespace

int main()
{
  wdt_enable(WDTO_1S);
  vpSerial::start();
  sei();
  vpLight::start();
  vpStore::load(program);
  vpLight::send(program);
  for (;;) {
    feed();
    bool whole;
    if (char *line = vpSerial::line(whole)) {
      answer(line, whole);
      vpSerial::done();
    }
  }
}

//! After a watchdog's reset it still runs, and shorter than main() takes to reach it.
extern "C" void stopWatchdog() __attribute__((naked, used, section(".init3")));
void stopWatchdog()
{
  MCUSR = 0;
  wdt_disable();
}
