/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpOutlineModel_h
#define vpOutlineModel_h

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <visp3/vlp_core/vpLampObservation.h>

BEGIN_VISP_NAMESPACE

/*!
  Outlines as the fitter sees them: a signed distance (negative inside), its derivatives, and the stretch of a
  line within some distance of the edge. Steps are local: advance() moves the outline by a small step of its
  own parameters.
*/
class vpEllipseModel
{
public:
  static constexpr int parameters = 5; // centre u, v (px); log size; two components of log(a / b)
  using Vector = Eigen::Matrix<double, parameters, 1>;

  //! From an ellipse with semi-axes a, b along \e angle.
  vpEllipseModel(const Eigen::Vector2d &centre, double a, double b, double angle);
  //! Ellipse with the least algebraic distance from the points (Halir and Flusser 1998); none where they lie
  //! on a line, or on fewer than five places.
  static std::optional<vpEllipseModel> through(const std::vector<cv::Point2f> &points);
  //! Best ellipse of points on the outline; a circle about \e box where they allow none.
  static vpEllipseModel from(const std::vector<cv::Point2f> &points, const cv::Rect &box);

  //! Signed distance of \e x.
  double distance(const Eigen::Vector2d &x) const
  {
    const Eigen::Vector2d y = m_shape * (x - m_centre);
    const double rho = std::max(y.norm(), 1e-6);
    return (rho - 1) * rho / std::max((m_shape * y).norm(), 1e-12);
  }
  //! The same; its derivative by the parameters; the outline's outward normal nearest to x.
  double distance(const Eigen::Vector2d &x, Vector &derivative, Eigen::Vector2d &normal) const;
  void advance(const Vector &step);
  //! Weak prior towards a circle, added to normal equations H step = g. Returns its own chi-square.
  double addPrior(double sigma, Eigen::Ref<Eigen::MatrixXd> H, Eigen::Ref<Eigen::VectorXd> g) const;
  //! Range of samples on line \e v at most \e distance outside (inside where negative) the outline; false:
  //! none.
  bool stretch(double v, double distance, double &first, double &last) const;
  //! Whether line \e v crosses the outline at its first, its last end such that a straight edge models it.
  bool crossedWell(double, bool, bool) const { return true; }
  void vertical(double &top, double &bottom) const;
  double radius() const;
  //! The longer and the shorter semi-axis, px.
  Eigen::Vector2d axes() const;
  //! rad, from u to the longer one, towards v.
  double angle() const;
  Eigen::Vector2d centre() const { return m_centre; }
  //! Symmetric; |shape (x - centre)| = 1 on the outline.
  const Eigen::Matrix2d &shape() const { return m_shape; }
  bool plausible(const cv::Rect &box) const;
  //! \param covariance Of the parameters, px and log units.
  vpLampOutline outline(const Eigen::Ref<const Eigen::MatrixXd> &covariance) const;

private:
  vpEllipseModel(const Eigen::Vector2d &centre, const Eigen::Matrix2d &shape)
      : m_centre(centre), m_shape(shape)
  {
  }

  Eigen::Vector2d m_centre;
  Eigen::Matrix2d m_shape;
};

//! Four straight sides, each by the angle of its outward normal and its distance from a fixed point inside.
class vpQuadrilateralModel
{
public:
  static constexpr int parameters =
      8; // of each side: normal's angle (in px at half the mean side), distance (px)
  using Vector = Eigen::Matrix<double, parameters, 1>;

  static vpQuadrilateralModel from(const std::vector<cv::Point2f> &points);

  double distance(const Eigen::Vector2d &x) const;
  double distance(const Eigen::Vector2d &x, Vector &derivative, Eigen::Vector2d &normal) const;
  void advance(const Vector &step);
  //! Prior towards a square seen from about below, weakest on its sides' ratio.
  double addPrior(double sigma, Eigen::Ref<Eigen::MatrixXd> H, Eigen::Ref<Eigen::VectorXd> g) const;
  bool stretch(double v, double distance, double &first, double &last) const;
  //! Whether line \e v crosses the outline at its first, its last end such that a straight edge models it.
  bool crossedWell(double v, bool first, bool last) const;
  void vertical(double &top, double &bottom) const;
  double radius() const;
  Eigen::Vector2d centre() const { return outline(Eigen::MatrixXd::Zero(parameters, parameters)).centre; }
  bool plausible(const cv::Rect &box) const;
  vpLampOutline outline(const Eigen::Ref<const Eigen::MatrixXd> &covariance) const;

private:
  std::array<Eigen::Vector2d, 4> cornersAt(const Vector &step) const;
  void turnNormals();
  double distance(const Eigen::Vector2d &fromInside, size_t &side) const;

  Eigen::Vector2d m_inside;
  double m_scale = 1; // px, half the mean side
  std::array<double, 4> m_angle{};
  std::array<Eigen::Vector2d, 4> m_normal; // that they make
  std::array<double, 4> m_offset{};
  // px, how well the lit lines alone place the middle between sides 0 and 2, and between 1 and 3
  std::array<double, 2> m_middleSigma{};
};

END_VISP_NAMESPACE

#endif
