/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_evaluation/vpFixLog.h>

#include "fuzz/vpFuzzTarget.h"

VLP_FUZZ_TARGET(fixes)
{
  const std::string file = vpFuzzFile("fixes.csv", data, size);
  vpFuzzReads([&] { vpFixLog::load(file); });
}
