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

const int bendPlace = 6;     // in Word::light
const double brightest = 3;  // gain
const double mostBend = 0.9; // beyond, more light would be seen as less

//! The chips that a line's exposure touches, and its shares in them.
class Touch
{
public:
  Touch(const vpWordFit::Word &word)
      : m_perSecond(1 / word.chip), m_phase(word.phase), m_width(std::max(word.exposure / word.chip, 1e-6)),
        m_perChip(1 / m_width), m_chips(static_cast<long>(word.chips.size()))
  {
  }

  //! \param time s, from the middle of the profile. \return False where it touches too many.
  bool at(double time)
  {
    const double from = time * m_perSecond + m_phase - 0.5 * m_width, to = from + m_width;
    long chip = static_cast<long>(from);
    chip -= from < static_cast<double>(chip) ? 1 : 0; // std::floor is a call
    long ring = chip % m_chips;
    ring += ring < 0 ? m_chips : 0;
    first = static_cast<size_t>(ring);
    share.fill(0);
    double begin = from, end = static_cast<double>(chip + 1);
    for (count = 0; begin < to; ++count, begin = end, end += 1) {
      if (count == vpChipTrellis::widestWindow) {
        return false;
      }
      share[static_cast<size_t>(count)] = (std::min(to, end) - begin) * m_perChip;
    }
    return true;
  }

  size_t first = 0; // in the word
  int count = 0;
  std::array<double, vpChipTrellis::widestWindow> share{};

private:
  double m_perSecond, m_phase, m_width, m_perChip;
  long m_chips;
};

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
  m_exposure =
      std::max(profile.exposure, 0.02 * m_half / static_cast<double>(n)); // none at all has no logarithm
  // Peaks of single chips under a long exposure lie lower than those of long runs: what is lit and what is
  // dark say the brightest and the darkest lines.
  std::vector<double> share(n);
  for (size_t i = 0; i < n; ++i) {
    share[i] = profile.light[i] / m_given[i];
  }
  const double lit = std::max(quantile(share, 0.92), 0.3);
  const double dark = std::clamp(quantile(share, 0.05), 0.0, 0.7 * lit);
  for (double &given : m_given) {
    given *= lit - dark;
  }
  m_dark = dark / (lit - dark) * quantile(m_given, 0.5);
  for (size_t i = 0; i < n; ++i) {
    // A dark line has some light of its neighbours, by blur and compression.
    static const double spill = 0.01; // share of theirs, standard deviation
    const double missed = std::hypot(m_settings.modelError * profile.light[i], spill * m_given[i]);
    m_time.push_back(profile.time[i] - m_middle);
    m_weight.push_back(1 / (profile.sigma[i] * profile.sigma[i] + missed * missed));
  }
}

int vpWordFit::window(const Word &word)
{
  return std::max(2, static_cast<int>(std::ceil(word.exposure / word.chip - 1e-9)) + 1);
}

vpWordFit::Light vpWordFit::lightOf(const Word &word) const
{
  Light light{word.light[0], m_given, m_given};
  for (size_t i = 0; i < m_given.size(); ++i) {
    const double y = m_time[i] / m_half;
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
  const size_t patterns = size_t{1} << window;
  Touch touched(word);
  std::array<double, size_t{1} << vpChipTrellis::widestWindow> share{};
  for (size_t i = 0; i < m_weight.size(); ++i) {
    if (!touched.at(m_time[i]) || touched.count > window) {
      return false;
    }
    for (size_t j = 0, bit = 1; bit < patterns; ++j, bit <<= 1) {
      for (size_t p = 0; p < bit; ++p) {
        share[bit | p] = share[p] + touched.share[j];
      }
    }
    const double seen = m_profile->light[i] - light.offset;
    double *costs = trellis.costs(touched.first);
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
  static const double gainSigma = 0.3; // of its logarithm
  return {std::log(word.exposure / m_exposure) / m_settings.exposureTolerance,
          std::log(word.gain) / gainSigma};
}

//! Offset, envelope and bend by least squares with the word's chips. \return Chi-square.
double vpWordFit::fitLight(Word &word, Eigen::VectorXd *residuals) const
{
  constexpr int most = 7;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, most>;
  const auto lines = static_cast<Eigen::Index>(m_weight.size());
  const size_t n = word.chips.size();
  Rows A = Rows::Zero(lines, most);
  Eigen::VectorXd b(lines);
  Touch touched(word);
  for (Eigen::Index i = 0; i < lines; ++i) {
    const auto line = static_cast<size_t>(i);
    if (!touched.at(m_time[line])) {
      return 1e300;
    }
    double s = 0;
    size_t k = touched.first;
    for (int j = 0; j < touched.count; ++j, k = k + 1 == n ? 0 : k + 1) {
      s += word.chips[k] != 0 ? touched.share[static_cast<size_t>(j)] : 0;
    }
    s = std::min(1.0, word.gain * s);
    const double root = std::sqrt(m_weight[line]), y = m_time[line] / m_half;
    double lit = root * m_given[line] * s;
    A(i, 0) = root;
    A(i, bendPlace) = lit * (1 - s);
    for (int p = 1; p < m_linear - 1; ++p, lit *= y) {
      A(i, p) = lit;
    }
    b(i) = root * m_profile->light[line];
  }
  Eigen::Matrix<double, most, most> normal = A.transpose() * A;
  normal.diagonal().array() += 1e-9 * (normal(0, 0) + 1e-12);
  for (int p = 2; p < bendPlace; ++p) {
    normal(p, p) += 0.06; // bends of four times the envelope are one standard deviation
  }
  static const double bendSigma = 0.3; // envelopes, standard deviation
  normal(bendPlace, bendPlace) += 1 / (bendSigma * bendSigma);
  const Eigen::Matrix<double, most, 1> light = normal.ldlt().solve(A.transpose() * b);
  for (int p = 0; p < most; ++p) {
    word.light[static_cast<size_t>(p)] = light(p);
  }
  b -= A * light;
  if (residuals != nullptr) {
    residuals->head(lines) = b;
  }
  return light(1) > 0 ? b.squaredNorm() : 1e300; // a lamp that shines where it should be dark
}

//! A step of phase, of the duration and of the exposure, all in chips (the duration's at the profile's ends),
//! and of the gain's logarithm.
vpWordFit::Word vpWordFit::moved(const Word &word, const Place &step) const
{
  Word other = word;
  other.phase += step(0);
  other.chip /= 1 + step(1) * word.chip / m_half;
  other.exposure =
      std::clamp(word.exposure + step(2) * word.chip, 0.1 * std::min(word.chip, m_exposure), 3.9 * word.chip);
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
