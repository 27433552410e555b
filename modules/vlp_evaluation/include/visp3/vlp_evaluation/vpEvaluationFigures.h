/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpEvaluationFigures_h
#define vpEvaluationFigures_h

#include <string>
#include <vector>

#include <visp3/vlp_evaluation/vpEvaluation.h>

BEGIN_VISP_NAMESPACE

//! A figure, ready to be drawn.
struct VISP_EXPORT vpFigure {
  std::string name; // of its files, without suffix: scatter, track, pmf, cdf, error-over-time
  std::string caption;
  std::string body; // gnuplot script without the terminal
  int width = 560;  // px of the SVG; the PNG has twice as many
  int height = 420;

  //! The bytes of a PNG file. \throw vpException as vpGnuplot::draw.
  std::string png() const;

  //! The text of an SVG file, which scales with the space that it is shown in.
  std::string svg() const;
};

/*!
  The paper's figures of an evaluation with one pair or more: errors with the dispersion circle, the track,
  PMF, CDF, and errors over time. Maps have axes of equal scale. Of more than 2000 points some 1000 stretches
  are shown, by their first and their worst point.
*/
VISP_EXPORT std::vector<vpFigure> vpFiguresOf(const vpEvaluation &evaluation);

END_VISP_NAMESPACE

#endif
