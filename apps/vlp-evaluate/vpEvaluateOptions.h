/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpEvaluateOptions_h
#define vpEvaluateOptions_h

#include <string>
#include <vector>

#include <visp3/vlp_evaluation/vpEvaluation.h>

BEGIN_VISP_NAMESPACE

//! What the command line of vlp-evaluate says; a name that is empty was not given.
struct vpEvaluateOptions {
  std::string truth;
  std::string estimate; // this or fixes is given, or both
  std::string fixes;
  std::vector<std::string> runs; // folders of vlp-servo, instead of the three above
  std::string out;               // a folder
  std::string title;
  vpEvaluationSettings settings;

  //! \return False where the help was asked for and is printed. \throw vpException on bad usage.
  bool parse(int argc, char **argv);

  //! The file that the poses come from.
  const std::string &poses() const { return estimate.empty() ? fixes : estimate; }
};

END_VISP_NAMESPACE

#endif
