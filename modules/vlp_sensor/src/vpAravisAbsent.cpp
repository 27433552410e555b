/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpCameraKinds.h"

BEGIN_VISP_NAMESPACE

vpCameraKind vpAravisKind()
{
  return {"aravis", "libaravis-dev", nullptr, nullptr};
}

END_VISP_NAMESPACE
