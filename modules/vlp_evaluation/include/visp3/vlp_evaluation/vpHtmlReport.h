/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpHtmlReport_h
#define vpHtmlReport_h

#include <string>
#include <vector>

#include <visp3/vlp_evaluation/vpEvaluation.h>

BEGIN_VISP_NAMESPACE

//! What is shown of one figure.
struct VISP_EXPORT vpReportFigure {
  std::string name; // letters, digits and dashes
  std::string caption;
  std::string svg; // as vpFigure::svg
};

/*!
  One HTML page, well-formed as XML too, that holds the tables and figures and refers to nothing outside of
  it. \param title Any text, and so are the names of the files. \param sources Lines that say where the data
  come from.
*/
VISP_EXPORT std::string vpHtmlReport(const std::string &title, const std::vector<std::string> &sources,
                                     const vpEvaluation &evaluation,
                                     const std::vector<vpReportFigure> &figures);

END_VISP_NAMESPACE

#endif
