/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpReportTable_h
#define vpReportTable_h

#include <string>
#include <vector>

#include <visp3/vlp_evaluation/vpEvaluation.h>

BEGIN_VISP_NAMESPACE

//! A table for people to read.
struct VISP_EXPORT vpReportTable {
  std::string heading;
  std::vector<std::string> columns;           // the first one names the rows
  std::vector<std::vector<std::string>> rows; // as many cells as columns
  std::string note;                           // one sentence below it, may be empty

  //! In columns of even width, for a terminal.
  std::string text() const;
};

//! The numbers of an evaluation, lengths in mm and angles in degrees. What does not apply is left out.
VISP_EXPORT std::vector<vpReportTable> vpTablesOf(const vpEvaluation &evaluation);

END_VISP_NAMESPACE

#endif
