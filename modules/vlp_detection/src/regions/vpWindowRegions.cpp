/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// vpLedRoiDetector::detect() in a window of a picture.

#include <visp3/vlp_detection/vpLedRoiDetector.h>

#include <algorithm>

#include "vpBackground.h"
#include "vpChordShape.h"
#include "vpDemodulation.h"

BEGIN_VISP_NAMESPACE

namespace
{

//! Moves a region found in a window to its place in the picture.
void moveTo(vpLedRoi &roi, const cv::Point &origin, const cv::Size &picture)
{
  roi.box += origin;
  for (vpLedChord &chord : roi.chords) {
    chord.line += origin.y;
    chord.first += origin.x;
    chord.last += origin.x;
  }
  vpChordShape::markCuts(roi, picture);
}

//! Larger by as much as the regions that its sides may cut, on these sides. Itself where there are none.
cv::Rect grownAround(const cv::Rect &window, const std::vector<vpLedRoi> &rois, const cv::Rect &picture,
                     double longestPeriod)
{
  cv::Rect grown = window;
  for (const vpLedRoi &roi : rois) {
    // A dark stripe may part a lamp from the rest that lies beyond the window.
    const int gap = roi.steady ? 0 : 1 + static_cast<int>(std::min(0.5 * roi.box.width, longestPeriod));
    const int side = std::max(roi.box.width, roi.box.height);
    const cv::Point before(roi.box.x <= window.x ? side : 0, roi.box.y <= window.y + gap ? side : 0),
        after(roi.box.br().x >= window.br().x ? side : 0, roi.box.br().y >= window.br().y - gap ? side : 0);
    grown |= cv::Rect(roi.box.tl() - before, roi.box.br() + after);
  }
  return grown & picture;
}

} // namespace

std::vector<vpLedRoi> vpLedRoiDetector::detect(const cv::Mat_<unsigned char> &lines, const cv::Rect &window,
                                               const std::vector<cv::Rect> &known) const
{
  static const int mostRounds = 10; // each about twice as far; then the whole picture is looked at
  const cv::Rect picture(0, 0, lines.cols, lines.rows);
  cv::Rect looked = window & picture;
  std::vector<vpLedRoi> rois;
  for (int round = 1; looked.area() > 0; ++round) {
    std::vector<cv::Rect> knownThere = known;
    for (cv::Rect &box : knownThere) {
      box -= looked.tl();
    }
    // As much beside it tells what is dark: what is asked for may fill it.
    const cv::Rect beside = vpGrown(looked, std::max(looked.width, looked.height) / 2) & picture;
    rois = detect(lines(looked), vpBackground::of(vpPictureBlock::of(lines(beside))), knownThere);
    for (vpLedRoi &roi : rois) {
      moveTo(roi, looked.tl(), picture.size());
    }
    // What came into view by looking farther was not asked for, and may be cut.
    rois.erase(std::remove_if(rois.begin(), rois.end(),
                              [&window](const vpLedRoi &roi) { return (roi.box & window).area() == 0; }),
               rois.end());
    const cv::Rect grown = grownAround(looked, rois, picture, longestPeriod);
    if (grown == looked) {
      break;
    }
    looked = round < mostRounds ? grown : picture;
  }
  return rois;
}

END_VISP_NAMESPACE
