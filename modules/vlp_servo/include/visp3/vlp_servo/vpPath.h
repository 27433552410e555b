/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPath_h
#define vpPath_h

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

class vpPathShape;

//! A place of a path, and which way it leads there.
struct VISP_EXPORT vpPathPoint {
  Eigen::Vector2d place = Eigen::Vector2d::Zero(); // m, in w
  double heading = 0;                              // rad from the x axis of w
  double curvature = 0;                            // 1/m, above 0 where it bends to the left
};

/*!
  A curve on the floor that a robot is to drive, by the length s along it, m, from 0 to length(). A closed one
  ends where it begins; its s goes on from lap to lap.

  A polyline has corners, where the heading jumps: a robot on two wheels stops there and turns. The other
  shapes have none.

  \code
  const vpPath path = vpPath::circle({0, 0}, 0.3);
  const vpPathPoint point = path.at(path.closest({0.31, 0.02}));
  \endcode
*/
class VISP_EXPORT vpPath
{
public:
  /*!
    Through \e points (m), two or more, and back to the first where it is \e closed.
    \throw vpException (badValue) where there are fewer, or one is not finite, or that of the point before.
  */
  static vpPath polyline(const std::vector<Eigen::Vector2d> &points, bool closed = false);

  //! Closed, to the left all the way, from (radius, 0) of its centre. \throw vpException (badValue).
  static vpPath circle(const Eigen::Vector2d &centre, double radius);

  /*!
    About \e centre, from one angle (rad, from the x axis of w) to another: to the left where \e to is the
    greater one, else to the right. \throw vpException (badValue).
  */
  static vpPath arc(const Eigen::Vector2d &centre, double radius, double from, double to);

  /*!
    Bernoulli's lemniscate, a figure of eight along the x axis, \e width (m) from end to end; closed, from its
    right end upwards. Its sharpest bend, at both ends, has a radius of width / 6.
    With a = width / 2: x = a cos t / (1 + sin^2 t), y = x sin t, curvature 3 cos t / (a sqrt(1 + sin^2 t)).
    \throw vpException (badValue).
  */
  static vpPath lemniscate(const Eigen::Vector2d &centre, double width);

  /*!
    Reads `{type: polyline, points_m: [[-0.35, 0], [0.35, 0]], closed: false}`,
    `{type: circle, centre_m: [0, 0], radius_m: 0.3}`,
    `{type: arc, centre_m: [0, 0], radius_m: 0.3, from_deg: 0, to_deg: 90}` or
    `{type: lemniscate, centre_m: [0, 0], width_m: 0.7}`.
    \throw vpException with one line that names file, line, field, what came and what was expected.
  */
  static vpPath load(const std::string &filename);

  //! Writes such a file, whole or not at all. \throw vpException (ioError).
  void save(const std::string &filename) const;

  double length() const; // m, of one lap
  bool closed() const { return m_closed; }

  //! \e s is taken into the path: modulo its length where it is closed, else cut off at its ends. At a corner
  //! it is the leg that begins there.
  vpPathPoint at(double s) const;

  //! s of the corners within the path, rising. That at the end of a closed one, if it is one, is length().
  const std::vector<double> &corners() const { return m_corners; }

  //! s, to 1e-7 m, of the place closest to \e place, from \e from to \e to (m; beyond a lap where the path is
  //! closed).
  double closest(const Eigen::Vector2d &place, double from, double to) const;
  double closest(const Eigen::Vector2d &place) const { return closest(place, 0, length()); }

  //! How far \e place is to the left of the path at \e s, m: across its heading there.
  double offset(const Eigen::Vector2d &place, double s) const;

private:
  vpPath(std::shared_ptr<const vpPathShape> shape, bool closed, std::vector<double> corners);

  std::shared_ptr<const vpPathShape> m_shape; // never changes, so that copies share it
  bool m_closed;
  std::vector<double> m_corners;
};

END_VISP_NAMESPACE

#endif
