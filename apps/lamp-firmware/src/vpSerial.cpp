/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpSerial.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/pgmspace.h>

#define BAUD 38400
#include <util/setbaud.h>

namespace
{
const uint8_t longest = 160;
char received[longest];
volatile uint8_t length = 0;
volatile bool complete = false, cut = false;

void put(char c)
{
  while ((UCSR0A & (1 << UDRE0)) == 0) {
  }
  UDR0 = static_cast<uint8_t>(c);
}
} // namespace

ISR(USART_RX_vect)
{
  const char c = static_cast<char>(UDR0);
  if (complete) {
    return;
  }
  if (c == '\n' || c == '\r') {
    if (length > 0) {
      received[length] = 0;
      complete = true;
    }
  } else if (length < longest - 1) {
    received[length++] = c;
  } else {
    cut = true;
  }
}

void vpSerial::start()
{
  UBRR0 = UBRR_VALUE;
#if USE_2X
  UCSR0A = 1 << U2X0;
#endif
  UCSR0C = (1 << UCSZ01) | (1 << UCSZ00);
  UCSR0B = (1 << RXCIE0) | (1 << RXEN0) | (1 << TXEN0);
}

char *vpSerial::line(bool &whole)
{
  whole = !cut;
  return complete ? received : nullptr;
}

void vpSerial::done()
{
  length = 0;
  cut = false;
  complete = false;
}

void vpSerial::write(const char *text)
{
  for (; *text != 0; ++text) {
    put(*text);
  }
}

void vpSerial::writeFlash(const char *text)
{
  for (char c; (c = static_cast<char>(pgm_read_byte(text))) != 0; ++text) {
    put(c);
  }
}

void vpSerial::writeNumber(uint64_t value)
{
  writeDecimal(value, 0);
}

void vpSerial::writeDecimal(uint64_t value, uint8_t decimals)
{
  char digits[22];
  uint8_t n = 0;
  do {
    if (n == decimals && n > 0) {
      digits[n++] = '.';
      decimals = 0;
    }
    digits[n++] = static_cast<char>('0' + value % 10);
    value /= 10;
  } while (value > 0 || n <= decimals);
  while (n > 0) {
    put(digits[--n]);
  }
}
