/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpFloorPlan.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpAtomicFile.h>
#include <visp3/vlp_sensor/vpWritePicture.h>

vpFloorPlan::vpFloorPlan(const vpLampMap &map)
{
  static const double margin = 1, widest = 100; // m
  Eigen::AlignedBox2d box;
  for (const vpLamp &lamp : map.lamps) {
    box.extend(lamp.position.head<2>());
  }
  if (box.isEmpty()) {
    box.extend(Eigen::Vector2d::Zero());
  }
  if (box.sizes().maxCoeff() > widest) {
    throw vpException(vpException::badValue, "floor plan: lamps more than 100 m apart");
  }
  m_left = box.min().x() - margin;
  m_bottom = box.min().y() - margin;
  const Eigen::Vector2i cells = ((box.sizes().array() + 2 * margin) / resolution).ceil().cast<int>();
  m_cells = cv::Mat_<unsigned char>::zeros(cells.y(), cells.x());
  for (const vpLamp &lamp : map.lamps) {
    const double size =
        (std::isfinite(lamp.size) ? lamp.size : 0.15) / resolution; // 0.15 m: nobody measured it
    const cv::Point2f centre(static_cast<float>((lamp.position.x() - m_left) / resolution),
                             static_cast<float>(cells.y() - (lamp.position.y() - m_bottom) / resolution));
    if (lamp.shape == vpLamp::Shape::square) {
      const cv::RotatedRect square(centre, cv::Size2f(static_cast<float>(size), static_cast<float>(size)),
                                   static_cast<float>(-lamp.yaw * 180 / M_PI)); // rows run against y
      cv::Point2f corners[4];
      square.points(corners);
      const std::vector<cv::Point> polygon(corners, corners + 4);
      cv::fillConvexPoly(m_cells, polygon, 1);
    } else {
      cv::circle(m_cells, centre, static_cast<int>(std::lround(size / 2)), 1, cv::FILLED);
    }
    cv::putText(m_cells, lamp.id, cv::Point(centre) + cv::Point(static_cast<int>(size / 2) + 4, 6),
                cv::FONT_HERSHEY_SIMPLEX, 0.5, 1);
  }
}

nav_msgs::OccupancyGrid vpFloorPlan::grid(const std::string &frameId) const
{
  static const std::int8_t shade = 25; // %
  nav_msgs::OccupancyGrid grid;
  grid.header.frame_id = frameId;
  grid.header.stamp = ros::Time::now();
  grid.info.resolution = resolution;
  grid.info.width = static_cast<std::uint32_t>(m_cells.cols);
  grid.info.height = static_cast<std::uint32_t>(m_cells.rows);
  grid.info.origin.position.x = m_left;
  grid.info.origin.position.y = m_bottom;
  grid.info.origin.orientation.w = 1;
  for (int row = m_cells.rows - 1; row >= 0; --row) {
    std::transform(m_cells[row], m_cells[row] + m_cells.cols, std::back_inserter(grid.data),
                   [](unsigned char cell) { return cell != 0 ? shade : std::int8_t{0}; });
  }
  return grid;
}

void vpFloorPlan::save(const std::string &prefix) const
{
  const cv::Mat grey = 254 - 76 * m_cells; // 254: free; 178: the shade, 30 % of the way to black
  vpWritePicture(prefix + ".pgm", grey);
  vpAtomicFile yaml(prefix + ".yaml");
  yaml.stream() << "image: " << prefix.substr(prefix.rfind('/') + 1) << ".pgm\nresolution: " << resolution
                << "\norigin: [" << m_left << ", " << m_bottom
                << ", 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\nmode: scale\n";
  yaml.commit();
}
