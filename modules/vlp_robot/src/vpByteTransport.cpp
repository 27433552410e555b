/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_robot/vpByteTransport.h>

#include <chrono>

BEGIN_VISP_NAMESPACE

double vpByteTransport::now() const
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

END_VISP_NAMESPACE
