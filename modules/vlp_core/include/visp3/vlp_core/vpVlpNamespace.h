/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpVlpNamespace_h
#define vpVlpNamespace_h

/*!
  \file vpVlpNamespace.h
  ViSP from 3.7 on can wrap everything in a namespace; ViSP 3.5 does not. With this header the same
  source compiles in both.
*/

#include <visp3/core/vpConfig.h>

#ifndef BEGIN_VISP_NAMESPACE
#define BEGIN_VISP_NAMESPACE
#define END_VISP_NAMESPACE
#endif

#endif
