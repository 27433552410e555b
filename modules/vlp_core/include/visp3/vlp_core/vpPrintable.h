/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPrintable_h
#define vpPrintable_h

#include <cstddef>
#include <string>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  \e text as a part of one line, for names and ids that come from outside. Escaped as `\x1b`, byte by byte:
  control characters, those of C1 too, which some terminals obey; the Unicode characters that end a line or
  turn the direction of text; bytes that are no UTF-8.
*/
VISP_EXPORT std::string vpPrintable(const std::string &text);

//! Bytes of the UTF-8 character that begins at byte \e i of \e text; 0 where none does.
VISP_EXPORT size_t vpUtf8Length(const std::string &text, size_t i);

END_VISP_NAMESPACE

#endif
