/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// As ViSP has its modules' tests: a longer lamp tells its frequency better.

#include <cstdlib>

#include <visp3/vlp_identification/vpStripePrediction.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

int main()
{
  vpVlpRig rig;
  rig.width = 800;
  rig.height = 600;
  rig.camera.initPersProjWithoutDistortion(500, 500, 399.5, 299.5);
  rig.shutter.rowTime = 43e-6;
  rig.shutter.exposure = 43e-6;
  const vpStripePrediction prediction(rig);
  return prediction.lines(0.2, 1) > prediction.lines(0.2, 2) ? EXIT_SUCCESS : EXIT_FAILURE;
}
