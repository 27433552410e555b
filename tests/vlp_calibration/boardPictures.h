/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef boardPictures_h
#define boardPictures_h

/*!
  \file boardPictures.h
  A camera of ViSP's model with distortion before a board held in many ways: its corners with noise, and whole
  pictures, drawn pixel by pixel from the ray of each.
*/

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <visp3/core/vpMeterPixelConversion.h>
#include <visp3/core/vpRxyzVector.h>
#include <visp3/vlp_calibration/vpBoard.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace boardPictures
{
constexpr unsigned int width = 800, height = 600;
constexpr double discShare = 0.4; // of the spacing, radius

inline vpCameraParameters camera(double kud = -0.12)
{
  vpCameraParameters camera;
  camera.initPersProjWithDistortion(488, 489, 395, 305, kud, -kud);
  return camera;
}

//! How a board is held: tilted by up to 40 degrees, its middle somewhere over the picture up to the corners.
inline vpHomogeneousMatrix held(const vpBoard &board, int i, std::mt19937_64 &random, double mostTilt = 0.7)
{
  std::uniform_real_distribution<double> uniform(-1, 1);
  const double tilt = mostTilt * (0.4 + 0.6 * std::abs(uniform(random))), about = 2 * M_PI * i / 7.0;
  const vpRotationMatrix R = vpRotationMatrix(0, 0, 0.2 * uniform(random)) *
                             vpRotationMatrix(tilt * std::cos(about), tilt * std::sin(about), 0);
  const double z = 0.36 + 0.08 * uniform(random);
  // Middles in the picture's four quarters and about its middle in turn.
  const double corners[5][2] = {{-0.3, -0.18}, {0.3, -0.18}, {0, 0}, {-0.3, 0.18}, {0.3, 0.18}};
  const vpTranslationVector middle(z * corners[i % 5][0], z * corners[i % 5][1], z);
  const vpTranslationVector toMiddle(-0.5 * board.spacing * (board.columns - 1),
                                     -0.5 * board.spacing * (board.rows - 1), 0);
  return vpHomogeneousMatrix(middle, R) * vpHomogeneousMatrix(toMiddle, vpRotationMatrix());
}

//! Corners as a detector of that noise (px) sees them, those beyond the picture's edge, too.
inline vpBoardSight sight(const vpBoard &board, const vpCameraParameters &camera,
                          const vpHomogeneousMatrix &cMo, double noise, std::mt19937_64 &random,
                          const std::string &name)
{
  std::normal_distribution<double> normal;
  vpBoardSight sight;
  sight.picture = name;
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      const double x = column * board.spacing, y = row * board.spacing;
      const vpColVector c = cMo * vpColVector(std::vector<double>{x, y, 0, 1});
      double u = 0, v = 0;
      vpMeterPixelConversion::convertPoint(camera, c[0] / c[2], c[1] / c[2], u, v);
      sight.board.emplace_back(static_cast<float>(x), static_cast<float>(y), 0.f);
      sight.pixels.emplace_back(static_cast<float>(u + noise * normal(random)),
                                static_cast<float>(v + noise * normal(random)));
    }
  }
  return sight;
}

inline std::vector<vpBoardSight> sights(const vpBoard &board, int count, double noise, unsigned int seed,
                                        const vpCameraParameters &seenBy = camera())
{
  std::mt19937_64 random(seed);
  std::vector<vpBoardSight> all;
  for (int i = 0; i < count; ++i) {
    const vpHomogeneousMatrix cMo = held(board, i, random);
    all.push_back(sight(board, seenBy, cMo, noise, random, "picture " + std::to_string(i)));
  }
  return all;
}

//! Discs of 0.4 of the spacing as vpBoard::pattern would draw them, with its margins.
inline cv::Mat_<unsigned char> discs(const vpBoard &board, int perSquare)
{
  cv::Mat_<unsigned char> grey((board.rows + 3) * perSquare, (board.columns + 3) * perSquare, 255);
  for (int v = 0; v < grey.rows; ++v) {
    for (int u = 0; u < grey.cols; ++u) {
      const double x = (u + 0.5) / perSquare - 2, y = (v + 0.5) / perSquare - 2,
                   column = std::clamp(std::round(x), 0.0, board.columns - 1.0),
                   row = std::clamp(std::round(y), 0.0, board.rows - 1.0);
      if (std::hypot(x - column, y - row) < discShare) {
        grey(v, u) = 0;
      }
    }
  }
  return grey;
}

//! A whole picture: 3 x 3 rays a pixel, each taken back through the distortion and on to the board.
inline cv::Mat_<unsigned char> picture(const vpBoard &board, const vpCameraParameters &camera,
                                       const vpHomogeneousMatrix &cMo, std::mt19937_64 &random)
{
  const int perSquare = 40;
  const cv::Mat_<unsigned char> pattern =
      board.kind == vpBoard::Kind::circles ? discs(board, perSquare) : board.pattern(perSquare);
  const vpHomogeneousMatrix oMc = cMo.inverse();
  std::normal_distribution<double> noise(0, 1);
  cv::Mat_<unsigned char> grey(static_cast<int>(height), static_cast<int>(width));
  for (int v = 0; v < grey.rows; ++v) {
    for (int u = 0; u < grey.cols; ++u) {
      double sum = 0;
      for (int part = 0; part < 9; ++part) {
        const double xd = (u + (part % 3 - 1) / 3.0 - camera.get_u0()) / camera.get_px(),
                     yd = (v + (part / 3 - 1) / 3.0 - camera.get_v0()) / camera.get_py();
        double x = xd, y = yd;
        for (int round = 0; round < 8; ++round) {
          const double share = 1 + camera.get_kud() * (x * x + y * y);
          x = xd / share;
          y = yd / share;
        }
        const double dx = oMc[0][0] * x + oMc[0][1] * y + oMc[0][2],
                     dy = oMc[1][0] * x + oMc[1][1] * y + oMc[1][2],
                     dz = oMc[2][0] * x + oMc[2][1] * y + oMc[2][2];
        const double far = -oMc[2][3] / dz;
        // The pattern has a margin of one square, and its first inner corner is one square further.
        const double column = ((oMc[0][3] + far * dx) / board.spacing + 2) * perSquare,
                     row = ((oMc[1][3] + far * dy) / board.spacing + 2) * perSquare;
        const bool on = row >= 0 && column >= 0 && row < pattern.rows && column < pattern.cols;
        sum += on ? 30 + 0.75 * pattern(static_cast<int>(row), static_cast<int>(column)) : 120;
      }
      grey(v, u) = cv::saturate_cast<unsigned char>(sum / 9 + noise(random));
    }
  }
  return grey;
}
} // namespace boardPictures

#endif
