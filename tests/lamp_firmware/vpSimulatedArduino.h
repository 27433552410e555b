/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpSimulatedArduino_h
#define vpSimulatedArduino_h

#include <cstdint>
#include <string>
#include <vector>

struct avr_t;

/*!
  An Arduino Nano, 16 MHz, that runs a firmware in simavr. Pins change at the end of the instruction in which
  their timer has its match; edges that a compare interrupt follows are told by the timer's register, to the
  cycle.
*/
class vpSimulatedArduino
{
public:
  static constexpr double clock = 16e6; // Hz
  static constexpr double baud = 38400;
  static constexpr uint16_t TIMSK1 = 0x6f, TCCR1A = 0x80, TCCR1B = 0x81, ICR1 = 0x86, OCR1A = 0x88;
  using Eeprom = std::vector<uint8_t>;

  struct Edge {
    uint64_t cycle;
    bool lit;
  };
  //! Of pin D9, since they were cleared last.
  std::vector<Edge> edges;

  //! \throw std::runtime_error where the firmware cannot be read.
  explicit vpSimulatedArduino(const std::string &firmware, const Eeprom &eeprom = blank());
  vpSimulatedArduino(const vpSimulatedArduino &) = delete;
  vpSimulatedArduino &operator=(const vpSimulatedArduino &) = delete;
  ~vpSimulatedArduino();

  static Eeprom blank() { return Eeprom(1024, 0xff); }
  uint64_t now() const; // cycles
  //! \return False where it crashed.
  bool run(double seconds);
  void say(const std::string &text);
  //! Says a line and hears its answer, without line end; empty: none within a second.
  std::string ask(const std::string &line);
  const std::string &heard() const { return m_heard; }

  Eeprom eeprom() const;
  //! 8 and 16 bits of the data memory, registers included, by their address in the data sheet.
  unsigned int byte(uint16_t address) const;
  unsigned int word(uint16_t address) const { return byte(address) | byte(address + 1) << 8; }
  void poke(uint16_t address, uint8_t value);

private:
  void pinIs(bool lit);

  avr_t *m_avr;
  std::string m_heard;
  bool m_lit = false;
  uint16_t m_counterBegan = 0; // cycles, where the timer's counter was 0, modulo its range
};

#endif
