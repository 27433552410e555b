/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// As ViSP has its modules' tests: how far a place is off a line.

#include <cmath>
#include <cstdlib>

#include <visp3/vlp_servo/vpPath.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

int main()
{
  const vpPath path = vpPath::polyline({{0, 0}, {1, 0}});
  const Eigen::Vector2d place(0.4, 0.1);
  const double s = path.closest(place);
  return std::abs(s - 0.4) < 1e-6 && std::abs(std::abs(path.offset(place, s)) - 0.1) < 1e-9 ? EXIT_SUCCESS
                                                                                            : EXIT_FAILURE;
}
