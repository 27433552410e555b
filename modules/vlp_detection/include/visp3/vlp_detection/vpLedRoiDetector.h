/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLedRoiDetector_h
#define vpLedRoiDetector_h

#include <limits>
#include <vector>

#include <opencv2/core.hpp>
#include <visp3/core/vpImage.h>
#include <visp3/core/vpRect.h>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

struct vpBackground;

/*!
  A picture as its sensor read it: row y of the matrix is line y, whatever direction the readout runs in.
  Pictures read along columns are transposed, so that all detection works along rows; u and v swap on the way
  in and out.
*/
struct VISP_EXPORT vpLinePicture {
  cv::Mat_<unsigned char> grey; // lines x samples; a view of the picture where the readout runs along rows
  bool transposed = false;

  vpLinePicture() = default;
  vpLinePicture(const vpImage<unsigned char> &I, bool alongColumns);
};

//! The lit stretch of one line: samples first to last, both lit.
struct VISP_EXPORT vpLedChord {
  int line = 0;
  int first = 0;
  int last = 0;
};

/*!
  A region of interest that may hold a lamp (LED-ROI): its chords, one a lit line, in line order. Coordinates
  are lines and samples of a vpLinePicture.
*/
struct VISP_EXPORT vpLedRoi {
  std::vector<vpLedChord> chords;
  cv::Rect box;           // x: samples, y: lines
  double level = 0;       // grey value that its pixels exceed
  double lampness = 0;    // 0 to 1: how much the chords look like one whole lamp
  bool even = false;      // no strip of its samples dips from line to line: one stripe, or steady light
  bool steady = false;    // shines on end for longer than any lamp
  bool cutAcross = false; // touches the first or last sample
  bool cutAlong = false;  // touches the first or last line, or may go on beyond it after a dark stripe

  //! The lines of the chords' convex hull, of its dark stripes as well.
  std::vector<vpLedChord> hull() const;
};

/*!
  Finds lamp-like regions over a whole picture, without a fixed threshold.

  Grey levels rise in a geometric series from the picture's own noise floor. At each level the pixels above it
  form stripes (connected regions), and stripes that face each other across a dark gap form groups: lamps,
  where dark stripes cut them into pieces. A lamp is convex: a group with a waist is cut there where its parts
  make better lamps. Groups of neighbouring levels nest into a tree. From the tree come the regions whose
  light falls off at their ends by more than noise would, and whose chords look most like one whole lamp:
  convex, on an ellipse or a quadrilateral, with a sharp edge. So a dim lamp beside a bright one and lamps
  joined by their halos all get the level that suits them. The ceiling is such a region too, where it is
  brighter than the darkest part of the picture, and may have the shape of a lamp; it does not blink as the
  lamps in front of it do, and these are chosen then. Parts of a larger region are left out at the end. In a
  whole picture the light of an uneven ceiling is taken off first: it rises by more than a dim lamp does. What
  shines on for longer than a period of the slowest lamp, and dips in no strip of its samples as a lamp does,
  is steady: it is not taken apart, and nothing is looked for in it. Nor is it in one stripe without a dip,
  which tells no period. Where noise is so strong that single pixels do not show a lamp, means of several
  along the lines are used as well.
*/
class VISP_EXPORT vpLedRoiDetector
{
public:
  double levelRatio = 1.4; // between neighbouring levels, measured from the background
  double noiseFactor = 4;  // lowest level, in standard deviations of the noise above the background
  double maxDarkGap = 0.6; // longest dark gap inside a lamp, as a share of its widest chord
  //! lines, of the slowest lamp there may be: no stripe of any, lit or dark, is longer.
  double longestPeriod = std::numeric_limits<double>::infinity();
  int minWidth = 8;       // samples
  int minHeight = 6;      // lines
  double minContrast = 3; // grey levels, lowest level above the background

  std::vector<vpLedRoi> detect(const cv::Mat_<unsigned char> &lines) const;

  /*!
    The same of all regions that \e window (x: samples, y: lines) shows a part of. Where its sides may cut
    one, a larger one is looked at. \param known Boxes of what is known already: regions inside are left out.
  */
  std::vector<vpLedRoi> detect(const cv::Mat_<unsigned char> &lines, const cv::Rect &window,
                               const std::vector<cv::Rect> &known = {}) const;

  /*!
    Where a window shows other light than that of known lamps. Light is three samples in a row that exceed the
    window's median by 8 grey levels and by six standard deviations of the noise. \param known Boxes that are
    left out, px. \param noise Grey levels. \param found Takes boxes, px, of light that is near to each other.
  */
  static void otherLight(const vpImage<unsigned char> &I, const vpRect &window,
                         const std::vector<vpRect> &known, double noise, std::vector<vpRect> &found);

private:
  std::vector<vpLedRoi> detect(const cv::Mat_<unsigned char> &lines, const vpBackground &dark,
                               const std::vector<cv::Rect> &known) const;
  std::vector<vpLedRoi> lampsOf(const cv::Mat_<unsigned char> &lines, const vpBackground &dark,
                                const std::vector<cv::Rect> &known) const;
  double lowest(const vpBackground &dark) const; // grey levels above the background
};

END_VISP_NAMESPACE

#endif
