/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpQuadrilateralEdges.h"

#include <algorithm>

#include <visp3/vlp_core/vpPixelEdge.h>

BEGIN_VISP_NAMESPACE

namespace
{

constexpr int N = vpQuadrilateralModel::parameters + 1;

//! What is left of sums of products of a and b once a mean and a multiple of D are taken off both.
double without(double ab, double aD, double bD, double DD)
{
  return ab - aD * bD / DD;
}

} // namespace

//! Where the outline crosses the line.
void vpQuadrilateralEdges::setCrossing(int line, const vpLineStretch &pixels, double crossing, int lane,
                                       LineEnds &end) const
{
  if (!pixels.enough()) {
    return;
  }
  vpQuadrilateralModel::Vector derivative;
  Eigen::Vector2d normal;
  m_model.distance({crossing, m_v[line]}, derivative, normal);
  const unsigned char *row = m_lines[line];
  const int n = pixels.to - pixels.from + 1;
  double most = 0, least = 1;
  // Sums of grey value I, share D, its derivatives by shift S and blur B, and of their products.
  double I = 0, D = 0, S = 0, B = 0, II = 0, DI = 0, DD = 0, SI = 0, SD = 0, SS = 0, BI = 0, BD = 0, BS = 0,
         BB = 0;
  for (int i = pixels.from; i <= pixels.to; ++i) {
    const vpPixelEdge edge =
        vpPixelEdge::at(m_model.distance({m_u[i], m_v[line]}), normal, m_blur, vpEdgeLimits::sharp);
    const double light = m_shading.at(m_u[i]);
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
  for (size_t k = 0; k < end.outward.size(); ++k) {
    end.outward[k][lane] = static_cast<float>(-derivative(static_cast<Eigen::Index>(k)));
  }
  auto set = [lane](vpLanes::Floats &values, double value) { values[lane] = static_cast<float>(value); };
  set(end.crossing, crossing - m_shading.middle);
  set(end.amplitude, a);
  set(end.background, (I - a * D) * perPixel);
  set(end.squares, std::max(0.0, without(centred(II, I, I), DI, DI, DD)));
  set(end.pixels, n);
  set(end.shiftShift, a * a * without(centred(SS, S, S), SD, SD, DD));
  set(end.shiftBlur, a * a * without(centred(BS, B, S), BD, SD, DD));
  set(end.blurBlur, a * a * without(centred(BB, B, B), BD, BD, DD));
  set(end.shift, a * without(centred(SI, S, I), SD, DI, DD));
  set(end.blur, a * without(centred(BI, B, I), BD, DI, DD));
  end.valid[lane] = -1;
}

//! Where the outline touches the line, or comes near: its direction changes from pixel to pixel.
void vpQuadrilateralEdges::setAlong(int line, const vpLineStretch &pixels, int lane, LineEnds &end,
                                    std::vector<Equations> &along) const
{
  if (!pixels.enough()) {
    return;
  }
  // Columns: 1, D, I, S; then the derivatives of D by the model's parameters and the blur.
  constexpr int one = 0, share = 1, grey = 2, shift = 3, first = 4, all = first + N;
  using Column = Eigen::Matrix<double, all, 1>;
  Eigen::Matrix<double, all, all> sums = Eigen::Matrix<double, all, all>::Zero();
  const unsigned char *row = m_lines[line];
  double most = 0, least = 1;
  for (int i = pixels.from; i <= pixels.to; ++i) {
    vpQuadrilateralModel::Vector derivative;
    Eigen::Vector2d normal;
    const double d = m_model.distance({m_u[i], m_v[line]}, derivative, normal);
    vpPixelEdge edge = vpPixelEdge::at(d, normal, m_blur, vpEdgeLimits::sharp);
    const double light = m_shading.at(m_u[i]);
    edge.share *= light;
    edge.byShift *= light;
    edge.byBlur *= light;
    most = std::max(most, edge.share);
    least = std::min(least, edge.share);
    Column column;
    column << 1, edge.share, row[i], edge.byShift, -edge.byShift * derivative, edge.byBlur;
    sums.selfadjointView<Eigen::Lower>().rankUpdate(column);
  }
  if (most < vpEdgeLimits::lit || least > vpEdgeLimits::unlit) {
    return;
  }
  sums.triangularView<Eigen::StrictlyUpper>() = sums.transpose();
  const Column mean = sums.col(one) / sums(one, one);
  sums -= sums(one, one) * mean * mean.transpose();
  const double DD = sums(share, share), a = sums(share, grey) / DD;
  const Column ofShare = sums.col(share) / DD;
  sums -= DD * ofShare * ofShare.transpose();
  auto set = [lane](vpLanes::Floats &values, double value) { values[lane] = static_cast<float>(value); };
  set(end.amplitude, a);
  set(end.background, mean(grey) - a * mean(share));
  set(end.squares, std::max(0.0, sums(grey, grey)));
  set(end.pixels, pixels.to - pixels.from + 1);
  set(end.shiftShift, a * a * sums(shift, shift));
  set(end.shift, a * sums(shift, grey));
  end.along[lane] = static_cast<int>(along.size());
  end.valid[lane] = -1;
  along.push_back({a * a * sums.bottomRightCorner<N, N>(), a * sums.col(grey).tail<N>()});
}

void vpQuadrilateralEdges::find(int from, int to, std::vector<EightLines> &ends,
                                std::vector<Equations> &along) const
{
  int lane = vpLanes::count;
  for (int line = from; line <= to; ++line) {
    const double v = m_v[line];
    double outerFirst, outerLast, first, last, innerFirst, innerLast;
    if (!m_model.stretch(v, 0, first, last) || !m_model.stretch(v, m_reach, outerFirst, outerLast)) {
      continue;
    }
    if (lane == vpLanes::count) {
      ends.emplace_back();
      lane = 0;
    }
    std::array<LineEnds, 2> &sides = ends.back().sides;
    ends.back().line[static_cast<size_t>(lane)] = line;
    // Where the outline crosses the line at a slant, the same distance from the edge is a longer stretch.
    if (m_model.stretch(v, -m_reach, innerFirst, innerLast) && innerLast - innerFirst > 1) {
      if (m_model.crossedWell(v, true, false)) {
        setCrossing(line, vpLineStretch(outerFirst, innerFirst, m_lines.cols), first, lane, sides[0]);
      }
      if (m_model.crossedWell(v, false, true)) {
        setCrossing(line, vpLineStretch(innerLast, outerLast, m_lines.cols), last, lane, sides[1]);
      }
    } else if (m_model.crossedWell(v, true, true)) {
      setAlong(line, vpLineStretch(outerFirst, outerLast, m_lines.cols), lane, sides[0], along);
    }
    ++lane;
  }
}

END_VISP_NAMESPACE
