/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpScatteredLight.h"

#include <algorithm>
#include <cmath>
#include <optional>

BEGIN_VISP_NAMESPACE

namespace
{
//! Gaussian integral from -half to half about \e x, in standard deviations \e sigma.
double within(double x, double half, double sigma)
{
  const double scale = M_SQRT1_2 / sigma;
  return 0.5 * (std::erf((x + half) * scale) - std::erf((x - half) * scale));
}

//! A disc blurred by a Gaussian, by its distance from the middle: a table, linear between its entries. px.
class BlurredDisc
{
public:
  BlurredDisc(double radius, double sigma) : m_step(std::max(0.1 * sigma, radius / longest))
  {
    const double reach = radius + 5 * sigma;
    static const int strips =
        48; // along the disc, by Gauss's rule for the chord's weight: no end to be missed
    const double widest = std::asin(std::min(1.0, 6 * sigma / radius)); // rad, beyond which nothing gets here
    for (double rho = 0; rho < reach + m_step; rho += m_step) {
      double sum = 0;
      for (int k = 0; k < strips; ++k) {
        // y = radius sin(angle): the chord's end falls like a root, which this takes out of the integral.
        const double angle = 2 * widest * ((k + 0.5) / strips - 0.5);
        const double y = radius * std::sin(angle), chord = radius * std::cos(angle);
        const double density = std::exp(-0.5 * y * y / (sigma * sigma)) / (sigma * std::sqrt(2 * M_PI));
        sum += density * within(rho, chord, sigma) * chord;
      }
      m_share.push_back(sum * 2 * widest / strips);
    }
  }

  double at(double rho) const
  {
    const double x = rho / m_step;
    if (!(x < static_cast<double>(m_share.size() - 1))) {
      return 0;
    }
    const auto k = static_cast<size_t>(x);
    return m_share[k] + (x - static_cast<double>(k)) * (m_share[k + 1] - m_share[k]);
  }

private:
  static constexpr double longest =
      20000; // entries; a disc that would need more is far larger than any picture

  double m_step;
  std::vector<double> m_share;
};

//! Metres of the emitter's plane that a pixel of the sensor spans at its middle; 0 where the camera cannot
//! see it.
double metresPerPixel(const vpSensorGrid &grid, const vpEmitterView &view)
{
  Eigen::Vector2d pixel, right, left;
  if (!grid.project(view.inCamera(Eigen::Vector2d::Zero()), pixel) ||
      !view.at(grid.rayAt(pixel + Eigen::Vector2d(0.5, 0)), right) ||
      !view.at(grid.rayAt(pixel - Eigen::Vector2d(0.5, 0)), left)) {
    return 0;
  }
  return (right - left).norm();
}

int stepOf(const vpSensorGrid &grid, const vpSimulatedCamera &camera)
{
  static const double longest = 20; // px of the sensor
  const double step = camera.haloShare > 0 ? std::min(longest, 0.3 * camera.haloRadius) : longest;
  return std::max(1, static_cast<int>(step / grid.spacing()));
}
} // namespace

vpScatteredLight::vpScatteredLight(const vpSensorGrid &grid, const vpSimulatedCamera &camera)
    : m_grid(grid), m_share(camera.haloShare), m_radius(camera.haloRadius),
      m_nodes(grid.whole().size(), stepOf(grid, camera))
{
}

cv::Mat_<float> vpScatteredLight::of(const vpEmitter &emitter, const vpSimulatedScene &scene,
                                     const std::vector<vpHomogeneousMatrix> &wMc) const
{
  cv::Mat_<float> light(m_nodes.size(), 0.f);
  const vpEmitterView middle(emitter, wMc[wMc.size() / 2]);
  const double scale = middle.visible() ? metresPerPixel(m_grid, middle) : 0; // hardly changes during a frame
  const bool halo = m_share > 0 && scale > 0;
  const double halfX = halo ? emitter.halfX / scale : 0, halfY = halo ? emitter.halfY / scale : 0; // px
  std::optional<BlurredDisc> disc;
  if (halo && emitter.disc) {
    disc.emplace(halfX, m_radius);
  }
  for (int node = 0; node < light.rows; ++node) {
    const vpEmitterView view(emitter, wMc[static_cast<size_t>(node)]);
    for (int k = 0; view.visible() && k < light.cols; ++k) {
      Eigen::Vector2d at;
      if (!view.at(m_grid.ray(m_nodes.lines[node], m_nodes.samples[k]), at)) {
        continue;
      }
      double share = 0;
      if (scene.ceilingShare > 0) {
        const double fall = 1 + at.squaredNorm() / (scene.ceilingRadius * scene.ceilingRadius);
        share += scene.ceilingShare / (fall * fall);
      }
      if (halo) {
        at /= scale; // px
        share += m_share * (disc ? disc->at(at.norm())
                                 : within(at.x(), halfX, m_radius) * within(at.y(), halfY, m_radius));
      }
      light(node, k) = static_cast<float>(emitter.level * share);
    }
  }
  return light;
}

std::vector<vpScatteredLight::Lamp> vpScatteredLight::of(const std::vector<vpEmitter> &emitters,
                                                         const vpSimulatedScene &scene,
                                                         const std::vector<vpHomogeneousMatrix> &wMc) const
{
  static const float visible = 0.01f; // grey levels
  std::vector<Lamp> lamps;
  for (const vpEmitter &emitter : emitters) {
    if (!emitter.lamp || (m_share <= 0 && scene.ceilingShare <= 0)) {
      continue;
    }
    const cv::Mat_<float> light = of(emitter, scene, wMc);
    double brightest = 0;
    cv::minMaxLoc(light, nullptr, &brightest);
    if (brightest > visible) {
      lamps.push_back({&emitter, light});
    }
  }
  return lamps;
}

END_VISP_NAMESPACE
