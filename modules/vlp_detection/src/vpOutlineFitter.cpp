/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_detection/vpOutlineFitter.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <opencv2/imgproc.hpp>

#include "vpChordShape.h"
#include "vpOutlineModel.h"

BEGIN_VISP_NAMESPACE

namespace
{

//! Share of a pixel's light at signed distance \e d outside an edge of Gaussian spread \e blur.
double edge(double d, double blur)
{
  return 0.5 * std::erfc(d / (blur * M_SQRT2));
}

double median(std::vector<double> values)
{
  if (values.empty()) {
    return 0;
  }
  const auto middle = values.begin() + static_cast<long>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/*!
  One end of one line: the normal equations of the outline's parameters and the blur from its pixels, with the
  end's own background and amplitude eliminated.
*/
template <int N>
struct LineEnd {
  Eigen::Matrix<double, N, N> H;
  Eigen::Matrix<double, N, 1> g;
  double squares = 0; // sum of squared residuals, grey levels
  int pixels = 0;
  double amplitude = 0;  // grey levels
  double background = 0; // grey value
  double offset = 0;     // px, how far this end alone would move the edge outwards
  double offsetWeight = 0;
};

template <class Model>
class Fit
{
public:
  static constexpr int N = Model::parameters + 1;
  using End = LineEnd<N>;

  Fit(const cv::Mat_<unsigned char> &lines, const std::vector<double> &linePositions,
      const std::vector<double> &samplePositions, const Model &start)
      : m_lines(lines), m_v(linePositions), m_u(samplePositions), m_model(start)
  {
  }

  bool run(const cv::Rect &box, double shapeSigma, int maxIterations);
  vpOutlineFit result() const;
  //! Mean squared residual of the ends that take part, grey levels^2.
  double misfit() const { return m_misfit; }

private:
  std::optional<End> lineEnd(int line, double first, double last) const;
  void collect(int line, double v, std::vector<End> &ends) const;
  std::vector<End> lineEnds() const;
  void assemble(const std::vector<End> &ends, Eigen::MatrixXd &H, Eigen::VectorXd &g);

  const cv::Mat_<unsigned char> &m_lines;
  const std::vector<double> &m_v;
  const std::vector<double> &m_u;
  Model m_model;
  double m_blur = 1.5;
  double m_reach = 0; // px on either side of the edge
  Eigen::MatrixXd m_covariance;
  double m_residual = 0;
  double m_inflation = 1;
  double m_background = 0;
  double m_noise = 0;
  double m_misfit = 0;
};

template <class Model>
std::optional<typename Fit<Model>::End> Fit<Model>::lineEnd(int line, double first, double last) const
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
    const double d = m_model.distance({m_u[from + i], m_v[line]}, derivative);
    const double z = d / m_blur;
    const double density = std::exp(-0.5 * z * z) / (std::sqrt(2 * M_PI) * m_blur);
    D(i) = edge(d, m_blur);
    J.row(i) << -density * derivative.transpose(), density * z;
    I(i) = row[from + i];
    slope(i) = density; // derivative of D by an outward shift of the edge
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
void Fit<Model>::collect(int line, double v, std::vector<End> &ends) const
{
  double outerFirst, outerLast, first, last, innerFirst, innerLast;
  if (!m_model.stretch(v, 0, first, last) || !m_model.stretch(v, m_reach, outerFirst, outerLast)) {
    return;
  }
  // Where the outline crosses the line at a slant, the same distance from the edge is a longer stretch.
  auto add = [&](double from, double to) {
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
std::vector<typename Fit<Model>::End> Fit<Model>::lineEnds() const
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
void Fit<Model>::assemble(const std::vector<End> &ends, Eigen::MatrixXd &H, Eigen::VectorXd &g)
{
  std::vector<double> variances, offsets, backgrounds;
  for (const End &end : ends) {
    variances.push_back(end.squares / std::max(1, end.pixels - 2));
  }
  const double noise = std::max(median(variances), 0.05); // 8 bits round: 1/12, less where all is dark
  auto lit = [&](size_t i) { return ends[i].amplitude > 0 && ends[i].offsetWeight > 4 * noise; };
  for (size_t i = 0; i < ends.size(); ++i) {
    if (lit(i)) {
      offsets.push_back(std::abs(ends[i].offset));
      backgrounds.push_back(ends[i].background);
    }
  }
  const double scale = 4.685 * 1.4826 * std::max(median(offsets), 0.02);
  H = Eigen::MatrixXd::Zero(N, N);
  g = Eigen::VectorXd::Zero(N);
  double squares = 0, weights = 0, pixels = 0, chiSquare = 0, members = 0;
  for (size_t i = 0; i < ends.size(); ++i) {
    const double z = ends[i].offset / scale;
    if (!lit(i) || std::abs(z) >= 1) {
      continue;
    }
    const double tukey = (1 - z * z) * (1 - z * z);
    const double weight = tukey / std::max(variances[i], noise);
    H += weight * ends[i].H;
    g += weight * ends[i].g;
    squares += weight * ends[i].offsetWeight * ends[i].offset * ends[i].offset;
    weights += weight * ends[i].offsetWeight;
    chiSquare += tukey * ends[i].squares;
    pixels += tukey * ends[i].pixels;
    members += tukey;
  }
  m_residual = weights > 0 ? std::sqrt(squares / weights) : 0;
  // Ends scatter more than their pixels' noise says where the edge is no Gaussian: the covariance is to say
  // so.
  m_inflation = members > N ? std::max(1.0, squares / (members - N)) : 1;
  m_background = median(backgrounds);
  m_noise = std::sqrt(noise);
  m_misfit = pixels > 0 ? chiSquare / pixels : 0;
}

template <class Model>
bool Fit<Model>::run(const cv::Rect &box, double shapeSigma, int maxIterations)
{
  Eigen::MatrixXd H;
  Eigen::VectorXd g;
  const double radius = m_model.radius();
  m_blur = std::clamp(0.04 * radius, 0.8, 4.0);
  for (int i = 0; i < maxIterations; ++i) {
    m_reach = std::clamp(3 * m_blur + 2, 4.0, std::max(4.0, 0.4 * m_model.radius()));
    const std::vector<End> ends = lineEnds();
    if (ends.size() < 4) {
      return false;
    }
    assemble(ends, H, g);
    m_model.addPrior(shapeSigma, H, g);
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
    m_blur =
        std::clamp(m_blur + std::clamp(step(N - 1), -0.3 * m_blur, 0.5 * m_blur), 0.25, 0.25 * radius + 0.5);
    if (!m_model.plausible(box)) {
      return false;
    }
    if (outlineStep.cwiseAbs().maxCoeff() < 1e-4 && std::abs(step(N - 1)) < 1e-3) {
      break;
    }
  }
  m_covariance = m_inflation * H.inverse();
  return m_covariance.allFinite() && m_covariance.diagonal().minCoeff() >= 0;
}

template <class Model>
vpOutlineFit Fit<Model>::result() const
{
  vpOutlineFit fit;
  fit.outline = m_model.outline(m_covariance);
  fit.outline.residual = m_residual;
  fit.blur = m_blur;
  fit.background = m_background;
  fit.noise = m_noise;
  return fit;
}

vpLampOutline boxOf(const vpLedRoi &roi)
{
  vpLampOutline outline;
  const double left = roi.box.x - 0.5, top = roi.box.y - 0.5;
  const double right = left + roi.box.width, bottom = top + roi.box.height;
  outline.corners = {Eigen::Vector2d(left, top), Eigen::Vector2d(right, top), Eigen::Vector2d(right, bottom),
                     Eigen::Vector2d(left, bottom)};
  outline.centre = Eigen::Vector2d(0.5 * (left + right), 0.5 * (top + bottom));
  outline.a = 0.5 * std::max(roi.box.width, roi.box.height);
  outline.b = 0.5 * std::min(roi.box.width, roi.box.height);
  outline.centreCovariance =
      Eigen::Vector2d(roi.box.width * roi.box.width, roi.box.height * roi.box.height).asDiagonal();
  outline.centreCovariance /= 12;
  return outline;
}

} // namespace

vpOutlineFit vpOutlineFitter::fit(const cv::Mat_<unsigned char> &lines,
                                  const std::vector<double> &linePositions,
                                  const std::vector<double> &samplePositions, const vpLedRoi &roi) const
{
  const std::vector<cv::Point2f> ends = vpChordShape::outerEnds(roi, lines.cols);
  vpOutlineFit best;
  best.outline = boxOf(roi);
  if (ends.size() < 6) {
    return best;
  }
  Fit<vpEllipseModel> ellipse(lines, linePositions, samplePositions, vpEllipseModel::from(ends, roi.box));
  const bool isEllipse = ellipse.run(roi.box, shapeSigma, maxIterations);
  if (isEllipse) {
    best = ellipse.result();
  }
  if (vpChordShape::rectangleMisfit(ends) > 1.5 * vpChordShape::ellipseMisfit(ends, roi.box)) {
    return best;
  }
  Fit<vpQuadrilateralModel> sides(lines, linePositions, samplePositions, vpQuadrilateralModel::from(ends));
  if (sides.run(roi.box, shapeSigma, maxIterations) &&
      (!isEllipse || sides.misfit() < 0.8 * ellipse.misfit())) {
    best = sides.result();
  }
  return best;
}

END_VISP_NAMESPACE
