/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpSilhouette.h"

#include <algorithm>
#include <cmath>

#include <visp3/vlp_core/vpPixelEdge.h>

BEGIN_VISP_NAMESPACE

namespace
{
//! Distance of a point from the way that starts at \e from and runs on by \e way, in the plane, m.
double distanceFromWay(const Eigen::Vector2d &point, const Eigen::Vector2d &from, const Eigen::Vector2d &way)
{
  const double length = way.squaredNorm();
  const double along = length > 0 ? std::clamp((point - from).dot(way) / length, 0.0, 1.0) : 0;
  return (from + along * way - point).norm();
}

//! By how far the ray of a pixel passes outside the cylinder, m.
double passesBy(const vpSimulatedPerson &person, const vpHomogeneousMatrix &wMc, double time,
                const Eigen::Vector2d &ray)
{
  const Eigen::Vector2d camera(wMc[0][3], wMc[1][3]);
  Eigen::Vector3d direction;
  for (int i = 0; i < 3; ++i) {
    direction(i) = wMc[i][0] * ray.x() + wMc[i][1] * ray.y() + wMc[i][2];
  }
  static const double farthest = 50; // m, of the way that counts
  const double rise = person.height - wMc[2][3];
  if (rise <= 0) {
    return farthest;
  }
  const double flat = direction.head<2>().norm();
  double length = direction.z() > 0 ? rise / direction.z() : farthest;
  length = std::min(length, farthest / std::max(flat, 1e-9));
  return distanceFromWay(person.at(time), camera, length * direction.head<2>()) - person.radius;
}
} // namespace

vpSilhouette::vpSilhouette(const vpSensorGrid &grid, const vpNodeGrid &nodes, double blur,
                           const vpSimulatedScene &scene, const std::vector<vpHomogeneousMatrix> &wMc,
                           const std::vector<double> &times)
    : m_grid(grid), m_nodes(nodes), m_blur(std::max(blur, 0.1))
{
  double step = 1;
  for (const std::vector<int> *axis : {&nodes.lines, &nodes.samples}) {
    for (size_t k = 1; k < axis->size(); ++k) {
      step = std::max<double>(step, (*axis)[k] - (*axis)[k - 1]);
    }
  }
  m_sure = 2 * step * grid.spacing() + 5 * m_blur;
  for (const vpSimulatedPerson &person : scene.people) {
    cv::Mat_<float> distances(nodes.size());
    bool near = false;
    for (int i = 0; i < distances.rows; ++i) {
      for (int k = 0; k < distances.cols; ++k) {
        const Eigen::Vector2d pixel = grid.pixel(nodes.lines[i], nodes.samples[k]);
        distances(i, k) = static_cast<float>(distance(person, wMc[i], times[i], pixel));
        near = near || distances(i, k) < m_sure;
      }
    }
    if (near) {
      m_people.push_back({&person, distances});
    }
  }
}

//! px, to first order.
double vpSilhouette::distance(const vpSimulatedPerson &person, const vpHomogeneousMatrix &wMc, double time,
                              const Eigen::Vector2d &pixel) const
{
  auto at = [&](double du, double dv) {
    return passesBy(person, wMc, time, m_grid.rayAt(pixel + Eigen::Vector2d(du, dv)));
  };
  const double steep = std::hypot(at(0.5, 0) - at(-0.5, 0), at(0, 0.5) - at(0, -0.5)); // m per pixel
  return at(0, 0) / std::max(steep, 1e-6);
}

float vpSilhouette::shareAt(const vpSimulatedPerson &person, const vpHomogeneousMatrix &wMc, double time,
                            const Eigen::Vector2d &pixel) const
{
  return static_cast<float>(
      vpPixelEdge::at(distance(person, wMc, time, pixel), Eigen::Vector2d::UnitX(), m_blur).share);
}

void vpSilhouette::hide(int line, const vpHomogeneousMatrix &wMc, double time, float *light) const
{
  float way;
  const int above = m_nodes.before(line, way);
  const int below = std::min(above + 1, static_cast<int>(m_nodes.lines.size()) - 1);
  for (const Seen &seen : m_people) {
    const auto level = static_cast<float>(seen.person->level);
    for (size_t k = 0; k < m_nodes.samples.size(); ++k) {
      const int next = static_cast<int>(std::min(k + 1, m_nodes.samples.size() - 1));
      const int here = static_cast<int>(k);
      const float corners[4] = {seen.distance(above, here), seen.distance(above, next),
                                seen.distance(below, here), seen.distance(below, next)};
      const float nearest = *std::min_element(corners, corners + 4);
      if (nearest > m_sure) {
        continue;
      }
      const bool inside = *std::max_element(corners, corners + 4) < -m_sure;
      const int end = here == next ? m_nodes.samples[k] + 1 : m_nodes.samples[static_cast<size_t>(next)];
      for (int sample = m_nodes.samples[k]; sample < end; ++sample) {
        const float hidden = inside ? 1.f : shareAt(*seen.person, wMc, time, m_grid.pixel(line, sample));
        light[sample] += hidden * (level - light[sample]);
      }
    }
  }
}

END_VISP_NAMESPACE
