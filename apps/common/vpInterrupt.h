/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpInterrupt_h
#define vpInterrupt_h

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  Ctrl-C and SIGTERM as a flag, so that a program ends its loop and finishes what it writes.

  \code
  vpInterrupt::install();
  while (!vpInterrupt::requested()) {
    ...
  }
  \endcode
*/
class vpInterrupt
{
public:
  //! The first signal sets the flag, a second one ends the program at once. Signals that the caller of the
  //! program had ignored stay so.
  static void install();

  static bool requested();
};

END_VISP_NAMESPACE

#endif
