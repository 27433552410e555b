/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <algorithm>
#include <cmath>

#include "vpWaveformFit.h"
#include "vpWaveformMoments.h"

BEGIN_VISP_NAMESPACE

namespace
{
const double deeper = 0.8; // chi-square of another minimum, as a share of that at hand
}

//! Descends from there. \return Whether it is another minimum, far below that at m_x.
bool vpWaveformFit::goOnFrom(const Eigen::Vector3d &place)
{
  const Vector before = m_x;
  const double least = m_cost;
  m_x.head<3>() = place;
  descend(10);
  if (m_cost < deeper * least) {
    judgeResiduals();
    return true;
  }
  m_x = before;
  settle();
  return false;
}

void vpWaveformFit::leaveGap()
{
  if (leavesGaps()) {
    const vpPulsePosterior::Place place =
        vpPulsePosterior::likeliest(linesWith(m_x(exposure)), m_x.head<3>(), m_freeDuty);
    if (place.least < deeper * m_chiSquare) {
      goOnFrom(place.at);
    }
  }
}

/*!
  Mean and covariance of exp(-cost / (2 inflation)) of one pulse a period, by all places on a grid, for each
  of the exposures that there may be: the fitted one and those to both sides, as far as the stripes leave it
  open.
*/
vpWaveformFit::Posterior vpWaveformFit::onGrid(const Posterior &bell)
{
  static const double different = 0.05, uncertain = 0.1, least = 0.2, // of the exposure's logarithm
      node = 1.22,                                                    // standard deviations
      hardly = 2;                                                     // of the evidence's logarithm
  const double fitted = m_x(exposure), off = std::abs(std::log(fitted / m_profile->exposure));
  const double sigma =
      std::min(std::sqrt(std::max(0.0, bell.covariance(exposure, exposure))) / fitted, m_logExposureSigma);
  std::vector<Posterior> parts;
  std::vector<double> logs;
  auto add = [&](const vpPulsePosterior::Moments &moments, double exposed) {
    Posterior part = bell;
    part.mean.head<3>() = moments.mean;
    part.mean(exposure) = exposed;
    part.covariance.topLeftCorner<3, 3>() = moments.covariance;
    parts.push_back(part);
    logs.push_back(moments.logEvidence - 0.5 * prior(exposure, part.mean).chiSquare);
  };
  const auto momentsWith = [this](double exposed) {
    return vpPulsePosterior::about(linesWith(exposed), m_x.head<3>(), m_freeDuty, m_inflation);
  };
  const vpPulsePosterior::Moments found = momentsWith(fitted);
  if (found.chiSquare < deeper * m_chiSquare && goOnFrom(found.mean)) {
    return onGrid(bell);
  }
  add(found, fitted);
  if (sigma > uncertain || off > different) {
    for (const double step : {-std::max(node * sigma, least), std::max(node * sigma, least)}) {
      double exposed = fitted;
      do {
        exposed *= std::exp(step);
        add(momentsWith(exposed), exposed);
      } while (logs.back() > logs.front() - hardly && exposed > m_leastExposure && exposed < m_mostExposure);
    }
  }
  const double most = *std::max_element(logs.begin(), logs.end());
  Moments all(m_x);
  Matrix within = Matrix::Zero();
  double sum = 0;
  for (size_t k = 0; k < parts.size(); ++k) {
    const double weight = std::exp(logs[k] - most);
    all.add(parts[k].mean, weight, 0);
    within += weight * parts[k].covariance;
    sum += weight;
  }
  return {all.mean(), all.covariance() + within / sum};
}

//! The profile's, were that the exposure, s.
vpPulsePosterior::Lines vpWaveformFit::linesWith(double exposed) const
{
  vpPulsePosterior::Lines lines;
  lines.time = m_time.cast<float>();
  lines.light = m_light.cast<float>();
  lines.weight = m_weight.cast<float>();
  lines.lit = envelope().cast<float>();
  lines.dark = m_coefficient[0];
  lines.darkness = m_darkness;
  lines.step = m_line;
  lines.exposure = exposed;
  return lines;
}

END_VISP_NAMESPACE
