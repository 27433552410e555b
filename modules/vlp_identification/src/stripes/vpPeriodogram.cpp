/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include <opencv2/core.hpp>

#include "vpStripeStarts.h"

BEGIN_VISP_NAMESPACE

namespace
{
//! Lines on an even grid of times.
struct Grid {
  double step;               // s
  std::vector<size_t> place; // of each line
};

//! All lines lie on it where they are whole lines of a sensor; else to an eighth of their distance.
Grid gridOf(const std::vector<double> &times)
{
  const double first = *std::min_element(times.begin(), times.end());
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (size_t i = 1; i < times.size(); ++i) {
    const double distance = std::abs(times[i] - times[i - 1]);
    least = std::min(least, distance);
    most = std::max(most, distance);
  }
  static const double even = 0.01, off = 0.02; // of a step
  auto fits = [&](double step) {
    return std::all_of(times.begin(), times.end(), [&](double time) {
      const double steps = (time - first) / step;
      return std::abs(steps - std::round(steps)) < off;
    });
  };
  double step = most - least < even * most ? least : most - least;
  if (!fits(step)) {
    step = least / 4;
  }
  Grid grid{step, {}};
  for (double time : times) {
    grid.place.push_back(static_cast<size_t>(std::lround((time - first) / step)));
  }
  return grid;
}

//! Transforms of four real sequences on one grid, two at a time in one.
class Transforms
{
public:
  Transforms(const Grid &grid, int length)
      : m_grid(grid), m_length(length), m_values(2, length, std::complex<double>(0, 0))
  {
  }
  void add(size_t line, double weight, double weightTime, double weightSquare, double weightLight)
  {
    const auto at = static_cast<int>(m_grid.place[line]);
    m_values(0, at) += std::complex<double>(weight, weightTime);
    m_values(1, at) += std::complex<double>(weightLight, weightSquare);
  }
  void transform() { cv::dft(m_values, m_values, cv::DFT_ROWS); }
  std::complex<double> weight(int k) const { return real(0, k); }
  std::complex<double> weightTime(int k) const { return imaginary(0, k); }
  std::complex<double> weightSquare(int k) const { return imaginary(1, k); }
  std::complex<double> weightLight(int k) const { return real(1, k); }

private:
  //! Of the sequence that is the real part, the imaginary part.
  std::complex<double> real(int row, int k) const { return 0.5 * (at(row, k) + std::conj(at(row, -k))); }
  std::complex<double> imaginary(int row, int k) const
  {
    return std::complex<double>(0, -0.5) * (at(row, k) - std::conj(at(row, -k)));
  }
  std::complex<double> at(int row, int k) const
  {
    return m_values(row, (k % m_length + m_length) % m_length);
  }

  const Grid &m_grid;
  int m_length;
  cv::Mat_<std::complex<double>> m_values;
};

//! Normal equations of a cosine and a sine.
class Equations
{
public:
  //! \param light Real part: of the cosine; imaginary part: of minus the sine.
  Equations(double weight, const std::complex<double> &weightTwice, const std::complex<double> &light)
      : m_cosines(ridge + 0.5 * (weight + weightTwice.real())),
        m_sines(ridge + 0.5 * (weight - weightTwice.real())), m_both(0.5 * weightTwice.imag()), m_light(light)
  {
  }

  //! What a shape of norm 1 explains of cosine and sine, and of the light.
  void takeOff(const std::complex<double> &shape, double light)
  {
    m_cosines -= shape.real() * shape.real();
    m_sines -= shape.imag() * shape.imag();
    m_both -= shape.real() * shape.imag();
    m_light -= light * shape;
  }

  //! Amplitudes of cosine (real part) and sine. 0 where what was taken off leaves nothing of either.
  std::complex<double> solution() const
  {
    static const double least = 1e-9;
    const double determinant = m_cosines * m_sines - m_both * m_both;
    if (!(determinant > least * m_cosines * m_sines)) {
      return 0;
    }
    return std::complex<double>(m_sines * m_light.real() - m_both * m_light.imag(),
                                m_cosines * m_light.imag() - m_both * m_light.real()) /
           determinant;
  }

