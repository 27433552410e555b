/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpPulseWave.h"

#include <algorithm>
#include <cmath>

#include <visp3/vlp_core/vpSimdClones.h>

BEGIN_VISP_NAMESPACE

namespace
{
struct Wave {
  double frequency, phase, width, duty;
};

const double narrowest = 1e-6; // periods

// The wave's integral from 0 to x periods is floor(x) duty + min(x - floor(x), duty).
VP_SIMD_CLONES void addValues(const double *time, Eigen::Index n, const Wave &wave, double *sum)
{
  const double frequency = wave.frequency, phase = wave.phase, duty = wave.duty, half = 0.5 * wave.width,
               perWidth = 1 / wave.width;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double middle = frequency * time[i] + phase, to = middle + half, from = middle - half;
    const double wholeTo = std::floor(to), wholeFrom = std::floor(from);
    sum[i] +=
        ((wholeTo - wholeFrom) * duty + std::min(to - wholeTo, duty) - std::min(from - wholeFrom, duty)) *
        perWidth;
  }
}

VP_SIMD_CLONES void evaluateAll(const double *time, Eigen::Index n, const Wave &wave, double *value,
                                double *byTurn, double *byWidth, double *byDuty)
{
  const double frequency = wave.frequency, phase = wave.phase, duty = wave.duty, half = 0.5 * wave.width,
               perWidth = 1 / wave.width;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double middle = frequency * time[i] + phase, to = middle + half, from = middle - half;
    const double wholeTo = std::floor(to), wholeFrom = std::floor(from), begunTo = to - wholeTo,
                 begunFrom = from - wholeFrom;
    const double litTo = begunTo < duty ? 1 : 0, litFrom = begunFrom < duty ? 1 : 0;
    const double periods = wholeTo - wholeFrom;
    const double mean = (periods * duty + std::min(begunTo, duty) - std::min(begunFrom, duty)) * perWidth;
    value[i] = mean;
    byTurn[i] = (litTo - litFrom) * perWidth;
    byWidth[i] = (0.5 * (litTo + litFrom) - mean) * perWidth;
    byDuty[i] = (periods + litFrom - litTo) * perWidth;
  }
}
} // namespace

void vpPulseWave::evaluate(const Eigen::ArrayXd &time, double frequency, double phase, double width,
                           double duty)
{
  for (Eigen::ArrayXd *array : {&value, &byTurn, &byWidth, &byDuty}) {
    array->resize(time.size());
  }
  evaluate(time.data(), time.size(), frequency, phase, width, duty, value.data(), byTurn.data(),
           byWidth.data(), byDuty.data());
}

void vpPulseWave::evaluate(const double *time, Eigen::Index n, double frequency, double phase, double width,
                           double duty, double *value, double *byTurn, double *byWidth, double *byDuty)
{
  evaluateAll(time, n, {frequency, phase, std::max(width, narrowest), duty}, value, byTurn, byWidth, byDuty);
}

void vpPulseWave::addValue(const Eigen::ArrayXd &time, double frequency, double phase, double width,
                           double duty, Eigen::ArrayXd &sum)
{
  addValues(time.data(), time.size(), {frequency, phase, std::max(width, narrowest), duty}, sum.data());
}

END_VISP_NAMESPACE
