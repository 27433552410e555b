/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_calibration/vpBoard.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <opencv2/aruco/charuco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

BEGIN_VISP_NAMESPACE

namespace
{
const double markerShare = 0.7; // of a charuco's square

cv::Ptr<cv::aruco::CharucoBoard> charucoOf(const vpBoard &board)
{
  return cv::aruco::CharucoBoard::create(board.columns + 1, board.rows + 1, static_cast<float>(board.spacing),
                                         static_cast<float>(markerShare * board.spacing),
                                         cv::aruco::getPredefinedDictionary(cv::aruco::DICT_5X5_250));
}

std::vector<cv::Point3f> gridOf(const vpBoard &board)
{
  std::vector<cv::Point3f> points;
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      points.emplace_back(static_cast<float>(column * board.spacing), static_cast<float>(row * board.spacing),
                          0.f);
    }
  }
  return points;
}

void findCharuco(const vpBoard &board, const cv::Mat &grey, vpBoardSight &sight)
{
  const cv::Ptr<cv::aruco::CharucoBoard> charuco = charucoOf(board);
  std::vector<std::vector<cv::Point2f>> markers;
  std::vector<int> ids, corners;
  cv::aruco::detectMarkers(grey, charuco->dictionary, markers, ids);
  static const int fewest = 6; // that say where the board is
  if (ids.empty() ||
      cv::aruco::interpolateCornersCharuco(markers, ids, grey, charuco, sight.pixels, corners) < fewest) {
    sight.pixels.clear();
    return;
  }
  // OpenCV 4.5.4 to 4.12 shift what they refined by half a pixel (opencv issue 25539): refined once more it
  // is right.
  double square = std::numeric_limits<double>::infinity(); // px, of the smallest
  for (size_t i = 0; i < sight.pixels.size(); ++i) {
    for (size_t k = 0; k < i; ++k) {
      square = std::min(square, cv::norm(sight.pixels[i] - sight.pixels[k]));
    }
  }
  static const double share = 0.12; // of a square: the markers begin at 0.15
  const int half = std::clamp(static_cast<int>(share * square), 2, 8);
  cv::cornerSubPix(grey, sight.pixels, cv::Size(half, half), cv::Size(-1, -1),
                   cv::TermCriteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 40, 1e-3));
  for (const int corner : corners) {
    sight.board.push_back(charuco->chessboardCorners.at(static_cast<size_t>(corner)));
  }
}

cv::Mat viewOf(const vpImage<unsigned char> &I)
{
  return {static_cast<int>(I.getHeight()), static_cast<int>(I.getWidth()), CV_8UC1, I.bitmap};
}
} // namespace

void vpBoard::check() const
{
  if (columns < 3 || rows < 3) {
    throw vpException(vpException::badValue, "board: " + size() + ", expected 3 or more either way");
  }
  if (!(spacing > 0) || !std::isfinite(spacing)) {
    throw vpException(vpException::badValue,
                      "board: a spacing of " + vpNumberText(spacing) + " m, expected a number above 0");
  }
}

vpBoardSight vpBoard::find(const vpImage<unsigned char> &I, const std::string &name) const
{
  const cv::Mat grey = viewOf(I);
  const cv::Size grid(columns, rows);
  vpBoardSight sight;
  sight.picture = name;
  if (kind == Kind::charuco) {
    findCharuco(*this, grey, sight);
    return sight;
  }
  bool found = false;
  if (kind == Kind::circles) {
    found = cv::findCirclesGrid(grey, grid, sight.pixels);
  } else {
    found = cv::findChessboardCornersSB(grey, grid, sight.pixels,
                                        cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_ACCURACY);
  }
  if (found) {
    sight.board = gridOf(*this);
  } else {
    sight.pixels.clear();
  }
  return sight;
}

std::string vpBoard::sizeShown(const vpImage<unsigned char> &I) const
{
  std::vector<cv::Point2f> corners;
  cv::Mat meta;
  if (!cv::findChessboardCornersSB(viewOf(I), cv::Size(3, 3), corners,
                                   cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_LARGER, meta) ||
      meta.empty()) {
    return "";
  }
  return std::to_string(std::max(meta.cols, meta.rows)) + "x" +
         std::to_string(std::min(meta.cols, meta.rows));
}

cv::Mat_<unsigned char> vpBoard::pattern(int perSquare) const
{
  cv::Mat_<unsigned char> grey((rows + 3) * perSquare, (columns + 3) * perSquare, 255);
  cv::Mat inner = grey(cv::Rect(perSquare, perSquare, (columns + 1) * perSquare, (rows + 1) * perSquare));
  if (kind == Kind::charuco) {
    cv::Mat drawn;
    charucoOf(*this)->draw(inner.size(), drawn, 0, 1);
    drawn.copyTo(inner);
    return grey;
  }
  for (int row = 0; row <= rows; ++row) {
    for (int column = 0; column <= columns; ++column) {
      if ((row + column) % 2 == 0) {
        inner(cv::Rect(column * perSquare, row * perSquare, perSquare, perSquare)) = 0;
      }
    }
  }
  return grey;
}

END_VISP_NAMESPACE
