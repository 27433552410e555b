/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpEmitterView.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <visp3/core/vpException.h>

BEGIN_VISP_NAMESPACE

namespace
{
//! Lengths to which a step of one pixel becomes, the longest and the shortest over all directions.
std::pair<double, double> stretches(const Eigen::Matrix2d &gradient)
{
  const double sum = gradient.squaredNorm(), product = std::abs(gradient.determinant());
  const double root = std::sqrt(std::max(0.0, sum * sum - 4 * product * product));
  const double longest = std::sqrt(0.5 * (sum + root));
  return {longest, longest > 0 ? product / longest : 0};
}
} // namespace

vpEmitter::vpEmitter(const vpSimulatedLamp &simulated)
    : centre(simulated.lamp.position), disc(simulated.lamp.shape == vpLamp::Shape::disk),
      glows(simulated.glows), level(simulated.level), blur(simulated.blur),
      rim(simulated.emission.even() ? simulated.rim : 0), light(&simulated.light),
      emission(simulated.emission.patterned() ? &simulated.emission : nullptr)
{
  const vpLamp &lamp = simulated.lamp;
  if (!(lamp.size > 0)) {
    throw vpException(vpException::badValue,
                      "lamp " + lamp.id +
                          ": its size is not known, expected a diameter or side to draw it by");
  }
  const double strip = simulated.emission.strip();
  if (disc && strip < 1) {
    throw vpException(vpException::badValue,
                      "lamp " + lamp.id + ": a disc with the emission of a tube, expected a square");
  }
  halfX = 0.5 * lamp.size;
  halfY = strip * halfX;
  x = Eigen::Vector3d(std::cos(lamp.yaw), std::sin(lamp.yaw), 0);
  y = Eigen::Vector3d(-x.y(), x.x(), 0);
  exponent = -std::log(2) / std::log(std::cos(simulated.halfPower)) - 1;
}

vpEmitter::vpEmitter(const vpSimulatedWindow &window)
    : centre(window.centre), x(window.halfWidth.normalized()), y(window.halfHeight.normalized()),
      halfX(window.halfWidth.norm()), halfY(window.halfHeight.norm()), disc(false), lamp(false),
      level(window.level), light(&window.light)
{
}

vpEmitterView::vpEmitterView(const vpEmitter &emitter, const vpHomogeneousMatrix &wMc)
{
  Eigen::Matrix3d cRw;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      cRw(k, i) = wMc[i][k];
    }
  }
  const Eigen::Vector3d camera(wMc[0][3], wMc[1][3], wMc[2][3]);
  const Eigen::Vector3d normal = emitter.x.cross(emitter.y);
  const Eigen::Vector3d to = emitter.centre - camera;
  m_x = cRw * emitter.x;
  m_y = cRw * emitter.y;
  m_normal = cRw * normal;
  m_centre = cRw * to;
  m_foot = -Eigen::Vector2d(to.dot(emitter.x), to.dot(emitter.y));
  m_height = to.dot(normal);
  m_visible = emitter.lamp ? m_height > 0 : m_height != 0; // a lamp's normal points up
}

vpEmitterShare::Neighbours vpEmitterShare::around(const vpEmitterView &view,
                                                  const Eigen::Vector2d &pixel) const
{
  Neighbours near;
  auto seen = [&](double du, double dv, Eigen::Vector2d &inPlane) {
    view.at(m_grid.rayAt(pixel + Eigen::Vector2d(du, dv)), inPlane);
  };
  seen(0.5, 0, near.right);
  seen(-0.5, 0, near.left);
  seen(0, 0.5, near.down);
  seen(0, -0.5, near.up);
  return near;
}

/*!
  Edge of a disc of radius \e bend (px) a distance \e d from the pixel: sums slices of blur and square along
  the edge, \e spread their standard deviation, each of which meets a straight edge.
*/
vpPixelEdge vpEmitterShare::acrossBend(double d, const Eigen::Vector2d &normal, double bend,
                                       double spread) const
{
  static const double slight = 25; // times the spread: there one slice, shifted by the mean sagitta, does
  if (bend > slight * spread) {
    return vpPixelEdge::at(d + 0.5 * spread * spread / bend, normal, m_blur, exact);
  }
  // Gauss-Hermite quadrature of five points, for a Gaussian of unit variance.
  static const double offsets[] = {0, 1.3556261799742659, 2.8569700138728056};
  static const double weights[] = {0.5333333333333333, 0.2220759220056126, 0.0112574113277207};
  vpPixelEdge sum{0, 0, 0};
  for (int k = 0; k < 3; ++k) {
    const double along = std::min(offsets[k] * spread, bend);
    const double sagitta = bend - std::sqrt(bend * bend - along * along);
    const vpPixelEdge edge = vpPixelEdge::at(d + sagitta, normal, m_blur, exact);
    const double weight = k == 0 ? weights[k] : 2 * weights[k];
    sum.share += weight * edge.share;
    sum.byShift += weight * edge.byShift;
    sum.byBlur += weight * edge.byBlur;
  }
  return sum;
}

