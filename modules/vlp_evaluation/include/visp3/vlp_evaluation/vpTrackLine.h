/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpTrackLine_h
#define vpTrackLine_h

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <visp3/vlp_core/vpTrajectory.h>

BEGIN_VISP_NAMESPACE

/*!
  The straight line that a robot was to drive, given as the paper does by the measured points where it started
  and ended (section 3.2.2). m, in w.
*/
class VISP_EXPORT vpTrackLine
{
public:
  //! \throw vpException (badValue) where the two are not finite, or less than a micrometre apart.
  vpTrackLine(const Eigen::Vector2d &start, const Eigen::Vector2d &end);

  /*!
    The line from the first to the last pose, where the trajectory goes along a line: the two are 1 cm or more
    apart, and no pose is off the line by more than a tenth of that. A robot that stood still, or drove a
    curve, gives none.
  */
  static std::optional<vpTrackLine> of(const vpTrajectory &trajectory);

  const Eigen::Vector2d &start() const { return m_start; }
  const Eigen::Vector2d &end() const { return m_end; }

  //! Distance (m) of a point from the line, which goes on beyond its ends: what the paper calls the error.
  double distance(const Eigen::Vector2d &point) const;

private:
  Eigen::Vector2d m_start, m_end;
};

/*!
  The line fitted to positions by least squares, y = slope x + offset, or where they spread more along y
  x = slope y + offset, as the paper's equations 8 to 13.
*/
struct VISP_EXPORT vpFittedLine {
  bool alongY = false;
  double slope = 0;
  double offset = 0; // m

  //! None for fewer than two points, and where all are one point.
  static std::optional<vpFittedLine> of(const std::vector<Eigen::Vector2d> &points);

  //! The point of the line at an x, or where alongY at a y.
  Eigen::Vector2d at(double coordinate) const;

  //! The equation with x and y in centimetres, as the paper writes it: `y = 0.0051 x + 1.0714`.
  std::string textInCentimetres() const;
};

END_VISP_NAMESPACE

#endif
