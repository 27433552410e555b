/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpMapSheet_h
#define vpMapSheet_h

#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  The sheet that a map is drawn on: x to the right, y up, one scale for both, a grid with its metres written
  on the left and below. What is drawn ends at the grid's frame.
*/
class vpMapSheet
{
public:
  static const cv::Scalar ground, textColour; // BGR; ground: around the grid
  static constexpr double textUnit = 0.9;     // size of its text, of a unit

  cv::Mat picture; // BGR; empty where there is no room for a grid

  //! \param view m, what is shown at least. \param unit Size of text and lines; 1 suits 400 pixels.
  vpMapSheet(const Eigen::AlignedBox2d &view, cv::Size size, double unit);

  double unit() const { return m_unit; }
  double scale() const { return m_scale; }                                      // px of a metre
  double side() const { return std::sqrt(static_cast<double>(m_area.area())); } // px, of the grid

  //! Where a place (m) is in the picture, px, centres at integers.
  Eigen::Vector2d operator()(const Eigen::Vector2d &place) const;

  //! Whether the grid holds a place.
  bool shows(const Eigen::Vector2d &place) const;

  void drawGrid();

  //! Through places (m); nothing where one of them is too far away to be drawn.
  void drawLine(const std::vector<Eigen::Vector2d> &places, bool closed, const cv::Scalar &colour,
                double thickness);
  void fill(const std::vector<Eigen::Vector2d> &places, const cv::Scalar &colour);

  //! Labels shall not cover what is between these places (m).
  void avoid(const std::vector<Eigen::Vector2d> &places);

  //! Beside what is between these places, where there is room for it; else none.
  void drawLabel(const std::string &text, const std::vector<Eigen::Vector2d> &places,
                 const cv::Scalar &colour);

private:
  double step() const;
  std::vector<cv::Point> fixed(const std::vector<Eigen::Vector2d> &places) const;
  cv::Rect box(const std::vector<Eigen::Vector2d> &places) const;

  Eigen::AlignedBox2d m_view; // m
  double m_unit;
  cv::Rect m_area;    // px, of the grid in the picture
  double m_scale = 1; // px of a metre
  std::vector<cv::Rect> m_taken;
};

END_VISP_NAMESPACE

#endif
