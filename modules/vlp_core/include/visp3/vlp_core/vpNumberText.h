/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpNumberText_h
#define vpNumberText_h

#include <string>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! The shortest decimal text that reads back as the very same number, whatever the locale.
VISP_EXPORT std::string vpNumberText(double value);

//! The shortest text in degrees for an angle in radians, so that text * pi / 180 is that angle again.
VISP_EXPORT std::string vpDegreesText(double radians);

/*!
  Reads a decimal number, whatever the locale. False where \e text is anything else than one number with
  blanks around it, or a number that a double cannot hold. Infinities and NaN are read too: a caller that
  needs a finite number has to check.
*/
VISP_EXPORT bool vpParseNumber(const std::string &text, double &value);

//! \e text cut to 80 characters and with control characters escaped, so that a message stays one line.
VISP_EXPORT std::string vpShown(const std::string &text);

END_VISP_NAMESPACE

#endif
