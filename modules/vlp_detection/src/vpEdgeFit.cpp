/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpEdgeFit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "vpEllipseEdges.h"
#include "vpQuadrilateralEdges.h"

BEGIN_VISP_NAMESPACE

namespace
{

//! Reorders them.
double median(std::vector<double> &values)
{
  if (values.empty()) {
    return 0;
  }
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

} // namespace

template <>
void vpEdgeFit<vpQuadrilateralModel>::addEnds(int from, int to)
{
  vpQuadrilateralEdges(*m_lines, *m_v, *m_u, m_model, m_blur, {m_middle, m_shading}, m_reach)
      .find(from, to, m_memory->ends, m_memory->along);
}

template <>
void vpEdgeFit<vpEllipseModel>::addEnds(int from, int to)
{
  vpEllipseEdges::linesOf(*m_lines, from, to, m_model, m_every, m_litOnly, m_memory->lines, m_memory->light);
  vpEllipseEdges(*m_lines, *m_v, *m_u, m_aligned, m_model, m_blur, m_shading, m_reach)
      .find(m_memory->lines, m_memory->ends, m_memory->along);
}

template <class Model>
void vpEdgeFit<Model>::findEnds()
{
  double top, bottom;
  m_model.vertical(top, bottom);
  const int from = std::max(m_first, static_cast<int>(std::floor(top)) - 1);
  const int to = std::min(m_last, static_cast<int>(std::ceil(bottom)) + 1);
  m_memory->clear(2 * static_cast<size_t>(std::max(0, to - from + 1)));
  addEnds(from, to);
}

/*!
  Normal equations of all ends. An end's variance is that of its own residuals or the median of all, whichever
  is more; an end that would move the edge far beyond what the others want is let go of.
*/
template <class Model>
void vpEdgeFit<Model>::assemble(Equations &equations)
{
  const size_t ends = m_memory->ends.size();
  std::vector<double> &offsets = m_memory->offsets, &sorted = m_memory->sorted;
  offsets.resize(ends);
  sorted.resize(ends);
  for (size_t i = 0; i < ends; ++i) {
    const End &end = m_memory->ends[i];
    offsets[i] = end.offset();
    // What the end's own best shift leaves: from a start a pixel off, all ends misfit, and none is dark for
    // it.
    const double left = end.squares - offsets[i] * end.shift;
    sorted[i] = std::max(0.0, left) / std::max(1, end.pixels - 3);
  }
  const double noise = std::max(median(sorted), 0.05); // 8 bits round: 1/12, less where all is dark
  auto shines = [noise](const End &end) { return end.amplitude > 0 && end.shiftShift > 4 * noise; };
  sorted.clear();
  for (size_t i = 0; i < ends; ++i) {
    if (shines(m_memory->ends[i])) {
      sorted.push_back(std::abs(offsets[i]));
    }
  }
  const double scale = 1.4826 * std::max(median(sorted), 0.02);
  equations = Equations();
  Equations crossing; // the lower half of what they say that cross their lines
  sorted.clear();
  double squares = 0, weights = 0, pixels = 0, chiSquare = 0, members = 0, kept = 0;
  for (size_t i = 0; i < m_memory->ends.size(); ++i) {
    const End &end = m_memory->ends[i];
    if (!shines(end)) {
      continue;
    }
    sorted.push_back(end.background);
    chiSquare += end.squares;
    pixels += end.pixels;
    // An end is no outlier for being noisy: its own doubt widens the limit.
    const double variance = std::max(end.squares / std::max(1, end.pixels - 2), noise),
                 own = std::sqrt(variance / end.shiftShift);
    const double z = offsets[i] / (4.685 * std::max(scale, own));
    if (std::abs(z) >= 1) {
      continue;
    }
    ++kept;
    const double tukey = (1 - z * z) * (1 - z * z), weight = tukey / variance;
    if (end.along >= 0) {
      equations.H += weight * m_memory->along[static_cast<size_t>(end.along)].H;
      equations.g += weight * m_memory->along[static_cast<size_t>(end.along)].g;
    } else {
      for (int k = 0; k < N - 1; ++k) {
        const double outward = weight * end.outward(k), shift = end.shiftShift * outward;
        for (int l = k; l < N - 1; ++l) {
          crossing.H(l, k) += shift * end.outward(l);
        }
        crossing.H(N - 1, k) += end.shiftBlur * outward;
        crossing.g(k) += end.shift * outward;
      }
      crossing.H(N - 1, N - 1) += weight * end.blurBlur;
      crossing.g(N - 1) += weight * end.blur;
    }
    squares += weight * end.shift * offsets[i];
    weights += weight * end.shiftShift;
    members += tukey;
  }
  equations.H += crossing.H.template selfadjointView<Eigen::Lower>();
  equations.g += crossing.g;
  m_residual = weights > 0 ? std::sqrt(squares / weights) : 0;
  // Ends scatter more than their pixels' noise says where the edge is no Gaussian: the covariance is to say
  // so, and the fewer they are the less they know of their own scatter.
  m_inflation = members > N ? std::max(1.0, squares / (members - N)) * (1 + 2 / (members - N)) : 3;
  m_background = median(sorted);
  m_noise = std::sqrt(noise);
  m_misfit = pixels > 0 ? chiSquare / pixels : 0;
  m_pixels = pixels;
  m_members = members;
  m_shining = m_memory->ends.empty()
                  ? 0
                  : static_cast<double>(sorted.size()) / static_cast<double>(m_memory->ends.size());
  m_kept = sorted.empty() ? 0 : kept / static_cast<double>(sorted.size());
}

//! How fast the light grows along the lines, by the amplitudes of their two ends, where both show an edge.
template <class Model>
double vpEdgeFit<Model>::shadingOfEnds() const
{
  static const double scatter = 0.3; // of an end's amplitude about its other's: more, and something hides it
  const std::vector<End> &ends = m_memory->ends;
  double slope = 0, weight = 0;
  for (size_t i = 1; i < ends.size(); ++i) {
    const End &first = ends[i - 1], &last = ends[i];
    const double light = 0.5 * (first.amplitude + last.amplitude), more = last.amplitude - first.amplitude,
                 length = last.crossing - first.crossing;
    if (first.line == last.line && first.along < 0 && last.along < 0 && first.amplitude > 0 &&
        last.amplitude > 0 && std::abs(more) < scatter * light) {
      slope += more * light * length;
      weight += light * light * length * length;
    }
  }
  static const double most = 0.2; // of the light, over half of the lamp
  const double limit = most / m_model.radius();
  return weight > 0 ? std::clamp(m_shading + slope / weight, -limit, limit) : 0;
}

/*!
  Gauss-Newton from the start model. False where the lamp has no edge to fit: no ends that show one, a blur
  that outgrows any lens, a middle that wanders off or stays unknown.
*/
template <class Model>
bool vpEdgeFit<Model>::run(const cv::Rect &box, double shapeSigma, const Steps &steps, double blur)
{
  static const double fewest = 3;     // ends
  static const double sharpest = 0.1; // px of blur; the pixels themselves hide anything sharper
  Eigen::Matrix<double, N, N> H, data;
  Eigen::Matrix<double, N, 1> g;
  Equations equations;
  const double radius = m_model.radius();
  const double widest = 0.15 * radius + 1;
  const Eigen::Vector2d start = m_model.centre();
  m_middle = box.x + 0.5 * (box.width - 1);
  const int beyond = 2 + box.height / 8; // lines, that the region may have fallen short of
  m_first = std::max(0, box.y - beyond);
  m_last = std::min(m_lines->rows, box.br().y + beyond) - 1;
  m_blur = std::clamp(blur > 0 ? blur : std::clamp(0.03 * radius, 0.7, 4.0), sharpest, widest);
  const bool likely = blur > 0;
  int sparse = steps.sparse;
  static const double many = 12; // ends, of all directions by chance alone
  int soft = 0;
  for (int i = 0; i < steps.most; ++i) {
    m_every = i < sparse ? 3 : 1;
    m_litOnly = steps.litOnly || i < sparse;
    m_reach = std::clamp(3 * m_blur + 2, 4.0, std::max(4.0, 0.4 * m_model.radius()));
    findEnds();
    assemble(equations);
    if (m_every > 1 && m_members < many) { // the others may all be dark
      sparse = 0;
      continue;
    }
    soft = m_blur >= widest ? soft + 1 : 0;
    if (m_members < fewest || soft > 2) {
      return false;
    }
    data = H = equations.H;
    g = equations.g;
    m_prior = m_model.addPrior(shapeSigma, H, g);
    H.diagonal().array() += 1e-9;
    if (likely && i < sparse) { // a start that is a little off looks blurred: the blur is held
      H.row(N - 1).setZero();
      H.col(N - 1).setZero();
      H(N - 1, N - 1) = 1;
      g(N - 1) = 0;
    }
    Eigen::Matrix<double, N, 1> step = H.ldlt().solve(g);
    if (!step.allFinite()) {
      return false;
    }
    const double longest = step.template head<2>().norm();
    const double limit = 0.15 * radius;
    if (longest > limit) {
      step *= limit / longest;
    }
    const typename Model::Vector outlineStep =
        step.template head<Model::parameters>().cwiseMax(-limit).cwiseMin(limit);
    m_model.advance(outlineStep);
    const double before = m_blur, shadingBefore = m_shading;
    static const double close = 0.3; // px: from farther off amplitudes are not yet the light's
    if (outlineStep.cwiseAbs().maxCoeff() < close) {
      m_shading = shadingOfEnds();
    }
    m_blur = std::clamp(before + std::clamp(step(N - 1), -0.5 * before, 0.5 * before), sharpest, widest);
    if (!m_model.plausible(box) || (m_model.centre() - start).norm() > 0.3 * radius + 2) {
      return false;
    }
    static const double near = 0.05; // px: from there all lines together are quicker
    if (likely && i < sparse && outlineStep.cwiseAbs().maxCoeff() < near) {
      sparse = i + 1;
      continue;
    }
    static const double ofBlur = 0.05, ofShading = 0.001; // px: blur moves no edge, shading all by as much
    const double byShading = std::abs(m_shading - shadingBefore) * m_reach * m_reach / 3; // px, about
    if (i >= sparse && outlineStep.cwiseAbs().maxCoeff() < steps.still &&
        std::abs(m_blur - before) < ofBlur && byShading < ofShading) {
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
  double edges = 0, peaks = 0;
  int line = -1;
  double peak = 0; // of that line
  for (const End &end : m_memory->ends) {
    double first, last;
    if (!m_model.stretch((*m_v)[end.line], 0, first, last)) {
      continue;
    }
    if (end.line != line) {
      line = end.line;
      const unsigned char *row = (*m_lines)[line];
      const int left = std::max(0, static_cast<int>(first));
      const int right = std::min(m_lines->cols - 1, static_cast<int>(last) + 1);
      peak = left < right ? *std::max_element(row + left, row + right + 1) : 0.0;
    }
    edges += std::max(0.0, end.amplitude);
    peaks += std::max(0.0, peak - end.background);
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
