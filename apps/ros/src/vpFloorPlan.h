/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpFloorPlan_h
#define vpFloorPlan_h

#include <string>

#include <nav_msgs/OccupancyGrid.h>
#include <opencv2/core.hpp>
#include <visp3/vlp_core/vpLampMap.h>

/*!
  The floor below the lamps with each lamp's shape and id on it, a metre more on each side. Nothing on it is
  an obstacle: lamps are a shade that planners pass over.
*/
class vpFloorPlan
{
public:
  static constexpr double resolution = 0.01; // m of a cell

  //! \throw vpException (badValue) where the lamps hang more than 100 m apart.
  explicit vpFloorPlan(const vpLampMap &map);

  //! For RViz, without map_server.
  nav_msgs::OccupancyGrid grid(const std::string &frameId) const;

  //! \e prefix.pgm and \e prefix.yaml, as map_server reads them. \throw vpException (ioError).
  void save(const std::string &prefix) const;

private:
  double m_left = 0, m_bottom = 0; // m, corner of the cell that is lowest in x and y
  cv::Mat_<unsigned char> m_cells; // shaded or not, row 0 at the largest y
};

#endif
