/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpStore_h
#define vpStore_h

#include "vpLampProgram.h"

/*!
  The program in the EEPROM, twice: the older copy is written over, and counts only once it is whole and its
  checksum right. Power may go at any time: what is left is the program before or the one after.
*/
namespace vpStore
{
//! The newest whole program; false: none, and it is cleared.
bool load(vpLampProgram &program);
//! \param wait Is called from byte to byte, each of which takes 3.4 ms. \return Whether it reads back.
bool save(const vpLampProgram &program, void (*wait)());
} // namespace vpStore

#endif
