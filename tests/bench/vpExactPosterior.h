/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpExactPosterior_h
#define vpExactPosterior_h

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <visp3/vlp_identification/vpStripeAnalyzer.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

/*!
  The posterior of a lamp of one pulse a period, by brute force and from the model alone: a line shows offset
  plus amplitude times the lit share of its exposure, and Gaussian noise of known variance. Offset and
  amplitude are eliminated in closed form. Frequency, phase and duty are as likely one as the other; the
  exposure's logarithm is Gaussian about the stated one, or the exposure is known.

  Boxes about the truth are cut into halves along each axis until they are small beside the posterior. A box
  goes when its middle is too unlikely for any place in it to count.
*/
class vpExactPosterior
{
public:
  struct Estimate {
    double frequency = 0, frequencySigma = 0; // Hz
    double duty = 0, dutySigma = 0;
  };

  //! \param profile What was seen. \param lineStep s, mean, of its lines. \param glow Standard deviation of
  //! the dark lamp's light about 0, grey levels.
  vpExactPosterior(const vpStripeProfile &profile, double lineStep, double glow)
      : m_profile(profile), m_glow(glow), m_lineStep(lineStep),
        m_middle(0.5 * (profile.time.front() + profile.time.back())),
        m_half(0.5 * std::abs(profile.time.back() - profile.time.front()))
  {
  }

  //! \param phase Periods since a pulse began, at the profile's middle. \param exposure s, the true one.
  Estimate about(double frequency, double phase, double duty, double exposure) const
  {
    const bool open = m_profile.logExposureSigma > 0;
    static const int reach = 12; // boxes of an eighth of a line, to each side
    Place size{frequency * m_lineStep / 8 / m_half, frequency * m_lineStep / 8, frequency * m_lineStep / 8,
               open ? 0.35 : 0};
    std::vector<Box> boxes;
    const double log = std::log(exposure / m_profile.exposure);
    const int exposures = open ? reach / 2 : 0; // to three standard deviations
    for (int e = -exposures; e <= exposures; ++e)
      for (int i = -reach; i <= reach; ++i)
        for (int j = -reach; j <= reach; ++j)
          for (int k = -reach; k <= reach; ++k) {
            boxes.push_back(
                {{frequency + i * size[0], phase + j * size[1], duty + k * size[2], log + e * size[3]}, 0});
          }
    static const int levels = 6;
    static const size_t enough = 20000; // boxes: more of them would tell no more
    double margin = 600;                // chi-square of half a box, about: a quarter at half the size
    for (int level = 0; level < levels; ++level, margin /= 4) {
      evaluate(boxes, explained + margin);
      if (level + 1 == levels || boxes.size() > enough) {
        break;
      }
      halve(boxes, size);
    }
    return momentsOf(boxes, size);
  }

private:
  using Place = std::array<double, 4>; // Hz, periods, share, logarithm
  struct Box {
    Place at;
    double chiSquare;
  };
  static constexpr double explained = 25; // chi-square

  //! Chi-squares of the boxes' middles; those by \e most above the least go.
  void evaluate(std::vector<Box> &boxes, double most) const
  {
    double least = std::numeric_limits<double>::infinity();
    for (Box &box : boxes) {
      box.chiSquare = chiSquare(box.at);
      least = std::min(least, box.chiSquare);
    }
    boxes.erase(std::remove_if(boxes.begin(), boxes.end(),
                               [&](const Box &box) { return !(box.chiSquare <= least + most); }),
                boxes.end());
  }

  static void halve(std::vector<Box> &boxes, Place &size)
  {
    for (size_t axis = 0; axis < size.size(); ++axis) {
      const size_t count = size[axis] > 0 ? boxes.size() : 0;
      for (size_t i = 0; i < count; ++i) {
        Box other = boxes[i];
        other.at[axis] += 0.25 * size[axis];
        boxes[i].at[axis] -= 0.25 * size[axis];
        boxes.push_back(other);
      }
      size[axis] *= 0.5;
    }
  }

  static Estimate momentsOf(const std::vector<Box> &boxes, const Place &size)
  {
    const Box &some = boxes.front();
    double least = std::numeric_limits<double>::infinity(), sum = 0, first[2] = {0, 0}, second[2] = {0, 0};
    for (const Box &box : boxes) {
      least = std::min(least, box.chiSquare);
    }
    for (const Box &box : boxes) {
      const double weight = std::exp(-0.5 * (box.chiSquare - least)),
                   off[2] = {box.at[0] - some.at[0], box.at[2] - some.at[2]};
      sum += weight;
      for (int k = 0; k < 2; ++k) {
        first[k] += weight * off[k];
        second[k] += weight * off[k] * off[k];
      }
    }
    auto sigma = [&](int k, double box) {
      return std::sqrt(std::max(0.0, second[k] / sum - std::pow(first[k] / sum, 2)) + box * box / 12);
    };
    return {some.at[0] + first[0] / sum, sigma(0, size[0]), some.at[2] + first[1] / sum, sigma(1, size[2])};
  }

  //! Lit time from 0 to \e x > 0 periods.
  static double litUntil(double x, double duty)
  {
    const double whole = static_cast<int>(x);
    return whole * duty + std::min(x - whole, duty);
  }

  double chiSquare(const Place &at) const
  {
    static const double leastDuty = 0.05;
    const double f = at[0], duty = at[2], half = 0.5 * f * m_profile.exposure * std::exp(at[3]);
    if (duty < leastDuty || duty > 1 - leastDuty) {
      return std::numeric_limits<double>::infinity();
    }
    const double variance = m_profile.sigma.front() * m_profile.sigma.front();
    double n = variance / (m_glow * m_glow), x = 0, y = 0, xx = 0, xy = 0, yy = 0;
    for (size_t i = 0; i < m_profile.light.size(); ++i) {
      static const double many = 1000; // whole periods: all times are after time 0
      const double turns = f * (m_profile.time[i] - m_middle) + at[1] + many,
                   share = (litUntil(turns + half, duty) - litUntil(turns - half, duty)) / (2 * half),
                   light = m_profile.light[i];
      n += 1;
      x += share;
      y += light;
      xx += share * share;
      xy += share * light;
      yy += light * light;
    }
    const double sxx = xx - x * x / n, sxy = xy - x * y / n, syy = yy - y * y / n;
    const double unlikely =
        m_profile.logExposureSigma > 0 ? std::pow(at[3] / m_profile.logExposureSigma, 2) : 0;
    return (syy - (sxx > 1e-9 && sxy > 0 ? sxy * sxy / sxx : 0)) / variance + unlikely;
  }

  const vpStripeProfile &m_profile;
  double m_glow, m_lineStep, m_middle, m_half;
};

#endif
