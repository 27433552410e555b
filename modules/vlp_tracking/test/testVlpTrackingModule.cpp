/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// As ViSP has its modules' tests: a bright square that moves is followed.

#include <cmath>
#include <cstdlib>

#include <visp3/vlp_tracking/vpCamshiftKalmanTracker.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

int main()
{
  vpCamshiftKalmanTracker tracker;
  vpImage<unsigned char> I(200, 200);
  for (int k = 0; k < 10; ++k) {
    const unsigned int left = 60 + 3 * static_cast<unsigned int>(k);
    I = 10;
    for (unsigned int v = 80; v < 120; ++v) {
      for (unsigned int u = left; u < left + 40; ++u) {
        I[v][u] = 220;
      }
    }
    const vpRect window(left, 80, 40, 40);
    if (k == 0) {
      tracker.initTracking(I, window);
    } else if (!tracker.track(I)) {
      return EXIT_FAILURE;
    }
  }
  return std::abs(tracker.window().getCenter().get_u() - (60 + 27 + 20)) < 3 ? EXIT_SUCCESS : EXIT_FAILURE;
}
