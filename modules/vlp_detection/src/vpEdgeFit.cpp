/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpEdgeFit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <visp3/vlp_core/vpPixelEdge.h>

BEGIN_VISP_NAMESPACE

namespace
{

double median(std::vector<double> values)
{
  if (values.empty()) {
    return 0;
  }
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

} // namespace

template <class Model>
std::optional<typename vpEdgeFit<Model>::End> vpEdgeFit<Model>::lineEnd(int line, double first,
                                                                        double last) const
{
  const int from = std::max(0, static_cast<int>(std::ceil(first)));
  const int to = std::min(m_lines.cols - 1, static_cast<int>(std::floor(last)));
  if (to - from < 3) {
    return std::nullopt;
  }
  // Columns: 1, D; then the derivatives of D by the model's parameters and the blur.
  const unsigned char *row = m_lines[line];
  const int n = to - from + 1;
  Eigen::Matrix<double, Eigen::Dynamic, N> J(n, N);
  Eigen::VectorXd D(n);
  Eigen::VectorXd I(n);
  Eigen::VectorXd slope(n);
  for (int i = 0; i < n; ++i) {
    typename Model::Vector derivative;
    Eigen::Vector2d normal;
    const double d = m_model.distance({m_u[from + i], m_v[line]}, derivative, normal);
    const vpPixelEdge edge = vpPixelEdge::at(d, normal, m_blur);
    D(i) = edge.share;
    J.row(i) << -edge.byShift * derivative.transpose(), edge.byBlur;
    I(i) = row[from + i];
    slope(i) = edge.byShift;
  }
  if (D.maxCoeff() < 0.6 || D.minCoeff() > 0.4) {
    return std::nullopt; // the edge itself is not in it
  }
  const double meanI = I.mean();
  const double meanD = D.mean();
  I.array() -= meanI;
  D.array() -= meanD;
  slope.array() -= slope.mean();
  J.rowwise() -= J.colwise().mean().eval();
  const double DD = D.squaredNorm();
  End end;
  end.amplitude = D.dot(I) / DD;
  end.background = meanI - end.amplitude * meanD;
  const Eigen::VectorXd residual = I - end.amplitude * D;
  J -= D * (D.transpose() * J / DD);
  J *= end.amplitude;
  slope = end.amplitude * (slope - D * (D.dot(slope) / DD));
  end.H = J.transpose() * J;
  end.g = J.transpose() * residual;
  end.squares = residual.squaredNorm();
  end.pixels = n;
  end.offsetWeight = slope.squaredNorm();
  end.offset = slope.dot(residual) / std::max(end.offsetWeight, 1e-12);
  return end;
}

template <class Model>
void vpEdgeFit<Model>::collect(int line, double v, std::vector<End> &ends) const
{
  double outerFirst, outerLast, first, last, innerFirst, innerLast;
  if (!m_model.stretch(v, 0, first, last) || !m_model.stretch(v, m_reach, outerFirst, outerLast)) {
    return;
  }
  // Where the outline crosses the line at a slant, the same distance from the edge is a longer stretch.
  auto add = [&](double from, double to) {
    if (!m_model.crossedWell(v, from <= first, to >= last)) {
      return;
    }
    if (auto end = lineEnd(line, from, to)) {
      ends.push_back(*end);
    }
  };
  if (m_model.stretch(v, -m_reach, innerFirst, innerLast) && innerLast - innerFirst > 1) {
    add(outerFirst, innerFirst);
    add(innerLast, outerLast);
  } else {
    add(outerFirst, outerLast);
  }
}

template <class Model>
std::vector<typename vpEdgeFit<Model>::End> vpEdgeFit<Model>::lineEnds() const
{
  double top, bottom;
  m_model.vertical(top, bottom);
  std::vector<End> ends;
  const int from = std::max(0, static_cast<int>(std::floor(top)) - 1);
  const int to = std::min(m_lines.rows - 1, static_cast<int>(std::ceil(bottom)) + 1);
  for (int line = from; line <= to; ++line) {
    collect(line, m_v[line], ends);
  }
  return ends;
}

/*!
  Normal equations of all ends. An end's variance is that of its own residuals or the median of all, whichever
  is more; an end that would move the edge far beyond what the others want is let go of.
*/
template <class Model>
void vpEdgeFit<Model>::assemble(const std::vector<End> &ends, Eigen::MatrixXd &H, Eigen::VectorXd &g)
{
  std::vector<double> variances, unshifted, offsets, backgrounds;
  for (const End &end : ends) {
    variances.push_back(end.squares / std::max(1, end.pixels - 2));
    // What the end's own best shift leaves: from a start a pixel off, all ends misfit, and none is dark for
    // it.
    const double left = end.squares - end.offset * end.offset * end.offsetWeight;
    unshifted.push_back(std::max(0.0, left) / std::max(1, end.pixels - 3));
  }
  const double noise = std::max(median(unshifted), 0.05); // 8 bits round: 1/12, less where all is dark
  auto lit = [&](size_t i) { return ends[i].amplitude > 0 && ends[i].offsetWeight > 4 * noise; };
  for (size_t i = 0; i < ends.size(); ++i) {
    if (lit(i)) {
      offsets.push_back(std::abs(ends[i].offset));
      backgrounds.push_back(ends[i].background);
    }
  }
  const double scale = 1.4826 * std::max(median(offsets), 0.02);
  H = Eigen::MatrixXd::Zero(N, N);
  g = Eigen::VectorXd::Zero(N);
  double squares = 0, weights = 0, pixels = 0, chiSquare = 0, members = 0;
  for (size_t i = 0; i < ends.size(); ++i) {
    // An end is no outlier for being noisy: its own doubt widens the limit.
    const double own = std::sqrt(std::max(variances[i], noise) / std::max(ends[i].offsetWeight, 1e-12));
    const double z = ends[i].offset / (4.685 * std::max(scale, own));
    if (!lit(i)) {
      continue;
    }
    chiSquare += ends[i].squares;
    pixels += ends[i].pixels;
    if (std::abs(z) >= 1) {
      continue;
    }
    const double tukey = (1 - z * z) * (1 - z * z);
    const double weight = tukey / std::max(variances[i], noise);
    H += weight * ends[i].H;
    g += weight * ends[i].g;
    squares += weight * ends[i].offsetWeight * ends[i].offset * ends[i].offset;
    weights += weight * ends[i].offsetWeight;
    members += tukey;
  }
  m_residual = weights > 0 ? std::sqrt(squares / weights) : 0;
  // Ends scatter more than their pixels' noise says where the edge is no Gaussian: the covariance is to say
  // so, and the fewer they are the less they know of their own scatter.
  m_inflation = members > N ? std::max(1.0, squares / (members - N)) * (1 + 2 / (members - N)) : 3;
  m_background = median(backgrounds);
  m_noise = std::sqrt(noise);
  m_misfit = pixels > 0 ? chiSquare / pixels : 0;
  m_pixels = pixels;
  m_members = members;
}

/*!
  Gauss-Newton from the start model. False where the lamp has no edge to fit: no ends that show one, a blur
  that outgrows any lens, a middle that wanders off or stays unknown.
*/
template <class Model>
bool vpEdgeFit<Model>::run(const cv::Rect &box, double shapeSigma, int maxIterations)
{
  static const double fewest = 3;     // ends
  static const double still = 3e-4;   // px
  static const double sharpest = 0.1; // px of blur; the pixels themselves hide anything sharper
  Eigen::MatrixXd H, data;
  Eigen::VectorXd g;
  const double radius = m_model.radius();
  const double widest = 0.15 * radius + 1;
  const Eigen::Vector2d start = m_model.centre();
  m_blur = std::clamp(0.03 * radius, 0.7, 4.0);
  int soft = 0;
  for (int i = 0; i < maxIterations; ++i) {
    m_reach = std::clamp(3 * m_blur + 2, 4.0, std::max(4.0, 0.4 * m_model.radius()));
    assemble(lineEnds(), H, g);
    soft = m_blur >= widest ? soft + 1 : 0;
    if (m_members < fewest || soft > 2) {
      return false;
    }
    data = H;
    m_prior = m_model.addPrior(shapeSigma, H, g);
    H.diagonal().array() += 1e-9;
    Eigen::VectorXd step = H.ldlt().solve(g);
    if (!step.allFinite()) {
      return false;
    }
    const double longest = step.head(2).norm();
    const double limit = 0.15 * radius;
    if (longest > limit) {
      step *= limit / longest;
    }
    const typename Model::Vector outlineStep =
        step.template head<Model::parameters>().cwiseMax(-limit).cwiseMin(limit);
    m_model.advance(outlineStep);
    const double blur = m_blur;
    m_blur = std::clamp(blur + std::clamp(step(N - 1), -0.5 * blur, 0.5 * blur), sharpest, widest);
    if (!m_model.plausible(box) || (m_model.centre() - start).norm() > 0.3 * radius + 2) {
      return false;
    }
    if (outlineStep.cwiseAbs().maxCoeff() < still && std::abs(m_blur - blur) < 10 * still) {
      break;
    }
  }
  // What the ends scatter says of the ends, not of the prior.
  m_covariance = (H - data + data / m_inflation).inverse();
  if (!m_covariance.allFinite() || m_covariance.diagonal().minCoeff() < 0) {
    return false;
  }
  const double doubt = std::sqrt(m_model.outline(m_covariance).centreCovariance.trace());
  return doubt < 0.3 * radius;
}

template <class Model>
double vpEdgeFit<Model>::evenness() const
{
  double top, bottom, edges = 0, peaks = 0;
  m_model.vertical(top, bottom);
  const int from = std::max(0, static_cast<int>(std::ceil(top)));
  const int to = std::min(m_lines.rows - 1, static_cast<int>(std::floor(bottom)));
  for (int line = from; line <= to; ++line) {
    std::vector<End> ends;
    collect(line, m_v[line], ends);
    double first, last;
    if (ends.empty() || !m_model.stretch(m_v[line], 0, first, last)) {
      continue;
    }
    const unsigned char *row = m_lines[line];
    const int left = std::max(0, static_cast<int>(first));
    const int right = std::min(m_lines.cols - 1, static_cast<int>(last) + 1);
    const double peak = left < right ? *std::max_element(row + left, row + right + 1) : 0.0;
    for (const End &end : ends) {
      edges += std::max(0.0, end.amplitude);
      peaks += std::max(0.0, peak - end.background);
    }
  }
  return peaks > 0 ? edges / peaks : 0;
}

template <class Model>
vpOutlineFit vpEdgeFit<Model>::result() const
{
  vpOutlineFit fit;
  // No lens, sensor or picture format is known better than this.
  static const double systematic = 0.004; // px
  fit.outline = m_model.outline(m_covariance);
  fit.outline.centreCovariance += systematic * systematic * Eigen::Matrix2d::Identity();
  fit.outline.residual = m_residual;
  fit.blur = m_blur;
  fit.background = m_background;
  fit.noise = m_noise;
  return fit;
}

template class vpEdgeFit<vpEllipseModel>;
template class vpEdgeFit<vpQuadrilateralModel>;

END_VISP_NAMESPACE
