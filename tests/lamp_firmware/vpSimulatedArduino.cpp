/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpSimulatedArduino.h"

#include <stdexcept>

extern "C" {
#include <simavr/avr_eeprom.h>
#include <simavr/avr_ioport.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>
}

namespace
{
const unsigned int OCIE1A = 2; // mask
} // namespace

vpSimulatedArduino::vpSimulatedArduino(const std::string &firmware, const Eeprom &eeprom)
    : m_avr(avr_make_mcu_by_name("atmega328p"))
{
  avr_global_logger_set([](avr_t *, const int, const char *, va_list) {});
  elf_firmware_t read = {};
  if (m_avr == nullptr || elf_read_firmware(firmware.c_str(), &read) != 0) {
    throw std::runtime_error(firmware + ": expected a firmware for the ATmega328P");
  }
  avr_init(m_avr);
  m_avr->frequency = static_cast<uint32_t>(clock);
  avr_load_firmware(m_avr, &read);
  Eeprom copy = eeprom;
  avr_eeprom_desc_t all{copy.data(), 0, static_cast<uint32_t>(copy.size())};
  avr_ioctl(m_avr, AVR_IOCTL_EEPROM_SET, &all);
  uint32_t none = 0; // neither echoed nor slowed to real time
  avr_ioctl(m_avr, AVR_IOCTL_UART_SET_FLAGS('0'), &none);
  avr_irq_register_notify(
      avr_io_getirq(m_avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT),
      [](avr_irq_t *, uint32_t value, void *self) {
        static_cast<vpSimulatedArduino *>(self)->m_heard += static_cast<char>(value);
      },
      this);
  static const int pin = 1; // of port B: D9
  avr_irq_register_notify(
      avr_io_getirq(m_avr, AVR_IOCTL_IOPORT_GETIRQ('B'), pin),
      [](avr_irq_t *, uint32_t value, void *self) {
        static_cast<vpSimulatedArduino *>(self)->pinIs(value != 0);
      },
      this);
}

vpSimulatedArduino::~vpSimulatedArduino()
{
  avr_terminate(m_avr);
}

uint64_t vpSimulatedArduino::now() const
{
  return m_avr->cycle;
}

bool vpSimulatedArduino::run(double seconds)
{
  const uint64_t end = now() + static_cast<uint64_t>(seconds * clock);
  while (now() < end) {
    const int state = avr_run(m_avr);
    if (state == cpu_Done || state == cpu_Crashed) {
      return false;
    }
  }
  return true;
}

void vpSimulatedArduino::say(const std::string &text)
{
  static const double bits = 10.5; // of a byte, with its start, its stop and a pause
  for (char c : text) {
    avr_raise_irq(avr_io_getirq(m_avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT), static_cast<uint8_t>(c));
    run(bits / baud);
  }
}

std::string vpSimulatedArduino::ask(const std::string &line)
{
  m_heard.clear();
  say(line + "\n");
  for (int ms = 0; ms < 1000 && m_heard.find('\n') == std::string::npos; ++ms) {
    run(1e-3);
  }
  return m_heard.substr(0, m_heard.find("\r\n"));
}

vpSimulatedArduino::Eeprom vpSimulatedArduino::eeprom() const
{
  avr_eeprom_desc_t all{nullptr, 0, static_cast<uint32_t>(blank().size())};
  avr_ioctl(m_avr, AVR_IOCTL_EEPROM_GET, &all);
  return {all.ee, all.ee + all.size};
}

unsigned int vpSimulatedArduino::byte(uint16_t address) const
{
  return m_avr->data[address];
}

void vpSimulatedArduino::poke(uint16_t address, uint8_t value)
{
  m_avr->data[address] = value;
}

void vpSimulatedArduino::pinIs(bool lit)
{
  if (lit == m_lit) {
    return; // told twice, by the timer and by the port
  }
  m_lit = lit;
  uint64_t at = now();
  if ((byte(TIMSK1) & OCIE1A) != 0) {
    const auto sinceMatch = static_cast<uint16_t>(at - word(OCR1A)); // and what the counter began with
    if (edges.empty()) {
      m_counterBegan = sinceMatch;
    }
    at -= static_cast<uint64_t>(static_cast<int16_t>(sinceMatch - m_counterBegan));
  }
  edges.push_back({at, lit});
}