  //! In chi-square.
  double gain(const std::complex<double> &solution) const
  {
    return solution.real() * m_light.real() + solution.imag() * m_light.imag();
  }

private:
  static constexpr double ridge = 1e-9;
  double m_cosines, m_sines, m_both;
  std::complex<double> m_light;
};

/*!
  Least squares of light over envelope by a level, a slope and a sinusoid, weighted, and with a bend as well:
  what the envelope leaves of an emitter's own shape is no stripe. All sums over the lines that it needs are
  Fourier transforms of the weights, of weights times time, its square and light, those of squared cosines at
  twice the frequency (Scargle 1982).
*/
class LeastSquares
{
public:
  //! Of one line.
  struct Line {
    double weight, time, light; // time: -1 to 1 over the profile, light: over the envelope
  };
  //! Of all lines at one frequency: Fourier transforms from the first line on.
  struct Sums {
    std::complex<double> weight, weightTime, weightSquare, weightLight, weightTwice;
  };

  LeastSquares(const vpStripeProfile &profile, const std::vector<double> &envelope, double modelError);
  const std::vector<Line> &lines() const { return m_lines; }
  double first() const { return m_first; }   // s
  double middle() const { return m_middle; } // s
  double span() const { return m_span; }     // s, of the lines with half a line before and after
  vpStripeStarts::Sinusoid at(double frequency, const Sums &sums) const;

private:
  std::vector<Line> m_lines;
  double m_first = 0, m_middle = 0, m_span = 0;
  double m_weight = 0; // sum
  // Level, slope and bend, made orthogonal: means of time and of its square, weighted; roots of the sums of
  // squares of what the simpler ones leave; how much of the slope the square has.
  double m_mean = 0, m_slope = 0, m_square = 0, m_bend = 0, m_tilted = 0;
  double m_lightLevel = 0, m_lightSlope = 0, m_lightBend = 0; // what they explain of the light
};

LeastSquares::LeastSquares(const vpStripeProfile &profile, const std::vector<double> &envelope,
                           double modelError)
{
  const auto [first, last] = std::minmax_element(profile.time.begin(), profile.time.end());
  const auto n = static_cast<double>(profile.light.size());
  m_first = *first;
  m_middle = 0.5 * (*first + *last);
  m_span = (*last - *first) * n / std::max(n - 1, 1.0);
  double Wy = 0, Wyy = 0, Wyyy = 0, Wyyyy = 0, Wq = 0, Wyq = 0, Wyyq = 0;
  for (size_t i = 0; i < profile.light.size(); ++i) {
    const double y = 2 * (profile.time[i] - m_middle) / m_span, q = profile.light[i] / envelope[i];
    // Were dark lines as certain as their noise is low, no sinusoid would fit stripes of a short pulse.
    const double sigma = std::hypot(profile.sigma[i] / envelope[i], modelError * std::clamp(q, 0.3, 1.0));
    const double w = 1 / (sigma * sigma);
    m_lines.push_back({w, y, q});
    m_weight += w;
    Wy += w * y;
    Wyy += w * y * y;
    Wyyy += w * y * y * y;
    Wyyyy += w * y * y * y * y;
    Wq += w * q;
    Wyq += w * y * q;
    Wyyq += w * y * y * q;
  }
  m_mean = Wy / m_weight;
  m_slope = std::sqrt(std::max(Wyy - m_mean * Wy, 1e-300));
  m_lightLevel = Wq / std::sqrt(m_weight);
  m_lightSlope = (Wyq - m_mean * Wq) / m_slope;
  m_square = Wyy / m_weight;
  m_tilted = (Wyyy - m_mean * Wyy) / m_slope;
  m_bend = std::sqrt(std::max(Wyyyy - m_square * Wyy - m_tilted * m_tilted, 1e-300));
  m_lightBend = (Wyyq - m_square * Wq - m_tilted * m_lightSlope) / m_bend;
}

vpStripeStarts::Sinusoid LeastSquares::at(double frequency, const Sums &sums) const
{
  const std::complex<double> level = sums.weight / std::sqrt(m_weight),
                             tilted = (sums.weightTime - m_mean * sums.weight) / m_slope,
                             bent = (sums.weightSquare - m_square * sums.weight - m_tilted * tilted) / m_bend;
  Equations equations(m_weight, sums.weightTwice, sums.weightLight);
  equations.takeOff(level, m_lightLevel);
  equations.takeOff(tilted, m_lightSlope);
  const std::complex<double> sinusoid = equations.solution();
  const double gain = equations.gain(sinusoid),
               phase = std::atan2(-sinusoid.imag(), sinusoid.real()) / (2 * M_PI) -
                       frequency * (m_middle - m_first);
  equations.takeOff(bent, m_lightBend);
  // Less than a period is a bend, too.
  const double beyondBend = frequency * m_span < 1 ? 0 : equations.gain(equations.solution());
  return {frequency, phase - std::round(phase), gain, beyondBend};
}

std::vector<vpStripeStarts::Sinusoid> maximaOf(const std::vector<vpStripeStarts::Sinusoid> &all)
{
  using Sinusoid = vpStripeStarts::Sinusoid;
  std::vector<Sinusoid> maxima;
  for (size_t i = 0; i < all.size(); ++i) {
    if ((i == 0 || all[i].gain >= all[i - 1].gain) &&
        (i + 1 == all.size() || all[i].gain > all[i + 1].gain)) {
      maxima.push_back(all[i]);
    }
  }
  std::sort(maxima.begin(), maxima.end(),
            [](const Sinusoid &a, const Sinusoid &b) { return a.gain > b.gain; });
  return maxima;
}
} // namespace

