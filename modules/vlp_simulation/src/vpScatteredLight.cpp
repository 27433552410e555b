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

/*!
  An emission pattern blurred by a Gaussian: the sum of the blurs of cells so small that they pass for points.
  px, in the lamp's axes.
*/
class BlurredEmission
{
public:
  BlurredEmission(const vpEmitter &emitter, double halfX, double halfY, double sigma)
      : m_half(halfX, halfY), m_sigma(sigma),
        m_across(static_cast<int>(std::clamp(std::ceil(4 * halfX / sigma), least, most))),
        m_cells(m_across, m_across)
  {
    static const int points = 8; // across a cell
    for (int row = 0; row < m_across; ++row) {
      for (int column = 0; column < m_across; ++column) {
        double sum = 0;
        for (int k = 0; k < points * points; ++k) {
          const Eigen::Vector2d at(column + (k % points + 0.5) / points, row + (k / points + 0.5) / points);
          const Eigen::Vector2d place = 2 * at / m_across - Eigen::Vector2d::Ones();
          sum += emitter.covers(place) ? emitter.emission->at(place) : 0;
        }
        m_cells(row, column) = sum / (points * points);
      }
    }
  }

  double at(const Eigen::Vector2d &pixel) const
  {
    const std::vector<double> x = weights(pixel.x(), m_half.x()), y = weights(pixel.y(), m_half.y());
    double sum = 0;
    for (int row = 0; row < m_across; ++row) {
      for (int column = 0; y[row] > 0 && column < m_across; ++column) {
        sum += y[row] * x[column] * m_cells(row, column);
      }
    }
    return sum;
  }

private:
  static constexpr double least = 4; // cells across
  static constexpr double most =
      64; // a halo so narrow that it wants more hardly leaves the cell it comes from

  //! Of each column or row of cells.
  std::vector<double> weights(double at, double half) const
  {
    const double cell = 2 * half / m_across;
    std::vector<double> weight(static_cast<size_t>(m_across), 0.0);
    for (int k = 0; k < m_across; ++k) {
      const double away = at + half - (k + 0.5) * cell;
      if (std::abs(away) < 5 * m_sigma + 0.5 * cell) {
        weight[static_cast<size_t>(k)] = within(away, 0.5 * cell, m_sigma);
      }
    }
    return weight;
  }

  Eigen::Vector2d m_half;
  double m_sigma;
  int m_across;
  cv::Mat_<double> m_cells;
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
  std::optional<BlurredEmission> emission;
  if (halo && emitter.emission) {
    emission.emplace(emitter, halfX, halfY, m_radius);
  } else if (halo && emitter.disc) {
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
      if (scene.ceilingShare > 0 && emitter.glows) {
        const double fall = 1 + at.squaredNorm() / (scene.ceilingRadius * scene.ceilingRadius);
        share += scene.ceilingShare / (fall * fall);
      }
      if (halo) {
        at /= scale; // px
        share += m_share * (emission ? emission->at(at)
                            : disc   ? disc->at(at.norm())
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
