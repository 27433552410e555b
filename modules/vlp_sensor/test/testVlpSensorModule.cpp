/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// As ViSP has its modules' tests: a picture that is not there is named in the error.

#include <cstdlib>
#include <string>

#include <visp3/core/vpException.h>
#include <visp3/vlp_sensor/vpPictureSequence.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

int main()
{
  try {
    vpPictureSequence::fromRun("no-such-folder");
  } catch (const vpException &error) {
    return std::string(error.getStringMessage()).find("no-such-folder") != std::string::npos ? EXIT_SUCCESS
                                                                                             : EXIT_FAILURE;
  }
  return EXIT_FAILURE;
}
