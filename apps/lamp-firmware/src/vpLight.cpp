/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLight.h"

#include <avr/interrupt.h>
#include <avr/io.h>
#include <util/atomic.h>
#include <util/delay.h>

namespace
{
vpLampEdges edges;
volatile uint8_t next = 0;  // edge
volatile bool came = false; // an edge, since somebody asked
const uint8_t pin = 1 << PB1;
const uint8_t setOnMatch = (1 << COM1A1) | (1 << COM1A0), clearOnMatch = 1 << COM1A1, toggle = 1 << COM1A0;

//! The pin by hand, the timer's hands off it.
void hold()
{
  TIMSK1 = 0;
  PORTB |= pin;
  TCCR1A = 0;
  TCCR1B = 0;
  next = 0;
  edges.count = 0;
}

//! Timer 1 as PWM (mode 14): lit from the start of a period.
void pulse(uint16_t top, uint16_t lit)
{
  TCNT1 = 0;
  OCR1A = lit - 1; // at once, as long as the mode is another
  TCCR1A = clearOnMatch | (1 << WGM11);
  TCCR1B = (1 << WGM13) | (1 << WGM12);
  ICR1 = top; // is ignored in other modes
  TCCR1B |= 1 << CS10;
}

//! Timer 1 runs freely (mode 0), its first match lights the lamp.
void follow()
{
  static const uint16_t soon = 1000; // cycles
  TCNT1 = 0;
  OCR1A = soon;
  TCCR1A = setOnMatch;
  TIFR1 = 1 << OCF1A;
  TIMSK1 = 1 << OCIE1A;
  TCCR1B = 1 << CS10;
}
} // namespace

//! The edge is made; says when the next one is.
ISR(TIMER1_COMPA_vect)
{
  const uint8_t now = next;
  OCR1A += edges.cycles[now];
  TCCR1A = toggle;
  next = now + 1 < edges.count ? now + 1 : 0;
  came = true;
}

void vpLight::start()
{
  static const uint16_t period = 8192, steps = 64; // cycles; of half a millisecond
  DDRB |= pin;
  pulse(period - 1, 1);
  for (uint16_t step = 1; step < steps; ++step) {
    _delay_ms(0.5);
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE)
    {
      OCR1A = step * (period / steps);
    }
  }
  hold();
}

void vpLight::send(const vpLampProgram &program)
{
  vpLampEdges told;
  told.count = 0;
  const bool follows = program.kind >= vpLampProgram::twoPulse && told.of(program);
  ATOMIC_BLOCK(ATOMIC_RESTORESTATE)
  {
    hold();
    if (program.kind == vpLampProgram::onePulse) {
      pulse(program.top, program.lit);
    } else if (follows) {
      edges = told;
      follow();
    }
  }
}

bool vpLight::isAlive()
{
  const bool alive = edges.count == 0 || came;
  came = false;
  return alive;
}
