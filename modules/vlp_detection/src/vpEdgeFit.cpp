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

#include "vpEllipseEdges.h"

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

//! What is left of sums of products of a and b once a mean and a multiple of D are taken off both.
double without(double ab, double aD, double bD, double DD)
{
  return ab - aD * bD / DD;
}

} // namespace

//! Where the outline crosses the line.
template <class Model>
void vpEdgeFit<Model>::addCrossing(int line, const vpLineStretch &pixels, double crossing)
{
  if (!pixels.enough()) {
    return;
  }
  End end;
  typename Model::Vector derivative;
  Eigen::Vector2d normal;
  m_model.distance({crossing, (*m_v)[line]}, derivative, normal);
  const unsigned char *row = (*m_lines)[line];
  const int n = pixels.to - pixels.from + 1;
  double most = 0, least = 1;
  // Sums of grey value I, share D, its derivatives by shift S and blur B, and of their products.
  double I = 0, D = 0, S = 0, B = 0, II = 0, DI = 0, DD = 0, SI = 0, SD = 0, SS = 0, BI = 0, BD = 0, BS = 0,
         BB = 0;
  for (int i = pixels.from; i <= pixels.to; ++i) {
    const vpPixelEdge edge =
        vpPixelEdge::at(m_model.distance({(*m_u)[i], (*m_v)[line]}), normal, m_blur, vpEdgeLimits::sharp);
    const double light = lightAt(i);
    const double grey = row[i], share = light * edge.share, byShift = light * edge.byShift,
                 byBlur = light * edge.byBlur;
    most = std::max(most, share);
    least = std::min(least, share);
    I += grey;
    D += share;
    S += byShift;
    B += byBlur;
    II += grey * grey;
    DI += share * grey;
    DD += share * share;
    SI += byShift * grey;
    SD += byShift * share;
    SS += byShift * byShift;
    BI += byBlur * grey;
    BD += byBlur * share;
    BS += byBlur * byShift;
    BB += byBlur * byBlur;
  }
  if (most < vpEdgeLimits::lit || least > vpEdgeLimits::unlit) {
    return; // the edge itself is not in it
  }
  const double perPixel = 1.0 / n;
  auto centred = [perPixel](double ab, double a, double b) { return ab - a * b * perPixel; };
  DD = centred(DD, D, D);
  DI = centred(DI, D, I);
  SD = centred(SD, S, D);
  BD = centred(BD, B, D);
  const double a = DI / DD;
  end.line = line;
  end.crossing = crossing - m_middle;
  end.outward = -derivative;
  end.amplitude = a;
  end.background = (I - a * D) * perPixel;
  end.squares = std::max(0.0, without(centred(II, I, I), DI, DI, DD));
  end.pixels = n;
  end.shiftShift = a * a * without(centred(SS, S, S), SD, SD, DD);
  end.shiftBlur = a * a * without(centred(BS, B, S), BD, SD, DD);
  end.blurBlur = a * a * without(centred(BB, B, B), BD, BD, DD);
  end.shift = a * without(centred(SI, S, I), SD, DI, DD);
  end.blur = a * without(centred(BI, B, I), BD, DI, DD);
  m_memory->ends.push_back(end);
}

//! Where the outline touches the line, or comes near: its direction changes from pixel to pixel.
template <class Model>
void vpEdgeFit<Model>::addAlong(int line, const vpLineStretch &pixels)
{
  if (!pixels.enough()) {
    return;
  }
  // Columns: 1, D, I, S; then the derivatives of D by the model's parameters and the blur.
  constexpr int one = 0, share = 1, grey = 2, shift = 3, first = 4, all = first + N;
  using Column = Eigen::Matrix<double, all, 1>;
  Eigen::Matrix<double, all, all> sums = Eigen::Matrix<double, all, all>::Zero();
  const unsigned char *row = (*m_lines)[line];
  double most = 0, least = 1;
  for (int i = pixels.from; i <= pixels.to; ++i) {
    typename Model::Vector derivative;
    Eigen::Vector2d normal;
    const double d = m_model.distance({(*m_u)[i], (*m_v)[line]}, derivative, normal);
    vpPixelEdge edge = vpPixelEdge::at(d, normal, m_blur, vpEdgeLimits::sharp);
    const double light = lightAt(i);
    edge.share *= light;
    edge.byShift *= light;
    edge.byBlur *= light;
    most = std::max(most, edge.share);
    least = std::min(least, edge.share);
    Column column;
    column << 1, edge.share, row[i], edge.byShift, -edge.byShift * derivative, edge.byBlur;
    sums.template selfadjointView<Eigen::Lower>().rankUpdate(column);
  }
  if (most < vpEdgeLimits::lit || least > vpEdgeLimits::unlit) {
    return;
  }
  sums.template triangularView<Eigen::StrictlyUpper>() = sums.transpose();
  const Column mean = sums.col(one) / sums(one, one);
  sums -= sums(one, one) * mean * mean.transpose();
  const double DD = sums(share, share), a = sums(share, grey) / DD;
  const Column ofShare = sums.col(share) / DD;
  sums -= DD * ofShare * ofShare.transpose();
  End end;
  end.line = line;
  end.amplitude = a;
  end.background = mean(grey) - a * mean(share);
  end.squares = std::max(0.0, sums(grey, grey));
  end.pixels = pixels.to - pixels.from + 1;
  end.shiftShift = a * a * sums(shift, shift);
  end.shift = a * sums(shift, grey);
  end.along = static_cast<int>(m_memory->along.size());
  m_memory->along.push_back(
      {a * a * sums.template bottomRightCorner<N, N>(), a * sums.col(grey).template tail<N>()});
  m_memory->ends.push_back(end);
}

template <class Model>
void vpEdgeFit<Model>::addEnds(int from, int to)
{
  for (int line = from; line <= to; ++line) {
    const double v = (*m_v)[line];
    double outerFirst, outerLast, first, last, innerFirst, innerLast;
    if (!m_model.stretch(v, 0, first, last) || !m_model.stretch(v, m_reach, outerFirst, outerLast)) {
      continue;
    }
    // Where the outline crosses the line at a slant, the same distance from the edge is a longer stretch.
    if (m_model.stretch(v, -m_reach, innerFirst, innerLast) && innerLast - innerFirst > 1) {
      if (m_model.crossedWell(v, true, false)) {
        addCrossing(line, vpLineStretch(outerFirst, innerFirst, m_lines->cols), first);
      }
      if (m_model.crossedWell(v, false, true)) {
        addCrossing(line, vpLineStretch(innerLast, outerLast, m_lines->cols), last);
      }
    } else if (m_model.crossedWell(v, true, true)) {
      addAlong(line, vpLineStretch(outerFirst, outerLast, m_lines->cols));
    }
  }
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
  const int from = std::max(0, static_cast<int>(std::floor(top)) - 1);
  const int to = std::min(m_lines->rows - 1, static_cast<int>(std::ceil(bottom)) + 1);
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
    static const double ofBlur = 10, ofShading = 0.2; // of a step: blur moves no edge, shading all by as much
    const double byShading = std::abs(m_shading - shadingBefore) * m_reach * m_reach / 3; // px, about
    if (i >= sparse && outlineStep.cwiseAbs().maxCoeff() < steps.still &&
        std::abs(m_blur - before) < ofBlur * steps.still && byShading < ofShading * steps.still) {
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
