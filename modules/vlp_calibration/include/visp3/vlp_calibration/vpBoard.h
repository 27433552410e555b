/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpBoard_h
#define vpBoard_h

#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <visp3/core/vpImage.h>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! A board in one picture: points of the board and where the picture shows them.
struct VISP_EXPORT vpBoardSight {
  std::string picture;             // name of the frame
  std::vector<cv::Point3f> board;  // m, z = 0
  std::vector<cv::Point2f> pixels; // centres at integers
  double discRadius = 0;           // m, of the discs whose middles the points are, as it looks; 0: of none

  //! From the board (m) to pixels, as if the lens had no distortion; all 0 where the points lie on a line.
  cv::Matx33d homography() const;

  //! Root mean square, px, of how far the points are off those of a flat board seen without distortion.
  double offPlane() const;
};

//! A flat board that cameras are calibrated with.
struct VISP_EXPORT vpBoard {
  enum class Kind {
    chessboard, //!< has to be seen whole
    charuco, //!< a chessboard with markers in its white squares: may be cut, so that it reaches the corners
    circles  //!< black discs on a square grid; has to be seen whole
  };

  Kind kind = Kind::chessboard;
  int columns = 9;        // inner corners, or circles, along the longer side
  int rows = 6;           // and along the other
  double spacing = 0.025; // m, side of a square, or from circle to circle

  //! \throw vpException (badValue) with one line: fewer than 3 either way, or a spacing that is not above 0.
  void check() const;

  //! Finds the board. \return Nothing in `pixels` where it is not there.
  vpBoardSight find(const vpImage<unsigned char> &I, const std::string &name) const;

  /*!
    What a picture shows in its place: the size of another chessboard, `8x5`, or empty. For messages: a wrong
    size is the most frequent reason why none is found.
  */
  std::string sizeShown(const vpImage<unsigned char> &I) const;

  //! `9x6`
  std::string size() const { return std::to_string(columns) + "x" + std::to_string(rows); }

  /*!
    The board as a PDF of one page, vectors in true size: A4 or A3 where it fits, else as large as it needs.
    Below it a line of 100 mm, to measure what the printer made of it.
  */
  std::string pdf() const;

  /*!
    Squares and markers as grey pixels, \e perSquare of them along a square (of a charuco 20), a margin of one
    square around. Not for circles.
  */
  cv::Mat_<unsigned char> pattern(int perSquare) const;
};

END_VISP_NAMESPACE

#endif
