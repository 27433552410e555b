/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpHtmlReport_h
#define vpHtmlReport_h

#include <string>
#include <vector>

#include <visp3/vlp_evaluation/vpEvaluation.h>
#include <visp3/vlp_evaluation/vpReportTable.h>

BEGIN_VISP_NAMESPACE

//! What is shown of one figure.
struct VISP_EXPORT vpReportFigure {
  std::string name; // letters, digits and dashes
  std::string caption;
  std::string svg; // as vpFigure::svg
};

//! A number that a page shows large.
struct VISP_EXPORT vpReportTile {
  std::string value;
  std::string meaning;
};

/*!
  One HTML page, well-formed as XML too, that holds the tables and figures and refers to nothing outside of
  it. \param title Any text, and so are the names of the files. \param sources Lines that state where the data
  come from.
*/
VISP_EXPORT std::string vpHtmlReport(const std::string &title, const std::vector<std::string> &sources,
                                     const vpEvaluation &evaluation,
                                     const std::vector<vpReportFigure> &figures);

//! Such a page of anything: tiles, figures and tables.
VISP_EXPORT std::string vpHtmlPage(const std::string &title, const std::vector<std::string> &sources,
                                   const std::vector<vpReportTile> &tiles,
                                   const std::vector<vpReportFigure> &figures,
                                   const std::vector<vpReportTable> &tables);

END_VISP_NAMESPACE

#endif
