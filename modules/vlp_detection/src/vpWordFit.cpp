/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpWordFit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

BEGIN_VISP_NAMESPACE

namespace
{

const size_t bendPlace = 6;   // in Word::light
const double brightest = 3;  // gain
const double mostBend = 0.9; // beyond, more light would be seen as less

double quantile(std::vector<double> values, double share)
{
  const auto place = values.begin() + static_cast<long>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

} // namespace

vpWordFit::vpWordFit(const vpStripeProfile &profile, const Settings &settings,
                     const std::vector<double> &envelope)
    : m_profile(&profile), m_settings(settings), m_given(envelope),
      m_linear(3 + std::clamp(settings.envelopeOrder, 0, 4))
{
  const auto [first, last] = std::minmax_element(profile.time.begin(), profile.time.end());
  const size_t n = profile.light.size();
  m_middle = 0.5 * (*first + *last);
  m_half = std::max(0.5 * (*last - *first), 1e-12);
  m_line = 2 * m_half / std::max<double>(1, static_cast<double>(n) - 1);
  // Peaks of single chips under a long exposure lie lower than those of long runs: what is lit and what is
  // dark say the brightest and the darkest lines.
  std::vector<double> share(n);
  for (size_t i = 0; i < n; ++i) {
    share[i] = profile.light[i] / m_given[i];
  }
  const double lit = quantile(share, 0.92);
  const double dark = std::clamp(quantile(share, 0.05), 0.0, 0.7 * lit);
  for (double &given : m_given) {
    given *= lit - dark;
  }
  m_dark = dark / (lit - dark) * quantile(m_given, 0.5);
  for (size_t i = 0; i < n; ++i) {
    // A dark line has some light of its neighbours, by blur and compression.
    static const double spill = 0.01; // share of theirs, standard deviation
    const double missed = std::hypot(m_settings.modelError * profile.light[i], spill * m_given[i]);
    m_weight.push_back(1 / (profile.sigma[i] * profile.sigma[i] + missed * missed));
  }
}

int vpWordFit::window(const Word &word)
{
  return std::max(2, static_cast<int>(std::ceil(word.exposure / word.chip - 1e-9)) + 1);
}

bool vpWordFit::touch(size_t line, const Word &word, Touch &touched) const
{
  const double width = std::max(word.exposure / word.chip, 1e-6);
  const double from = (m_profile->time[line] - m_middle) / word.chip + word.phase - 0.5 * width;
  const double to = from + width;
  const double first = std::floor(from);
  touched.first = static_cast<long>(first);
  touched.count = 0;
  for (double edge = first; edge < to; edge += 1) {
    if (touched.count == vpChipTrellis::widestWindow) {
      return false;
    }
    touched.share[static_cast<size_t>(touched.count++)] =
        (std::min(to, edge + 1) - std::max(from, edge)) / width;
  }
  return true;
}

vpWordFit::Light vpWordFit::lightOf(const Word &word) const
{
  Light light{word.light[0], m_given, m_given};
  for (size_t i = 0; i < m_given.size(); ++i) {
    const double y = (m_profile->time[i] - m_middle) / m_half;
    double sum = 0;
    for (int k = m_linear - 2; k >= 1; --k) {
      sum = sum * y + word.light[static_cast<size_t>(k)];
    }
    light.envelope[i] *= sum;
    light.bend[i] *= std::clamp(word.light[bendPlace], -mostBend * std::abs(sum), mostBend * std::abs(sum));
  }
  return light;
}

//! Cost of every pattern of the chips that each line touches.
bool vpWordFit::fill(vpChipTrellis &trellis, const Word &word, const Light &light, int window) const
{
  const auto n = static_cast<long>(word.chips.size());
  const size_t patterns = size_t{1} << window;
  Touch touched;
  std::array<double, size_t{1} << vpChipTrellis::widestWindow> share{};
  for (size_t i = 0; i < m_weight.size(); ++i) {
    touched.share.fill(0);
    if (!touch(i, word, touched) || touched.count > window) {
      return false;
    }
    for (size_t j = 0, bit = 1; bit < patterns; ++j, bit <<= 1) {
      for (size_t p = 0; p < bit; ++p) {
        share[bit | p] = share[p] + touched.share[j];
      }
    }
    const double seen = m_profile->light[i] - light.offset;
    double *costs = trellis.costs(static_cast<size_t>(((touched.first % n) + n) % n));
    for (size_t p = 0; p < patterns; ++p) {
      const double s = std::min(1.0, word.gain * share[p]);
      const double residual = seen - s * (light.envelope[i] + light.bend[i] * (1 - s));
      costs[p] += m_weight[i] * residual * residual;
    }
  }
  return true;
}

//! Chi-square of the likeliest chips with that light. \param chips Where given, those.
double vpWordFit::least(const Word &word, const Light &light, std::vector<char> *chips) const
{
  const int width = window(word);
  if (width > vpChipTrellis::widestWindow || static_cast<int>(word.chips.size()) < width) {
    return 1e300;
  }
  vpChipTrellis trellis(word.chips.size(), width);
  return fill(trellis, word, light, width) ? trellis.least(chips) : 1e300;
}

//! What exposure and gain are off by what is likely, in standard deviations.
Eigen::Vector2d vpWordFit::prior(const Word &word) const
{
  static const double usualGain = 0.3; // of its logarithm
  return {(word.exposure - m_profile->exposure) / (m_settings.exposureTolerance * m_profile->exposure),
          std::log(word.gain) / usualGain};
}

//! Offset, envelope and bend by least squares with the word's chips. \return Chi-square.
double vpWordFit::fitLight(Word &word, Eigen::VectorXd *residuals) const
{
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 7, 7>;
  using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 7, 1>;
  const auto n = static_cast<long>(word.chips.size());
  const size_t lines = m_weight.size();
  std::vector<Row> rows(lines);
  Small A = Small::Zero(m_linear, m_linear);
  Column b = Column::Zero(m_linear);
  Touch touched;
  for (size_t i = 0; i < lines; ++i) {
    if (!touch(i, word, touched)) {
      return 1e300;
    }
    double s = 0;
    long k = ((touched.first % n) + n) % n;
    for (int j = 0; j < touched.count; ++j, k = k + 1 == n ? 0 : k + 1) {
      s += word.chips[static_cast<size_t>(k)] != 0 ? touched.share[static_cast<size_t>(j)] : 0;
    }
    s = std::min(1.0, word.gain * s);
    const double y = (m_profile->time[i] - m_middle) / m_half;
    Row &row = rows[i];
    row[0] = 1;
    row[1] = m_given[i] * s;
    for (int j = 2; j < m_linear - 1; ++j) {
      row[static_cast<size_t>(j)] = row[static_cast<size_t>(j - 1)] * y;
    }
    row[static_cast<size_t>(m_linear - 1)] = m_given[i] * s * (1 - s);
    for (int p = 0; p < m_linear; ++p) {
      const double weighted = m_weight[i] * row[static_cast<size_t>(p)];
      for (int q = 0; q <= p; ++q) {
        A(p, q) += weighted * row[static_cast<size_t>(q)];
      }
      b(p) += weighted * m_profile->light[i];
    }
  }
  A.diagonal().array() += 1e-9 * (A(0, 0) + 1e-12);
  for (int p = 2; p < m_linear - 1; ++p) {
    A(p, p) += 0.06; // bends of four times the envelope are one standard deviation
  }
  static const double usualBend = 0.3; // envelopes, standard deviation
  A(m_linear - 1, m_linear - 1) += 1 / (usualBend * usualBend);
  const Column c = A.selfadjointView<Eigen::Lower>().ldlt().solve(b);
  word.light.fill(0);
  for (int p = 0; p < m_linear; ++p) {
    word.light[p + 1 == m_linear ? bendPlace : static_cast<size_t>(p)] = c(p);
  }
  double sum = 0;
  for (size_t i = 0; i < lines; ++i) {
    double residual = m_profile->light[i];
    for (int p = 0; p < m_linear; ++p) {
      residual -= c(p) * rows[i][static_cast<size_t>(p)];
    }
    sum += m_weight[i] * residual * residual;
    if (residuals != nullptr) {
  (*residuals)(static_cast<Eigen::Index>(i)) = std::sqrt(m_weight[i]) * residual;
    }
  }
  return c(1) > 0 ? sum : 1e300; // a lamp that shines where it should be dark
}

//! A step of phase, of the duration and of the exposure, all in chips (the duration's at the profile's ends),
//! and of the gain's logarithm.
vpWordFit::Word vpWordFit::moved(const Word &word, const Place &step) const
{
  Word other = word;
  other.phase += step(0);
  other.chip /= 1 + step(1) * word.chip / m_half;
  other.exposure = std::clamp(word.exposure + step(2) * word.chip, 0.1 * m_profile->exposure,
                              3.9 * std::min(word.chip, m_profile->exposure));
  other.gain = std::clamp(word.gain * std::exp(step(3)), 1.0, brightest);
  return other;
}

//! Of the weighted residuals and of the priors, the light refitted at each step.
bool vpWordFit::jacobian(const Word &word, double step, Eigen::VectorXd &residuals, Jacobian &J) const
{
  const auto n = static_cast<Eigen::Index>(m_weight.size());
  residuals.resize(n + 2);
  J.resize(n + 2, nonlinear);
  Eigen::VectorXd plus(n + 2), minus(n + 2);
  auto at = [&](Word place, Eigen::VectorXd &r) {
    r.tail<2>() = prior(place);
    return fitLight(place, &r) < 1e299;
  };
  if (!at(word, residuals)) {
    return false;
  }
  for (int p = 0; p < nonlinear; ++p) {
    const Place d = step * Place::Unit(p);
    if (!at(moved(word, d), plus) || !at(moved(word, -d), minus)) {
      return false;
    }
    J.col(p) = (plus - minus) / (2 * step);
  }
  return true;
}

//! Levenberg and Marquardt's method over phase, duration, exposure and gain.
void vpWordFit::descend(Word &word) const
{
  static const double step = 0.02; // chips
  double damping = 1e-3;
  word.chiSquare = fitLight(word) + prior(word).squaredNorm();
  Eigen::VectorXd residuals;
  Jacobian J;
  for (int iteration = 0; iteration < 12 && jacobian(word, step, residuals, J); ++iteration) {
    const Curvature H = J.transpose() * J;
    const Place g = J.transpose() * residuals;
    double gain = 0;
    for (int attempt = 0; attempt < 5 && gain <= 0; ++attempt) {
      Curvature damped = H;
      // A step beyond a third of a chip leads to other chips.
      damped.diagonal() += damping * H.diagonal() + Place::Constant(10 * damping);
      Place way = -damped.ldlt().solve(g);
      way *= std::min(1.0, 0.3 / std::max(way.cwiseAbs().maxCoeff(), 1e-12));
      Word other = moved(word, way);
      other.chiSquare = fitLight(other) + prior(other).squaredNorm();
      if (way.allFinite() && other.chiSquare < word.chiSquare) {
        gain = word.chiSquare - other.chiSquare;
        word = std::move(other);
        damping = std::max(0.2 * damping, 1e-7);
      } else {
        damping = std::max(10 * damping, 1e-3);
      }
    }
    if (gain < 1e-3 + 1e-5 * word.chiSquare) {
      break;
    }
  }
}

void vpWordFit::refine(Word &word) const
{
  for (int round = 0; round < 6; ++round) {
    descend(word);
    const std::vector<char> before = word.chips;
    least(word, lightOf(word), &word.chips);
    if (word.chips == before) {
      break;
    }
  }
  word.chiSquare = fitLight(word) + prior(word).squaredNorm();
  measureMisfit(word);
}

void vpWordFit::measureMisfit(Word &word) const
{
  const auto n = static_cast<double>(m_weight.size());
  Eigen::VectorXd residuals(static_cast<Eigen::Index>(m_weight.size()));
  fitLight(word, &residuals);
  double mean = 0;
  for (double light : m_profile->light) {
    mean += light / n;
  }
  double power = 0, left = 0;
  for (size_t i = 0; i < m_weight.size(); ++i) {
    const double residual = residuals(static_cast<Eigen::Index>(i));
    const double noise = m_profile->sigma[i];
    left += residual * residual / m_weight[i] - noise * noise;
    power += (m_profile->light[i] - mean) * (m_profile->light[i] - mean);
  }
  word.misfit = std::max(0.0, left) / std::max(power, 1e-9);
}

END_VISP_NAMESPACE