double vpEmitterShare::longestStep(const vpEmitterView &view, const Eigen::Vector2d &pixel) const
{
  return stretches(around(view, pixel).gradient()).first;
}

/*!
  A disc of few pixels, or the tips of one seen aslant: sums slices of blur and square, together taken as a
  Gaussian, that run across the ellipse; each of them meets it in a chord.
*/
double vpEmitterShare::smallDisc(const vpEmitter &emitter, const Eigen::Vector2d &inPlane,
                                 const Eigen::Matrix2d &gradient) const
{
  const double spread = std::sqrt(variance()); // px
  const Eigen::Matrix2d square = gradient.transpose() * gradient;
  const double angle = 0.5 * std::atan2(2 * square(0, 1), square(0, 0) - square(1, 1)); // of the longest step
  const Eigen::Vector2d across(std::cos(angle), std::sin(angle)), along(-across.y(), across.x());
  const Eigen::Vector2d step = gradient * across, next = gradient * along; // m per pixel, at right angles
  const double radius = emitter.halfX, stride = std::max(spread * next.norm(), 1e-12 * radius);
  const double side = inPlane.dot(next) / std::max(next.norm(), 1e-12);
  static const double reach = 5; // standard deviations
  const double first = std::max(-reach, (-radius - side) / stride),
               last = std::min(reach, (radius - side) / stride);
  if (!(first < last)) {
    return 0;
  }
  static const int slices = 24; // the chords' ends fall like a root, which the sine takes out of the integral
  double sum = 0;
  for (int k = 0; k < slices; ++k) {
    const double turn = M_PI * ((k + 0.5) / slices - 0.5);
    const double x = 0.5 * (first + last) + 0.5 * (last - first) * std::sin(turn);
    const Eigen::Vector2d from = inPlane + x * spread * next;
    // |from + t step| = radius
    const double a = step.squaredNorm(), b = from.dot(step), c = from.squaredNorm() - radius * radius;
    const double root = std::sqrt(std::max(b * b - a * c, 0.0));
    const double low = (-b - root) / (a * spread), high = (-b + root) / (a * spread); // standard deviations
    const double share = 0.5 * (std::erf(high * M_SQRT1_2) - std::erf(low * M_SQRT1_2));
    // Mean and mean square of t over the chord, times the share; the rim's shade is a square of t.
    const double atLow = std::exp(-0.5 * low * low) / std::sqrt(2 * M_PI);
    const double atHigh = std::exp(-0.5 * high * high) / std::sqrt(2 * M_PI);
    const double mean = spread * (atLow - atHigh),
                 meanSquare = spread * spread * (share + low * atLow - high * atHigh);
    const double shade =
        emitter.rim / (radius * radius) * (from.squaredNorm() * share + 2 * b * mean + a * meanSquare);
    sum += std::exp(-0.5 * x * x) * std::cos(turn) * (share - shade);
  }
  return sum * 0.5 * (last - first) * M_PI / slices / std::sqrt(2 * M_PI);
}

