/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPathShape_h
#define vpPathShape_h

#include <string>
#include <vector>

#include <visp3/vlp_servo/vpPath.h>

BEGIN_VISP_NAMESPACE

//! A curve by its length, and how a file writes it.
class vpPathShape
{
public:
  //! m: a sum of laps and legs may miss a corner by so much, and means it all the same.
  static constexpr double rounding = 1e-9;

  virtual ~vpPathShape() = default;
  virtual double length() const = 0;          // m
  virtual vpPathPoint at(double s) const = 0; // s from 0 to length()
  virtual std::string yaml() const = 0;       // one mapping, without a line's end
};

class vpPolylineShape : public vpPathShape
{
public:
  //! The last of \e corners is the first again where the line is \e closed.
  vpPolylineShape(std::vector<Eigen::Vector2d> corners, bool closed);
  double length() const override { return m_lengths.back(); }
  vpPathPoint at(double s) const override;
  std::string yaml() const override;
  //! s of each of its points.
  const std::vector<double> &lengths() const { return m_lengths; }

private:
  std::vector<Eigen::Vector2d> m_points;
  std::vector<double> m_lengths; // m, up to each point
  bool m_closed;
};

class vpArcShape : public vpPathShape
{
public:
  //! \e from, \e to: rad.
  vpArcShape(const Eigen::Vector2d &centre, double radius, double from, double to, bool circle);
  double length() const override;
  vpPathPoint at(double s) const override;
  std::string yaml() const override;

private:
  Eigen::Vector2d m_centre;
  double m_radius, m_from, m_to;
  bool m_circle; // as a file names it
};

class vpLemniscateShape : public vpPathShape
{
public:
  vpLemniscateShape(const Eigen::Vector2d &centre, double width);
  double length() const override { return m_lengths.back(); }
  vpPathPoint at(double s) const override;
  std::string yaml() const override;

private:
  Eigen::Vector2d m_centre;
  double m_half;                 // m, of the width
  std::vector<double> m_lengths; // m, up to parameters that lie evenly from 0 to 2 pi
};

END_VISP_NAMESPACE

#endif
