/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLampIndex.h"

#include <algorithm>

#include <Eigen/Geometry>

BEGIN_VISP_NAMESPACE

vpLampIndex::vpLampIndex(const vpLampMap &map)
{
  for (const vpLamp &lamp : map.lamps) {
    m_lamps.push_back(
        {{lamp.position.x(), lamp.position.y()}, lamp.position.z(), lamp.positionSigma, nowhere});
  }
  Eigen::AlignedBox3d box;
  for (const vpIdentifier &identifier : map.identifiers()) {
    std::vector<size_t> &lamps = m_byIdentifier.emplace_back();
    for (size_t index : identifier.lamps) {
      const vpLamp &lamp = map.lamps[index];
      if (!lamp.position.allFinite()) { // hangs nowhere
        continue;
      }
      m_lamps[index].identifier = m_byIdentifier.size() - 1;
      lamps.push_back(index);
      m_byName.emplace(lamp.id, index);
      box.extend(lamp.position);
      m_greatestSigma = std::max(m_greatestSigma, lamp.positionSigma);
    }
    std::stable_sort(lamps.begin(), lamps.end(), [this](size_t a, size_t b) {
      return m_lamps[a].place.real() < m_lamps[b].place.real();
    });
  }
  if (!box.isEmpty()) {
    m_lowest = box.min().z();
    m_highest = box.max().z();
    m_length = box.sizes().x();
    m_width = box.sizes().y();
  }
}

size_t vpLampIndex::find(const std::string &id) const
{
  const auto found = m_byName.find(id);
  return found == m_byName.end() ? nowhere : found->second;
}

size_t vpLampIndex::carriers(size_t identifier) const
{
  return identifier < m_byIdentifier.size() ? m_byIdentifier[identifier].size() : 0;
}

void vpLampIndex::within(size_t identifier, const std::complex<double> &place, double radius,
                         std::vector<size_t> &found) const
{
  found.clear();
  const std::vector<size_t> &lamps = m_byIdentifier[identifier];
  const auto first =
      std::lower_bound(lamps.begin(), lamps.end(), place.real() - radius,
                       [this](size_t lamp, double x) { return m_lamps[lamp].place.real() < x; });
  for (auto lamp = first; lamp != lamps.end() && m_lamps[*lamp].place.real() <= place.real() + radius;
       ++lamp) {
    if (std::norm(m_lamps[*lamp].place - place) <= radius * radius) {
      found.push_back(*lamp);
    }
  }
}

END_VISP_NAMESPACE
