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
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <visp3/core/vpException.h>
#include <visp3/core/vpMath.h>
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

//! Moves corners to where edges cross, in windows of twice a share of the smallest square.
void refine(const cv::Mat &grey, double share, int most, std::vector<cv::Point2f> &corners)
{
  double smallest = std::numeric_limits<double>::infinity(); // px, of the smallest
  for (size_t i = 0; i < corners.size(); ++i) {
    for (size_t k = 0; k < i; ++k) {
      smallest = std::min(smallest, cv::norm(corners[i] - corners[k]));
    }
  }
  const int half = std::clamp(static_cast<int>(share * smallest), 2, most);
  cv::cornerSubPix(grey, corners, cv::Size(half, half), cv::Size(-1, -1),
                   cv::TermCriteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 40, 1e-3));
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
  static const double share = 0.12; // of a square: the markers begin at 0.15
  static const int most = 8;        // px
  refine(grey, share, most, sight.pixels);
  for (const int corner : corners) {
    sight.board.push_back(charuco->chessboardCorners.at(static_cast<size_t>(corner)));
  }
}

/*!
  OpenCV's corners of squares bear blur and noise; where edges cross, refined, is more exact in a sharp
  picture and less in a blurred one. Those are taken that lie better on a board.
*/
void findChessboard(const vpBoard &board, const cv::Mat &grey, vpBoardSight &sight)
{
  if (!cv::findChessboardCornersSB(grey, cv::Size(board.columns, board.rows), sight.pixels,
                                   cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_ACCURACY)) {
    sight.pixels.clear();
    return;
  }
  sight.board = gridOf(board);
  vpBoardSight refined = sight;
  static const double share = 0.45; // of a square: the next corner stays outside
  static const int most = 10;       // px
  refine(grey, share, most, refined.pixels);
  if (refined.offPlane() < sight.offPlane()) {
    sight = refined;
  }
}

//! Radius (m) of the discs, by how much of their cells they cover.
double radiusOf(const vpBoard &board, const cv::Mat &grey, const vpBoardSight &sight)
{
  static const int cell = 40, patch = 5; // pixels of the board seen from straight above
  const double pixel = board.spacing / cell, first = 0.5 * (pixel - board.spacing);
  const cv::Matx33d toBoard(pixel, 0, first, 0, pixel, first, 0, 0, 1);
  cv::Mat above;
  cv::warpPerspective(grey, above, sight.homography() * toBoard,
                      cv::Size(cell * board.columns, cell * board.rows),
                      cv::INTER_LINEAR | cv::WARP_INVERSE_MAP);
  std::vector<double> radii;
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      const cv::Mat one = above(cv::Rect(cell * column, cell * row, cell, cell));
      const auto level = [&one](int x, int y) { return cv::mean(one(cv::Rect(x, y, patch, patch)))[0]; };
      const int middle = (cell - patch) / 2, last = cell - patch;
      const double paper = 0.25 * (level(0, 0) + level(last, 0) + level(0, last) + level(last, last)),
                   covered = (paper - cv::mean(one)[0]) / (paper - level(middle, middle));
      radii.push_back(board.spacing * std::sqrt(std::max(0.0, covered) / M_PI));
    }
  }
  std::nth_element(radii.begin(), radii.begin() + static_cast<long>(radii.size() / 2), radii.end());
  return radii[radii.size() / 2];
}

void findDiscs(const vpBoard &board, const cv::Mat &grey, vpBoardSight &sight)
{
  cv::SimpleBlobDetector::Params blob;
  blob.maxArea = static_cast<float>(grey.total()) / static_cast<float>(board.columns * board.rows);
  const cv::Ptr<cv::FeatureDetector> detector = cv::SimpleBlobDetector::create(blob);
  const auto found = [&](int how) {
    return cv::findCirclesGrid(grey, cv::Size(board.columns, board.rows), sight.pixels,
                               cv::CALIB_CB_SYMMETRIC_GRID | how, detector);
  };
  if (!found(0) && !found(cv::CALIB_CB_CLUSTERING)) { // the latter finds small grids, and bears less clutter
    sight.pixels.clear();
    return;
  }
  sight.board = gridOf(board);
  sight.discRadius = radiusOf(board, grey, sight);
}

cv::Mat viewOf(const vpImage<unsigned char> &I)
{
  return {static_cast<int>(I.getHeight()), static_cast<int>(I.getWidth()), CV_8UC1, I.bitmap};
}
} // namespace

cv::Matx33d vpBoardSight::homography() const
{
  std::vector<cv::Point2f> flat;
  for (const cv::Point3f &point : board) {
    flat.emplace_back(point.x, point.y);
  }
  const cv::Mat found = cv::findHomography(flat, pixels);
  return found.empty() ? cv::Matx33d::zeros() : cv::Matx33d(found);
}

double vpBoardSight::offPlane() const
{
  const cv::Matx33d H = homography();
  if (pixels.empty() || H == cv::Matx33d::zeros()) { // on a line: they tell nothing
    return 0;
  }
  double squares = 0;
  for (size_t i = 0; i < pixels.size(); ++i) {
    const cv::Vec3d at = H * cv::Vec3d(board[i].x, board[i].y, 1);
    squares += vpMath::sqr(at(0) / at(2) - pixels[i].x) + vpMath::sqr(at(1) / at(2) - pixels[i].y);
  }
  return std::sqrt(squares / static_cast<double>(pixels.size()));
}

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
  vpBoardSight sight;
  sight.picture = name;
  switch (kind) {
  case Kind::chessboard:
    findChessboard(*this, grey, sight);
    break;
  case Kind::charuco:
    findCharuco(*this, grey, sight);
    break;
  case Kind::circles:
    findDiscs(*this, grey, sight);
    break;
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
