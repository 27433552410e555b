/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampChart_h
#define vpLampChart_h

#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <visp3/core/vpImage.h>
#include <visp3/vlp_identification/vpLedDetector.h>

BEGIN_VISP_NAMESPACE

//! What was read of a lamp-like region that blinks and has no id: a person sees by it why.
struct vpLampChart {
  size_t lamp = 0;                  // index into the observations
  std::vector<double> time;         // s, of each line of the region, after the start of the frame
  std::vector<double> light;        // of each line, as of vpLedDetector::profile()
  std::vector<double> fitted;       // the same of the wave that was fitted; empty where there is none
  std::vector<std::string> caption; // the exposure that the rig claims and the one that the stripes show

  //! Dots for the light of each line, a line for the fitted wave, over time, on a black ground. \param unit
  //! As of vpTextBlock.
  cv::Mat draw(double unit) const;
};

/*!
  Charts of the three largest regions that blink and have no id: those whose signal is not unmodulated, and
  those of three lines or more with a modulation depth of 5 % or more. The fitted wave is o + e(t) S(t): S is
  the lit share that the features say (vpLitShareOf()), o and the envelope e, a polynomial of order 4 or less,
  come from least squares.
*/
std::vector<vpLampChart> vpLampChartsOf(const vpImage<unsigned char> &I,
                                        const std::vector<vpLampObservation> &observations,
                                        const vpLedDetector &detector);

END_VISP_NAMESPACE

#endif
