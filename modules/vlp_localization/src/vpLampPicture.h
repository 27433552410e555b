/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampPicture_h
#define vpLampPicture_h

#include <visp3/vlp_core/vpLampMap.h>

#include "vpLampGeometry.h"

BEGIN_VISP_NAMESPACE

/*!
  How a lamp of the map looks from a pose: its middle, and the map from its plane to the picture, taken over
  its diameters along x and y of w. Private to the module.
*/
class vpLampPicture
{
public:
  vpLampPicture(const vpLamp &lamp, const vpBasePose &wMb, const vpVlpRig &rig);

  //! Whether all of it is before the camera; else the rest means nothing.
  bool inFront() const { return m_inFront; }
  //! Pixel of its middle.
  const Eigen::Vector2d &middle() const { return m_middle; }
  //! Mean diameter, px: of the ellipse of a disc.
  double diameter() const;
  //! px/s, of its middle, seen by a base that moves at \e velocity: m/s along x and y of b, rad/s.
  Eigen::Vector2d motion(const Eigen::Vector3d &velocity) const;
  //! Times that it looks longer across the lines than it is, as its picture runs ahead of the readout, at
  //! most ten. \param lineTime s, from line to line.
  double stretch(const Eigen::Vector3d &velocity, double lineTime) const;
  //! Width and height, px, of its disc or square, so stretched; 0 where it is not in front.
  Eigen::Vector2d extent(const Eigen::Vector3d &velocity, double lineTime) const;

private:
  const vpLamp &m_lamp;
  const vpBasePose m_pose;
  double m_size;  // m
  int m_along;    // coordinate in which lines follow each other
  bool m_inFront; // of the camera
  Eigen::Vector2d m_middle;
  Eigen::Matrix2d m_byPlace; // px/m, by x and y of w
};

END_VISP_NAMESPACE

#endif
