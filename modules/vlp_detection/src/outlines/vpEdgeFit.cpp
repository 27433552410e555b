/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpEdgeFit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "vpEllipseEdges.h"
#include "vpQuadrilateralEdges.h"
#include <visp3/vlp_core/vpBrighter.h>

BEGIN_VISP_NAMESPACE

namespace
{

//! Reorders them. 0 where there are none.
double median(std::vector<float> &values)
{
  if (values.empty()) {
    return 0;
  }
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/*!
  By how much light that is not even may move the middle, px. Light that grows inwards makes a blurred edge
  seem farther in, by the square of its blur times the growth: to one side of an uneven emitter more than to
  the other. All of the growth may lie within the pixels that the edge is fitted to, \e reach on either side.
  Of a lamp that white clips the edge lies farther out where it is brighter, by a blur at most.
*/
double unevenSigma(const vpOutlineFit &fit, const vpLampEvenness &evenness, double reach)
{
  auto excess = [](double even) { return std::min(1.0, 1 / even - 1); }; // no light: 1 / 0
  return std::hypot(fit.blur * fit.blur / reach * excess(evenness.edges),
                    fit.clippedBlur() * excess(evenness.spared));
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
  static const size_t some = 16, all = std::numeric_limits<size_t>::max();
  Listed &listed = m_listed; // as the outline moves by less than a line, lines that were lit are
  if (!m_litOnly || listed.some != m_some || std::abs(from - listed.from) > 1 ||
      std::abs(to - listed.to) > 1) {
    listed = {from, to, m_some};
    vpEllipseEdges::linesOf(*m_lines, from, to, m_model, m_some ? some : all, m_litOnly, m_memory->lines,
                            m_memory->light);
  }
  vpEllipseEdges(*m_lines, *m_v, *m_u, m_aligned, m_model, m_blur, m_shading, m_reach)
      .find(m_memory->lines, !m_some, m_memory->ends, m_memory->along);
}

template <class Model>
void vpEdgeFit<Model>::findEnds()
{
  double top, bottom;
  m_model.vertical(top, bottom);
  const int from = std::max(m_first, static_cast<int>(std::floor(top)) - 1);
  const int to = std::min(m_last, static_cast<int>(std::ceil(bottom)) + 1);
  m_memory->clear(static_cast<size_t>(std::max(0, to - from + 1)));
  addEnds(from, to);
}

//! Of the ends for which \e which is set. Until the next call.
template <class Model>
std::vector<float> &vpEdgeFit<Model>::valuesOf(vpLanes::Floats vpLineEnds<N>::*value,
                                               vpLanes::Integers vpLineEnds<N>::*which) const
{
  std::vector<float> &some = m_memory->sorted;
  some.clear();
  for (const EightLines &lines : m_memory->ends) {
    for (const vpLineEnds<N> &end : lines.sides) {
      for (int lane = 0; lane < vpLanes::count; ++lane) {
        if ((end.*which)[lane] != 0) {
          some.push_back((end.*value)[lane]);
        }
      }
    }
  }
  return some;
}

//! Normal equations of all ends.
template <class Model>
void vpEdgeFit<Model>::assemble(Equations &equations)
{
  std::vector<EightLines> &ends = m_memory->ends;
  vpEndSums::judge(ends);
  std::vector<float> &variances = valuesOf(&vpLineEnds<N>::variance, &vpLineEnds<N>::valid);
  const double noise = std::max(median(variances), 0.05); // 8 bits round: 1/12, less where all is dark
  const auto found = static_cast<double>(variances.size());
  // From a start far off, edges that are where they should not be are what passes for noise.
  const float clear = m_some && m_litShine ? 0.f : static_cast<float>(4 * noise);
  for (EightLines &lines : ends) {
    for (vpLineEnds<N> &end : lines.sides) {
      end.shines = end.valid & (end.amplitude > 0) & (end.shiftShift > clear);
    }
  }
  std::vector<float> &offsets = valuesOf(&vpLineEnds<N>::offset, &vpLineEnds<N>::shines);
  std::transform(offsets.begin(), offsets.end(), offsets.begin(),
                 [](float offset) { return std::abs(offset); });
  const double scale = 1.4826 * std::max(median(offsets), 0.02);
  vpEndSums::Sums<N> sums;
  vpEndSums::weigh(ends, noise, scale, sums);
  equations = sums.equations;
  for (const EightLines &lines : ends) {
    const vpLineEnds<N> &end = lines.sides[0];
    for (int lane = 0; lane < vpLanes::count; ++lane) {
      if (end.along[lane] >= 0) {
        const Equations &along = m_memory->along[static_cast<size_t>(end.along[lane])];
        equations.H += end.weight[lane] * along.H;
        equations.g += end.weight[lane] * along.g;
      }
    }
  }
  m_residual = sums.shiftShift > 0 ? std::sqrt(sums.shift / sums.shiftShift) : 0;
  // Ends scatter more than their pixels' noise says where the edge is no Gaussian: the covariance is to say
  // so, and the fewer they are the less they know of their own scatter.
  m_members = sums.members;
  m_inflation = m_members > N ? std::max(1.0, sums.shift / (m_members - N)) * (1 + 2 / (m_members - N)) : 3;
  m_noise = std::sqrt(noise);
  m_pixels = sums.pixels;
  m_misfit = m_pixels > 0 ? sums.squares / m_pixels : 0;
  m_shining = found > 0 ? sums.shining / found : 0;
  m_kept = sums.shining > 0 ? sums.kept / sums.shining : 0;
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
  typename Model::Vector latest = Model::Vector::Zero();
  double share = 1; // of a step that is taken
  for (int i = 0; i < steps.most; ++i) {
    m_some = i < sparse;
    m_litOnly = steps.litOnly || m_some;
    m_litShine = steps.litShine;
    m_reach = std::clamp(3 * m_blur + 2, 4.0, std::max(4.0, 0.4 * m_model.radius()));
    findEnds();
    assemble(equations);
    if (m_some && m_members < many) { // the others may all be dark
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
    if (likely && m_some) { // a start that is a little off looks blurred: the blur is held
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
    // Lines that come into view as the outline moves, and go again, would send it to and fro.
    static const int settled = 8; // steps
    const typename Model::Vector wanted = step.template head<Model::parameters>();
    share *= i > settled && wanted.dot(latest) < 0 ? 0.5 : 1;
    latest = wanted;
    const typename Model::Vector outlineStep = share * wanted.cwiseMax(-limit).cwiseMin(limit);
    m_model.advance(outlineStep);
    const double before = m_blur, shadingBefore = m_shading;
    static const double close = 0.3; // px: from farther off amplitudes are not yet the light's
    if (outlineStep.cwiseAbs().maxCoeff() < close) {
      static const double most = 0.2; // of the light, over half of the lamp
      const double limit = most / m_model.radius();
      m_shading = std::clamp(m_shading + vpEndSums::shading(m_memory->ends), -limit, limit);
    }
    m_blur = std::clamp(before + std::clamp(step(N - 1), -0.5 * before, 0.5 * before), sharpest, widest);
    if (!m_model.plausible(box) || (m_model.centre() - start).norm() > 0.3 * radius + 2) {
      return false;
    }
    static const double near = 0.05; // px: from there all lines together are quicker
    if (likely && m_some && outlineStep.cwiseAbs().maxCoeff() < near) {
      sparse = i + 1;
      continue;
    }
    static const double ofBlur = 0.05, ofShading = 0.001; // px: blur moves no edge, shading all by as much
    const double byShading = std::abs(m_shading - shadingBefore) * m_reach * m_reach / 3; // px, about
    if (!m_some && outlineStep.cwiseAbs().maxCoeff() < steps.still && std::abs(m_blur - before) < ofBlur &&
        byShading < ofShading) {
      break;
    }
  }
  // What the ends scatter says of the ends, not of the prior.
  m_covariance = (H - data + data / m_inflation).inverse();
  if (!m_covariance.allFinite() || m_covariance.diagonal().minCoeff() < 0) {
    return false;
  }
  measureEvenness();
  const double sigma = std::sqrt(m_model.outline(m_covariance).centreCovariance.trace());
  return sigma < 0.3 * radius;
}

template <class Model>
void vpEdgeFit<Model>::measureEvenness()
{
  double edges = 0, peaks = 0;
  bool clipped = false;
  for (const EightLines &lines : m_memory->ends) {
    for (int lane = 0; lane < vpLanes::count; ++lane) {
      const int line = lines.line[static_cast<size_t>(lane)];
      double first, last;
      if ((lines.sides[0].valid[lane] == 0 && lines.sides[1].valid[lane] == 0) ||
          !m_model.stretch((*m_v)[static_cast<size_t>(line)], 0, first, last)) {
        continue;
      }
      const int left = std::max(0, static_cast<int>(first)),
                right = std::min(m_lines->cols - 1, static_cast<int>(last) + 1);
      const double peak =
          left < right ? vpBrighter::brightest((*m_lines)[line] + left, right - left + 1) : 0.0;
      clipped = clipped || peak >= vpBrighter::nearlyWhite;
      for (const vpLineEnds<N> &end : lines.sides) {
        if (end.valid[lane] != 0) {
          edges += std::max(0.f, end.amplitude[lane]);
          peaks += std::max(0.0, peak - end.background[lane]);
        }
      }
    }
  }
  m_evenness.edges = peaks > 0 ? edges / peaks : 0;
  m_evenness.spared = clipped ? sparedEvenness() : 1;
}

template <class Model>
double vpEdgeFit<Model>::sparedEvenness() const
{
  static const int shortest = 5; // samples
  double least = 0, most = 0;
  for (const EightLines &lines : m_memory->ends) {
    for (int lane = 0; lane < vpLanes::count; ++lane) {
      const int line = lines.line[static_cast<size_t>(lane)];
      double first, last;
      if (lines.sides[0].valid[lane] == 0 || lines.sides[1].valid[lane] == 0 ||
          !m_model.stretch((*m_v)[static_cast<size_t>(line)], -m_reach, first, last)) {
        continue;
      }
      const vpLineStretch inside(first, last, m_lines->cols);
      const int samples = inside.to - inside.from + 1;
      if (samples < shortest) {
        continue;
      }
      const unsigned char *row = (*m_lines)[line] + inside.from;
      if (vpBrighter::brightest(row, samples) >= vpBrighter::nearlyWhite) {
        continue;
      }
      const double mean = static_cast<double>(vpBrighter::sum(row, samples)) / samples;
      for (const int at : {1, samples - 2}) { // three samples together: a dim line's own noise is not uneven
        const double rim = static_cast<double>(vpBrighter::sum(row + at - 1, 3)) / 3,
                     dark = lines.sides[at > 1 ? 1 : 0].background[lane];
        least += std::max(0.0, std::min(rim, mean) - dark);
        most += std::max(0.0, std::max(rim, mean) - dark);
      }
    }
  }
  return most > 0 ? least / most : 0;
}

template <class Model>
vpOutlineFit vpEdgeFit<Model>::result() const
{
  vpOutlineFit fit;
  // No lens, sensor or picture format is known better than this.
  static const double systematic = 0.004; // px
  fit.outline = m_model.outline(m_covariance);
  fit.outline.residual = m_residual;
  fit.blur = m_blur;
  const double off = std::hypot(systematic, unevenSigma(fit, m_evenness, m_reach));
  fit.outline.centreCovariance += off * off * Eigen::Matrix2d::Identity();
  fit.background = median(valuesOf(&vpLineEnds<N>::background, &vpLineEnds<N>::shines));
  fit.noise = m_noise;
  return fit;
}

template class vpEdgeFit<vpEllipseModel>;
template class vpEdgeFit<vpQuadrilateralModel>;

END_VISP_NAMESPACE