vpStripeStarts::Sinusoid vpStripeStarts::sinusoidAt(const vpStripeProfile &profile,
                                                    const std::vector<double> &envelope, double modelError,
                                                    double frequency)
{
  const LeastSquares fit(profile, envelope, modelError);
  LeastSquares::Sums sums;
  for (size_t i = 0; i < fit.lines().size(); ++i) {
    const LeastSquares::Line &line = fit.lines()[i];
    const std::complex<double> turn =
        std::polar(1.0, -2 * M_PI * frequency * (profile.time[i] - fit.first()));
    sums.weight += line.weight * turn;
    sums.weightTime += line.weight * line.time * turn;
    sums.weightSquare += line.weight * line.time * line.time * turn;
    sums.weightLight += line.weight * line.light * turn;
    sums.weightTwice += line.weight * turn * turn;
  }
  return fit.at(frequency, sums);
}

std::vector<vpStripeStarts::Sinusoid> vpStripeStarts::periodogram(const vpStripeProfile &profile,
                                                                  const std::vector<double> &envelope,
                                                                  double modelError)
{
  const LeastSquares fit(profile, envelope, modelError);
  static const double finest = 0.1; // cycles over the profile, from frequency to frequency
  const Grid grid = gridOf(profile.time);
  const int length = cv::getOptimalDFTSize(static_cast<int>(std::ceil(fit.span() / (finest * grid.step))));
  Transforms transforms(grid, length);
  for (size_t i = 0; i < fit.lines().size(); ++i) {
    const LeastSquares::Line &line = fit.lines()[i];
    transforms.add(i, line.weight, line.weight * line.time, line.weight * line.time * line.time,
                   line.weight * line.light);
  }
  transforms.transform();
  const double perStep = 1 / (length * grid.step), fastest = 0.5 * static_cast<double>(fit.lines().size());
  const int lowest = std::max(1, static_cast<int>(std::ceil(0.7 / fit.span() / perStep))),
            highest = static_cast<int>(std::lround(fastest / fit.span() / perStep));
  std::vector<Sinusoid> all;
  for (int k = lowest; k <= highest; ++k) {
    all.push_back(
        fit.at(k * perStep, {transforms.weight(k), transforms.weightTime(k), transforms.weightSquare(k),
                             transforms.weightLight(k), transforms.weight(2 * k)}));
  }
  return maximaOf(all);
}

END_VISP_NAMESPACE
