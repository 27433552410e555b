/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpWhiteEnd.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <visp3/vlp_core/vpBrighter.h>

BEGIN_VISP_NAMESPACE

//! How much brighter more of a line's samples are than few of them.
class vpWhiteEnd::Ratio
{
public:
  //! Of \e few to \e more shares, by the lines that are spared these.
  Ratio(const std::vector<Line> &lines, int few, int more) : m_lines(lines.size())
  {
    static const int enough = 2 * bends; // lines
    Matrix A = Matrix::Zero();
    Vector b = Vector::Zero();
    double squares = 0;
    int count = 0;
    for (size_t i = 0; i < lines.size(); ++i) {
      if (lines[i].spared >= more) {
        const Vector row = lines[i].mean[static_cast<size_t>(few) - 1] * powers(i);
        const double light = lines[i].mean[static_cast<size_t>(more) - 1];
        A += row * row.transpose();
        b += light * row;
        squares += light * light;
        ++count;
      }
    }
    m_known = count >= enough;
    if (m_known) {
      const Eigen::LDLT<Matrix> solver(A);
      m_coefficients = solver.solve(b);
      m_covariance =
          solver.solve(Matrix::Identity()) * std::max(0.0, squares - m_coefficients.dot(b)) / (count - bends);
    }
  }

  bool known() const { return m_known; }
  double value(size_t line) const { return m_coefficients.dot(powers(line)); }
  double sigma(size_t line) const
  {
    const Vector at = powers(line);
    return std::sqrt(at.dot(m_covariance * at));
  }

private:
  static constexpr int bends = 5; // of a lamp's emission along the lines
  using Vector = Eigen::Matrix<double, bends, 1>;
  using Matrix = Eigen::Matrix<double, bends, bends>;

  Vector powers(size_t line) const
  {
    const double v = 2 * static_cast<double>(line) / static_cast<double>(m_lines) - 1;
    Vector powers;
    powers(0) = 1;
    for (int p = 1; p < bends; ++p) {
      powers(p) = powers(p - 1) * v;
    }
    return powers;
  }

  size_t m_lines;
  bool m_known;
  Vector m_coefficients;
  Matrix m_covariance;
};

void vpWhiteEnd::add(const unsigned char *row, double from, double to)
{
  const auto first = static_cast<int>(std::lround(from)), last = static_cast<int>(std::lround(to));
  std::array<double, 256> samples{}; // of each grey value, as far as they lie inside
  for (int i = first + 1; i < last; ++i) {
    ++samples[row[i]];
  }
  samples[row[first]] += first + 0.5 - from;
  samples[row[last]] += to - last + 0.5;
  Line line{{}, 0, to - from};
  const double share = line.samples / shares;
  double sum = 0, wanted = share;
  size_t grey = 0;
  for (size_t k = 0; k < shares; ++k, wanted = share) {
    for (; samples[grey] < wanted && grey < samples.size() - 1; ++grey) {
      sum += samples[grey] * static_cast<double>(grey);
      wanted -= samples[grey];
    }
    sum += wanted * static_cast<double>(grey);
    samples[grey] -= wanted;
    line.mean[k] = sum / (share * static_cast<double>(k + 1)) - m_background;
    line.spared += grey < vpBrighter::nearlyWhite ? 1 : 0;
  }
  m_lines.push_back(line);
}

std::vector<vpWhiteEnd::Light> vpWhiteEnd::light() const
{
  int few = shares;
  for (const Line &line : m_lines) {
    few = std::max(1, std::min(few, line.spared));
  }
  const auto sigmaOf = [this](const Line &line, int spared) {
    return m_noise / std::sqrt(line.samples * spared / shares);
  };
  std::vector<Light> light;
  for (const Line &line : m_lines) {
    light.push_back({line.mean[static_cast<size_t>(few) - 1], sigmaOf(line, few)});
  }
  for (int more = few + 1; more <= shares; ++more) {
    const Ratio ratio(m_lines, few, more);
    for (size_t i = 0; ratio.known() && i < m_lines.size(); ++i) {
      const Line &line = m_lines[i];
      const double mean = line.mean[static_cast<size_t>(more) - 1] / ratio.value(i),
                   sigma = std::hypot(sigmaOf(line, more), mean * ratio.sigma(i)) / ratio.value(i);
      if (line.spared >= more && sigma > 0 && sigma < light[i].sigma) {
        light[i] = {mean, sigma};
      }
    }
  }
  return light;
}

END_VISP_NAMESPACE
