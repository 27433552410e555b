/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPlanOptions_h
#define vpPlanOptions_h

#include <cmath>
#include <string>
#include <vector>

#include <visp3/vlp_identification/vpLedIdPlanner.h>

BEGIN_VISP_NAMESPACE

//! What the command line of vlp-plan says; a name that is empty was not given.
struct vpPlanOptions {
  std::string rig;
  std::string check; // a lamp map to judge, instead of planning one
  std::string place; // where the lamps hang: a lamp map, or a CSV of positions
  std::string out;   // a lamp map
  std::string picture;
  double lowest = std::nan(""), highest = std::nan(""); // m, of the lamps above the camera; NaN: not given
  double diameter = std::nan("");                       // m; NaN: not given
  double oscillatorPpm = 50;
  double clock = 0;                 // Hz, of the lamps' timers; 0: any frequency can be made
  std::string timers;               // kind of them, whose registers are printed; empty: none
  size_t lamps = 0;                 // 0: as many as there is room for
  size_t reuse = 0;                 // identifiers for all lamps of the place; 0: each its own
  double viewRadius = std::nan(""); // m, of what one picture shows of the ceiling; NaN: as the rig says
  double error = 1e-3;
  double snrDb = 20;
  std::vector<double> duties = {0.2, 0.5, 0.8};
  double lowestFrequency = std::nan(""), highestFrequency = std::nan(""); // Hz; NaN: not given
  bool words = false;
  vpWordScheme format;
  size_t worst = 10; // pairs of --check to print

  //! \return False where the help was asked for and is printed. \throw vpException on bad usage.
  bool parse(int argc, char **argv);

  //! The planner of that rig with the settings given here.
  vpLedIdPlanner planner(const vpVlpRig &rig) const;

private:
  void checkTogether(bool wordSettings) const;
};

END_VISP_NAMESPACE

#endif
