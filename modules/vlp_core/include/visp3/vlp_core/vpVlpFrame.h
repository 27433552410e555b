/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpVlpFrame_h
#define vpVlpFrame_h

#include <string>

#include <visp3/core/vpImage.h>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! A timed grey picture.
struct VISP_EXPORT vpVlpFrame {
  vpImage<unsigned char> I;
  double timestamp = 0; // s, start of exposure of the sensor's first line
  std::string name;     // file or frame number, for messages
};

END_VISP_NAMESPACE

#endif
