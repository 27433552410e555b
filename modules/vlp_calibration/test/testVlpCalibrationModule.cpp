/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// As ViSP has its modules' tests: a board of a size that no board has is refused.

#include <cstdlib>

#include <visp3/core/vpException.h>
#include <visp3/vlp_calibration/vpBoard.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

int main()
{
  vpBoard board;
  board.columns = 0;
  try {
    board.check();
  } catch (const vpException &) {
    return EXIT_SUCCESS;
  }
  return EXIT_FAILURE;
}
