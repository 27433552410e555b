/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpPlaceModel.h"

#include <algorithm>
#include <cmath>
#include <limits>

BEGIN_VISP_NAMESPACE

namespace
{
const double gate = vpPlaceModel::gate;
const double leastDepth = vpPlaceModel::leastDepth;
const size_t noLamp = vpLampMatch::noLamp;

double square(double x)
{
  return x * x;
}
} // namespace

vpPlaceModel::vpPlaceModel(const vpLampMatcher &settings, const vpLampIndex &index,
                           const std::vector<vpSeenLamp> &seen, double pictureArea, const Bounds &bounds)
    : m_settings(settings), m_index(index), m_seen(seen), m_area(pictureArea), m_bounds(bounds)
{
}

size_t vpPlaceModel::fewest() const
{
  return std::max<size_t>(
      2, static_cast<size_t>(std::ceil(m_settings.minShare * static_cast<double>(m_seen.size()))));
}

bool vpPlaceModel::withinBounds(const Place &place, double slack) const
{
  if (std::abs(place.height - m_bounds.height) > gate * m_bounds.heightSigma + slack) {
    return false;
  }
  return m_bounds.anywhere ||
         (std::abs(place.camera - m_bounds.around) <= m_bounds.reach + slack &&
          std::abs(std::arg(place.heading * std::polar(1.0, -m_bounds.heading))) <= m_bounds.turn + slack);
}

//! Where the ray of region \e i meets the height of a lamp, m.
vpPlaceModel::Complex vpPlaceModel::expected(const Place &place, size_t i, double lampHeight) const
{
  return place.camera + (lampHeight - place.height) * place.heading * m_seen[i].ray;
}

//! Of the distance between a lamp and the point that the ray of region \e i leads to, in each direction, m^2.
double vpPlaceModel::variance(size_t i, size_t lamp, double depth) const
{
  return square(std::max(m_index.lamp(lamp).positionSigma, m_settings.mapTolerance)) +
         square(depth) * m_seen[i].variance;
}

//! Squared, in standard deviations. \param poseVariance of the point that the ray leads to, m^2.
double vpPlaceModel::distance(const Place &place, size_t i, size_t lamp, double poseVariance) const
{
  const double height = m_index.lamp(lamp).height;
  return std::norm(m_index.lamp(lamp).place - expected(place, i, height)) /
         (variance(i, lamp, height - place.height) + poseVariance);
}

vpPlaceModel::Fit vpPlaceModel::fitOf(const Place &place) const
{
  Fit fit;
  for (size_t i = 0; i < m_seen.size(); ++i) {
    if (place.lamps[i] != noLamp) {
      const double height = m_index.lamp(place.lamps[i]).height;
      const double w = 1 / variance(i, place.lamps[i], height - place.height);
      fit.weight += w;
      fit.middle += w * m_seen[i].ray;
      fit.spread += w * std::norm(m_seen[i].ray);
      fit.lampHeight += w * height;
    }
  }
  fit.middle /= fit.weight;
  fit.lampHeight /= fit.weight;
  fit.spread -= fit.weight * std::norm(fit.middle);
  return fit;
}

double vpPlaceModel::poseVariance(const Fit &fit, size_t i) const
{
  return 1 / fit.weight + std::norm(m_seen[i].ray - fit.middle) / fit.spread;
}

//! Sets \e found to the lamps that region \e i may be and that hang where its ray leads.
void vpPlaceModel::lampsNear(const Place &place, size_t i, const vpSeenLamp::Option &option,
                             double poseVariance, std::vector<size_t> &found) const
{
  const double middle = 0.5 * (m_index.lowest() + m_index.highest());
  const double halfRange = 0.5 * (m_index.highest() - m_index.lowest());
  const double sigma =
      std::sqrt(square(std::max(m_settings.mapTolerance, m_index.greatestSigma())) +
                square(m_index.highest() - place.height) * m_seen[i].variance + poseVariance);
  m_index.within(option.identifier, expected(place, i, middle),
                 gate * sigma + halfRange * std::abs(m_seen[i].ray), found);
  const auto outside = [&](size_t lamp) {
    return (option.only != vpLampIndex::nowhere && option.only != lamp) ||
           distance(place, i, lamp, poseVariance) > square(gate);
  };
  found.erase(std::remove_if(found.begin(), found.end(), outside), found.end());
}

