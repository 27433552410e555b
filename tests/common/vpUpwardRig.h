/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpUpwardRig_h
#define vpUpwardRig_h

#include <visp3/vlp_core/vpVlpRig.h>

BEGIN_VISP_NAMESPACE

//! A small camera without distortion, 500 px of focal length, its lines 40 us apart and as long exposed.
inline vpVlpRig vpUpwardRig(unsigned int width, unsigned int height)
{
  vpVlpRig rig;
  rig.width = width;
  rig.height = height;
  rig.camera.initPersProjWithoutDistortion(500, 500, 0.5 * width, 0.5 * height);
  rig.shutter.rowTime = rig.shutter.exposure = 40e-6;
  rig.shutter.rowTimeSigma = 4e-9;
  return rig;
}

END_VISP_NAMESPACE

#endif
