// A stranger's program: it compiles, links and runs with nothing but the installed package.
#include <iostream>

#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_core/vpVlpRig.h>
#include <visp3/vlp_localization/vpTwoLampSolver.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

int main()
{
  vpLampMap map;
  map.lamps.resize(1);
  map.lamps[0].id = "A";
  const vpVlpFix fix = vpTwoLampSolver().solveBestPair({}, vpVlpRig());
  std::cout << "no position: " << fix.refusal << std::endl;
  return map.find("A") != nullptr && !fix.valid ? 0 : 1;
}
