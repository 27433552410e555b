/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLampIndex.h"

#include <algorithm>
#include <array>
#include <limits>

#include <nanoflann.hpp>

BEGIN_VISP_NAMESPACE

namespace
{
//! What nanoflann asks of its points.
struct Points {
  struct Point {
    std::array<double, 3> coordinates; // x, y, identifier * step
    size_t lamp;
  };
  std::vector<Point> points;

  size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(size_t index, size_t axis) const { return points[index].coordinates[axis]; }
  template <class Box>
  bool kdtree_get_bbox(Box &) const
  {
    return false;
  }
};

//! Collects the lamps within a radius, into a vector that the caller uses again.
class Collector
{
public:
  Collector(const Points &points, double squaredRadius, std::vector<size_t> &found)
      : m_points(points), m_squaredRadius(squaredRadius), m_found(found)
  {
  }
  size_t size() const { return m_found.size(); }
  bool full() const { return true; } // of any number: the search may always stop at worstDist()
  double worstDist() const { return m_squaredRadius; }
  bool addPoint(double squaredDistance, size_t index)
  {
    if (squaredDistance <= m_squaredRadius) {
      m_found.push_back(m_points.points[index].lamp);
    }
    return true;
  }

private:
  const Points &m_points;
  double m_squaredRadius; // m^2
  std::vector<size_t> &m_found;
};

} // namespace

struct vpLampIndex::Tree {
  using Kd =
      nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Points>, Points, 3, size_t>;
  Points points;
  double step = 0; // m, between identifiers
  std::unique_ptr<Kd> kd;
};

vpLampIndex::vpLampIndex(const vpLampMap &map, bool scan)
    : m_lamps(map.lamps.size()), m_scan(scan), m_tree(std::make_unique<Tree>())
{
  for (size_t index = 0; index < m_lamps.size(); ++index) {
    const vpLamp &lamp = map.lamps[index];
    m_lamps[index] = {{lamp.position.x(), lamp.position.y()}, lamp.position.z(), lamp.positionSigma, nowhere};
  }
  const double infinity = std::numeric_limits<double>::infinity();
  Eigen::Vector3d least = Eigen::Vector3d::Constant(infinity), greatest = -least;
  for (const vpIdentifier &identifier : map.identifiers()) {
    m_byIdentifier.emplace_back();
    for (size_t index : identifier.lamps) {
      const Eigen::Vector3d &position = map.lamps[index].position;
      if (!position.allFinite()) { // hangs nowhere
        continue;
      }
      m_lamps[index].identifier = m_byIdentifier.size() - 1;
      m_byIdentifier.back().push_back(index);
      m_byName.emplace(map.lamps[index].id, index);
      least = least.cwiseMin(position);
      greatest = greatest.cwiseMax(position);
      m_greatestSigma = std::max(m_greatestSigma, map.lamps[index].positionSigma);
      ++m_blinking;
    }
  }
  if (m_blinking == 0) {
    return;
  }
  m_lowest = least.z();
  m_highest = greatest.z();
  m_length = greatest.x() - least.x();
  m_width = greatest.y() - least.y();
  m_tree->step = 1 + 2 * (greatest - least).norm();
  for (size_t id = 0; id < m_byIdentifier.size(); ++id) {
    for (size_t index : m_byIdentifier[id]) {
      const std::complex<double> place = m_lamps[index].place;
      const double third = m_tree->step * static_cast<double>(id);
      m_tree->points.points.push_back({{place.real(), place.imag(), third}, index});
    }
  }
  m_tree->kd = std::make_unique<Tree::Kd>(3, m_tree->points);
  m_tree->kd->buildIndex();
}

vpLampIndex::~vpLampIndex() = default;

size_t vpLampIndex::find(const std::string &id) const
{
  const auto found = m_byName.find(id);
  return found == m_byName.end() ? nowhere : found->second;
}

void vpLampIndex::within(size_t identifier, const std::complex<double> &place, double radius,
                         std::vector<size_t> &found) const
{
  found.clear();
  if (identifier >= m_byIdentifier.size()) {
    return;
  }
  const auto near = [&](size_t index) { return std::abs(m_lamps[index].place - place) <= radius; };
  if (m_scan) {
    for (size_t index = 0; index < m_lamps.size(); ++index) {
      if (m_lamps[index].identifier == identifier && near(index)) {
        found.push_back(index);
      }
    }
    return;
  }
  // Beyond half the step a search of the tree would meet the neighbouring identifiers.
  const std::vector<size_t> &lamps = m_byIdentifier[identifier];
  if (radius > m_tree->step / 2 || lamps.size() == 1) {
    std::copy_if(lamps.begin(), lamps.end(), std::back_inserter(found), near);
    return;
  }
  const double query[3] = {place.real(), place.imag(), m_tree->step * static_cast<double>(identifier)};
  Collector collector(m_tree->points, radius * radius, found);
  m_tree->kd->radiusSearchCustomCallback(query, collector);
  std::sort(found.begin(), found.end()); // so that ties fall as in a scan
}

END_VISP_NAMESPACE
