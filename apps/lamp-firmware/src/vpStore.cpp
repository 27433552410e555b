/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpStore.h"

#include <avr/eeprom.h>
#include <string.h>
#include <util/crc16.h>

namespace
{
struct Copy {
  uint8_t number; // of the save, counted up; written last
  vpLampProgram program;
  uint16_t checksum; // of the program and the number
};

Copy EEMEM copies[2];
const uint8_t none = 0xff; // the number of a copy that is being written, and of a new controller's

uint16_t checksumOf(const Copy &copy)
{
  uint16_t sum = 0xffff;
  const uint8_t *byte = reinterpret_cast<const uint8_t *>(&copy.program);
  for (uint8_t k = 0; k < sizeof copy.program; ++k) {
    sum = _crc_ccitt_update(sum, byte[k]);
  }
  return _crc_ccitt_update(sum, copy.number);
}

bool read(uint8_t which, Copy &copy)
{
  eeprom_read_block(&copy, &copies[which], sizeof copy);
  return copy.number != none && copy.checksum == checksumOf(copy);
}

uint8_t after(uint8_t number)
{
  return number + 1 == none ? 0 : number + 1;
}

//! The number of the copy to go by: 0, 1, or -1 for neither.
int8_t newest(Copy &copy)
{
  Copy other;
  const bool first = read(0, other), second = read(1, copy);
  if (first && second) {
    if (other.number != after(copy.number)) {
      return 1;
    }
    copy = other;
    return 0;
  }
  if (first) {
    copy = other;
  }
  return first ? 0 : second ? 1 : -1;
}
} // namespace

bool vpStore::load(vpLampProgram &program)
{
  Copy copy;
  if (newest(copy) < 0) {
    program.clear();
    return false;
  }
  program = copy.program;
  return true;
}

bool vpStore::save(const vpLampProgram &program, void (*wait)())
{
  Copy copy;
  const int8_t old = newest(copy);
  const uint8_t which = old == 0 ? 1 : 0;
  const uint8_t number = old < 0 ? 0 : after(copy.number);
  copy.number = number;
  copy.program = program;
  copy.checksum = checksumOf(copy);
  uint8_t *const there = reinterpret_cast<uint8_t *>(&copies[which]);
  const uint8_t *const here = reinterpret_cast<const uint8_t *>(&copy);
  eeprom_update_byte(there, none);
  for (uint8_t k = 1; k < sizeof copy; ++k) {
    wait();
    eeprom_update_byte(there + k, here[k]);
  }
  wait();
  eeprom_update_byte(there, number);
  Copy back;
  return newest(back) == which && memcmp(&back, &copy, sizeof copy) == 0;
}
