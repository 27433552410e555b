/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpFigureBox_h
#define vpFigureBox_h

#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/Core>

#include "vpFigureScript.h"

BEGIN_VISP_NAMESPACE

//! The part of the plane that a map shows, m.
class vpFigureBox
{
public:
  void hold(const Eigen::Vector2d &point)
  {
    m_low = m_low.cwiseMin(point);
    m_high = m_high.cwiseMax(point);
  }
  Eigen::Vector2d size() const { return m_high - m_low; }
  const Eigen::Vector2d &low() const { return m_low; }
  const Eigen::Vector2d &high() const { return m_high; }

  //! Adds a margin, and makes the box at least \e least long and no more than three times as long as wide.
  void finish(double least)
  {
    const Eigen::Vector2d middle = 0.5 * (m_low + m_high);
    Eigen::Vector2d half = (0.54 * size()).cwiseMax(0.5 * least);
    half = half.cwiseMax(Eigen::Vector2d(half.y() / 1.2, half.x() / 3));
    m_low = middle - half;
    m_high = middle + half;
  }

  std::string ranges(double scale) const
  {
    return "set size ratio -1\n" + vpFigureScript::range("x", scale * m_low.x(), scale * m_high.x()) +
           vpFigureScript::range("y", scale * m_low.y(), scale * m_high.y());
  }

  //! Height of a figure of that width (px) that the box fills, or that a screen holds: beside it stand the
  //! axes' labels and legend.
  int figureHeight(int width) const
  {
    constexpr double beside = 100, below = 120, highest = 560; // px
    return static_cast<int>(std::min(highest, below + (width - beside) * size().y() / size().x()));
  }

private:
  Eigen::Vector2d m_low = Eigen::Vector2d::Constant(INFINITY), m_high = Eigen::Vector2d::Constant(-INFINITY);
};

END_VISP_NAMESPACE

#endif
