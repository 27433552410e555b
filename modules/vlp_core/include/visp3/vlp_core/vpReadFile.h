/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpReadFile_h
#define vpReadFile_h

#include <string>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  The bytes of a file. \throw vpException (ioError) with one line: `lamps.yaml: cannot be opened: No such file
  or directory`.
*/
VISP_EXPORT std::string vpReadFile(const std::string &filename);

END_VISP_NAMESPACE

#endif