double vpEmitterShare::disc(const vpEmitter &emitter, const Eigen::Vector2d &inPlane,
                            const Neighbours &near) const
{
  const double radius = emitter.halfX;
  const Eigen::Matrix2d plane = near.gradient();
  const auto [longest, shortest] = stretches(plane);
  static const double sharp = 4; // times the spread
  if (radius * shortest <
      sharp * std::sqrt(variance()) * longest * longest) { // the tips of the ellipse bend sharply
    return longest > 0 ? smallDisc(emitter, inPlane, plane) : 0;
  }
  const double rho = inPlane.norm();
  const double right = near.right.norm(), left = near.left.norm(), down = near.down.norm(),
               up = near.up.norm();
  const Eigen::Vector2d gradient(right - left, down - up); // m per pixel
  const double steep = std::max(gradient.norm(), 1e-12);
  // The distance from the middle is straight along its own gradient, so that all of its Laplacian is the
  // outline's bend.
  const double bend = std::max(4 * (right + left + down + up - 4 * rho) / steep, 1e-9); // 1/px
  const double d = (rho - radius) / steep;
  const vpPixelEdge edge = acrossBend(d, gradient / steep, 1 / bend - d, std::sqrt(variance()));
  if (emitter.rim == 0) {
    return edge.share;
  }
  // What is inside lies, on average, nearer to the middle than the pixel, where the disc is brighter.
  const double within = rho / radius;
  const double slope = -2 * emitter.rim * within * steep / radius; // of the brightness, outwards, 1/px
  const double middle =
      1 - emitter.rim * (within * within + variance() * plane.squaredNorm() / (radius * radius));
  return middle * edge.share - slope * variance() * edge.byShift;
}

double vpEmitterShare::rectangle(const vpEmitter &emitter, const Eigen::Vector2d &inPlane,
                                 const Neighbours &near) const
{
  const Eigen::Matrix2d gradient = near.gradient(); // row: of one plane coordinate by u and v
  const double half[2] = {emitter.halfX, emitter.halfY};
  bool corner = true;
  double product = 1;
  for (int i = 0; i < 2; ++i) {
    const double steep = std::max(gradient.row(i).norm(), 1e-12);
    const Eigen::Vector2d normal = gradient.row(i).transpose() / steep;
    product *= vpPixelEdge::at((inPlane(i) - half[i]) / steep, normal, m_blur, exact).share +
               vpPixelEdge::at((-inPlane(i) - half[i]) / steep, normal, m_blur, exact).share - 1;
    corner = corner && std::abs(std::abs(inPlane(i)) - half[i]) < band() * steep;
  }
  if (!corner) {
    return std::max(product, 0.0);
  }
  // The pixel's square is no product along the sides: cells of it, small enough, nearly are.
  static const int cells = 8;
  const double blur = std::sqrt(m_blur * m_blur + 1.0 / 12 / (cells * cells));
  double sum = 0;
  for (int row = 0; row < cells; ++row) {
    for (int column = 0; column < cells; ++column) {
      const Eigen::Vector2d offset((column + 0.5) / cells - 0.5, (row + 0.5) / cells - 0.5);
      const Eigen::Vector2d at = inPlane + gradient * offset;
      double share = 1;
      for (int i = 0; i < 2; ++i) {
        const double sigma = blur * gradient.row(i).norm(); // m
        share *= 0.5 * (std::erf((at(i) + half[i]) * M_SQRT1_2 / sigma) -
                        std::erf((at(i) - half[i]) * M_SQRT1_2 / sigma));
      }
      sum += share;
    }
  }
  return sum / (cells * cells);
}

double vpEmitterShare::emission(const vpEmitter &emitter, const vpEmitterView &view,
                                const Eigen::Vector2d &pixel, const Eigen::Vector2d &inPlane) const
{
  const Eigen::Matrix2d gradient = around(view, pixel).gradient();
  return gradient.allFinite() ? m_mean.at(emitter, inPlane, gradient) : 0;
}

double vpEmitterShare::at(const vpEmitter &emitter, const vpEmitterView &view, const Eigen::Vector2d &pixel,
                          const Eigen::Vector2d &inPlane) const
{
  const Neighbours near = around(view, pixel);
  if (!near.gradient().allFinite()) {
    return 0; // at the horizon
  }
  const Eigen::Vector2d half(emitter.halfX, emitter.halfY);
  const Eigen::Vector2d nearest =
      emitter.disc ? Eigen::Vector2d(inPlane * std::min(1.0, emitter.halfX / inPlane.norm()))
                   : Eigen::Vector2d(inPlane.cwiseMin(half).cwiseMax(-half));
  // Towards the horizon of its plane, pixels span more and more of it: what is beyond the emitter by a good
  // part of the way there lies farther from it in the picture than the pixel's own span says.
  static const double far = 0.3; // share of that way
  Eigen::Vector2d there;
  if ((inPlane - nearest).norm() > far * view.distance(inPlane) &&
      m_grid.project(view.inCamera(nearest), there) && (there - pixel).norm() > band()) {
    return 0;
  }
  return emitter.disc ? disc(emitter, inPlane, near) : rectangle(emitter, inPlane, near);
}

END_VISP_NAMESPACE
