/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpBlinkingLight_h
#define vpBlinkingLight_h

#include <optional>
#include <vector>

#include <opencv2/core.hpp>
#include <visp3/vlp_detection/vpLedRoiDetector.h>
#include <visp3/vlp_detection/vpOutlineFitter.h>

BEGIN_VISP_NAMESPACE

/*!
  The whole of a light that blinks in a known way, freed of its stripes.

  All parts of one lamp are exposed at the same time and have one modulation. So where the modulation
  of a part of a lamp is known, the rest of it is the light by which lit lines exceed the dark lines beside
  them. Means over lit lines show light that no single pixel does; what shines steadily, or blinks otherwise,
  is not in them.
*/
class VISP_EXPORT vpBlinkingLight
{
public:
  //! A lamp as a region, its chords on lit lines, with its outline.
  struct Extent {
    vpLedRoi roi;
    vpOutlineFit fit;
  };

  /*!
    How much of the light in \e box, above that of its darkest lines, is on the lines on which the lamp is
    lit: 1 as much as if all of it blinked so, 0 no more than chance has. \param lit As below.
  */
  static double share(const cv::Mat_<unsigned char> &lines, const std::vector<float> &lit,
                      const cv::Rect &box);

  /*!
    The light that blinks as a part of a lamp does and is connected with it, across dark patches of up to a
    quarter of the part's size. \param lines The picture as its sensor read it. \param lit Of each line, the
    light of the lamp as a share of its most. \param seed The part. \param others Boxes of other lamps, whose
    light does not count. \return Nothing where that has no shape of a lamp.
  */
  static std::optional<Extent> about(const cv::Mat_<unsigned char> &lines, const std::vector<float> &lit,
                                     const vpLedRoi &seed, const std::vector<cv::Rect> &others);
};

END_VISP_NAMESPACE

#endif