/*!
  Weighted least squares of the camera's place C and of w = heading * height over P_k = C + w q_k, lamps at
  other heights than the mean moved there along their rays; |w| weighed against the height that is expected.
*/
bool vpPlaceModel::refine(Place &place) const
{
  if (place.count < 2) {
    return false;
  }
  const Fit fit = fitOf(place);
  if (!(fit.spread > 0)) {
    return false;
  }
  Complex mean, slope;
  for (size_t i = 0; i < m_seen.size(); ++i) {
    if (place.lamps[i] != noLamp) {
      const vpLampIndex::Lamp &lamp = m_index.lamp(place.lamps[i]);
      const double w = 1 / variance(i, place.lamps[i], lamp.height - place.height);
      const Complex level = lamp.place - place.heading * (lamp.height - fit.lampHeight) * m_seen[i].ray;
      mean += w * level;
      slope += w * level * std::conj(m_seen[i].ray - fit.middle);
    }
  }
  slope /= fit.spread;
  if (!(std::abs(slope) > leastDepth)) {
    return false;
  }
  const double prior = 1 / square(m_bounds.heightSigma);
  const double depth =
      (fit.spread * std::abs(slope) + prior * (fit.lampHeight - m_bounds.height)) / (fit.spread + prior);
  place.heading = slope / std::abs(slope);
  place.height = fit.lampHeight - depth;
  place.camera = mean / fit.weight - place.heading * depth * fit.middle;
  return depth > leastDepth;
}

/*!
  Lamps on one line look the same in a mirror: seen in a glass wall, they would put the robot behind it. So
  they are no place where more than a quarter of the regions stays unexplained.
*/
bool vpPlaceModel::tooFewOnALine(const Place &place) const
{
  if (4 * place.count >= 3 * m_seen.size()) {
    return false;
  }
  const Fit fit = fitOf(place);
  Complex slant; // the spread is the sum of the squared deviations along and across the line, this their
                 // difference
  for (size_t i = 0; i < m_seen.size(); ++i) {
    if (place.lamps[i] != noLamp) {
      const double depth = m_index.lamp(place.lamps[i]).height - place.height;
      const Complex off = m_seen[i].ray - fit.middle;
      slant += off * off / variance(i, place.lamps[i], depth);
    }
  }
  const double across = 0.5 * (fit.spread - std::abs(slant)) * square(fit.lampHeight - place.height);
  return across < square(gate) * static_cast<double>(place.count);
}

//! What a lamp adds to the log evidence where its residual is 0.
double vpPlaceModel::gain(size_t i, double variance, double depth) const
{
  double weight = -std::numeric_limits<double>::infinity();
  for (const vpSeenLamp::Option &option : m_seen[i].options) {
    weight = std::max(weight, option.weight);
  }
  return weight + std::log(m_area / m_settings.strangers) + std::log(square(depth) / (2 * M_PI * variance));
}

void vpPlaceModel::judge(Place &place) const
{
  const Fit fit = fitOf(place);
  double sum = 0;
  for (size_t i = 0; i < m_seen.size(); ++i) {
    const size_t lamp = place.lamps[i];
    if (lamp != noLamp) {
      const double depth = m_index.lamp(lamp).height - place.height;
      double weight = -std::numeric_limits<double>::infinity();
      for (const vpSeenLamp::Option &option : m_seen[i].options) {
        if (option.identifier == m_index.lamp(lamp).identifier) {
          weight = std::max(weight, option.weight);
        }
      }
      sum += weight + std::log(m_area / m_settings.strangers) - 0.5 * distance(place, i, lamp, 0) +
             std::log(square(depth) / (2 * M_PI * variance(i, lamp, depth)));
    }
  }
  const double depth = fit.lampHeight - place.height;
  const double sigma = m_bounds.heightSigma;
  const double room = m_bounds.anywhere ? m_index.area(depth) : M_PI * square(m_bounds.reach);
  // Density over C and w: that of place, heading and height, and d^2w = |w| dheight dheading.
  const double prior = -std::log(room * 2 * m_bounds.turn * depth * std::sqrt(2 * M_PI) * sigma) -
                       0.5 * square((place.height - m_bounds.height) / sigma);
  const double volume = 2 * std::log(2 * M_PI) - std::log(fit.weight) -
                        0.5 * std::log(fit.spread * (fit.spread + 1 / square(sigma)));
  place.logEvidence = sum + prior + volume;
}

double vpPlaceModel::chance() const
{
  const double depth = std::max(leastDepth, 0.5 * (m_index.lowest() + m_index.highest()) - m_bounds.height);
  const double inView = static_cast<double>(m_index.size()) * square(depth) * m_area / m_index.area(depth);
  return std::log(1 + static_cast<double>(m_seen.size()) * inView / m_settings.strangers);
}

END_VISP_NAMESPACE
