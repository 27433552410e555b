/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpEmissionMean.h"

#include <cmath>

#include <Eigen/LU>

BEGIN_VISP_NAMESPACE

namespace
{
constexpr int points = 89, stride = 55; // neighbours in Fibonacci's sequence

//! Share of a pixel's square, blurred by a Gaussian of \e sigma (px), that lies left of \e x (px).
double leftOf(double x, double sigma)
{
  auto integral = [](double z) { // of the normal distribution function
    return 0.5 * z * std::erfc(-z * M_SQRT1_2) + std::exp(-0.5 * z * z) / std::sqrt(2 * M_PI);
  };
  return sigma * (integral((x + 0.5) / sigma) - integral((x - 0.5) / sigma));
}

//! Offset left of which that \e share lies.
double quantile(double share, double sigma)
{
  double low = -10 * sigma - 1, high = -low;
  for (int halving = 0; halving < 50; ++halving) {
    const double middle = 0.5 * (low + high);
    (leftOf(middle, sigma) < share ? low : high) = middle;
  }
  return 0.5 * (low + high);
}
} // namespace

vpEmissionMean::vpEmissionMean(double blur) : m_variance(blur * blur + 1.0 / 12)
{
  std::vector<double> quantiles;
  double squares = 0;
  for (int k = 0; k < points; ++k) {
    quantiles.push_back(quantile((k + 0.5) / points, blur));
    squares += quantiles.back() * quantiles.back() / points;
  }
  // So wide as blur and square truly are: then what bends evenly has its exact mean.
  const double wider = std::sqrt(m_variance / squares);
  for (int k = 0; k < points; ++k) {
    m_offsets.emplace_back(wider * quantiles[k], wider * quantiles[k * stride % points]);
  }
}

double vpEmissionMean::at(const vpEmitter &emitter, const Eigen::Vector2d &inPlane,
                          const Eigen::Matrix2d &gradient) const
{
  const double area = std::abs(gradient.determinant()); // m^2 per pixel
  const double longest = emitter.reach() * gradient.norm();
  static const double few = 3;                                     // standard deviations of blur and square
  const bool small = longest < few * std::sqrt(m_variance) * area; // its radius in pixels, the longest
  return small ? overEmitter(emitter, inPlane, gradient) : overPixel(emitter, inPlane, gradient);
}

double vpEmissionMean::overPixel(const vpEmitter &emitter, const Eigen::Vector2d &inPlane,
                                 const Eigen::Matrix2d &gradient) const
{
  double sum = 0;
  int inside = 0;
  for (const Eigen::Vector2d &offset : m_offsets) {
    const Eigen::Vector2d place = emitter.place(inPlane + gradient * offset);
    if (emitter.covers(place)) {
      sum += emitter.emission->at(place);
      ++inside;
    }
  }
  if (inside == 0) { // all of the little that it sees is the outline nearest to it
    const Eigen::Vector2d place = emitter.place(inPlane);
    return emitter.emission->at(emitter.disc ? Eigen::Vector2d(place / std::max(1.0, place.norm()))
                                             : Eigen::Vector2d(place.cwiseMin(1.0).cwiseMax(-1.0)));
  }
  return sum / inside;
}

double vpEmissionMean::overEmitter(const vpEmitter &emitter, const Eigen::Vector2d &inPlane,
                                   const Eigen::Matrix2d &gradient) const
{
  const Eigen::Matrix2d toPixels = gradient.inverse();
  static const int across = 24;
  double sum = 0, weights = 0;
  for (int row = 0; row < across; ++row) {
    for (int column = 0; column < across; ++column) {
      const Eigen::Vector2d place(2 * (column + 0.5) / across - 1, 2 * (row + 0.5) / across - 1);
      if (!emitter.covers(place)) {
        continue;
      }
      const Eigen::Vector2d metres(place.x() * emitter.halfX, place.y() * emitter.halfY);
      const double weight =
          std::exp(-0.5 * (toPixels * (metres - inPlane)).squaredNorm() / m_variance) + 1e-300;
      sum += weight * emitter.emission->at(place);
      weights += weight;
    }
  }
  return sum / weights;
}

END_VISP_NAMESPACE
