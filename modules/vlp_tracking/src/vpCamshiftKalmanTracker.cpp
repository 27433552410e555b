/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_tracking/vpCamshiftKalmanTracker.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include <visp3/core/vpException.h>

#include "vpExpectedAppearance.h"
#include "vpGrownSearch.h"
#include "vpPositionFilter.h"
#include "vpTargetModel.h"
#include "vpWindowSums.h"

BEGIN_VISP_NAMESPACE

namespace
{
template <class Pixel>
auto binsOf(const vpImage<Pixel> &)
{
  return std::conditional_t<std::is_same_v<Pixel, vpRGBa>, vpColourBins, vpGreyBins>();
}

//! About the same middle.
vpRect scaled(const vpRect &window, double factor)
{
  vpRect result(0, 0, window.getWidth() * factor, window.getHeight() * factor);
  result.moveCenter(window.getCenter());
  return result;
}

vpRect moved(const vpRect &window, double du, double dv)
{
  return vpRect(window.getLeft() + du, window.getTop() + dv, window.getWidth(), window.getHeight());
}

//! A share of the kernel too small to judge by.
const double leastVisible = 0.2;
const double nearlyWhole = 0.98;

const double surroundings = 2; // window sizes on a side
} // namespace

struct vpCamshiftKalmanTracker::Candidate : vpTargetCandidate {
};

struct vpCamshiftKalmanTracker::Impl {
  vpTargetModel model;
  vpExpectedAppearance appearance;
  vpPositionFilter filter;
  vpWindowSums sums;
  vpGrownSearch grown;
  bool colour = false;
  unsigned int pictureWidth = 0, pictureHeight = 0; // px
  double width = 0, height = 0;                     // px, of the window; 0 before initTracking()
  double firstWidth = 0, firstHeight = 0;           // px
  double offsetU = 0, offsetV = 0; // window sizes, its middle from that of what tells the target
  double acceleration = 0;         // px/frame^2, standard deviation
  int missed = 0;                  // frames since it was seen
  int refreshableFrames = 0;
  bool predicted = false; // since it began

  double size() const { return std::sqrt(width * height); }

  void check(const char *method) const
  {
    if (width == 0) {
      throw vpException(vpException::notInitialized, "%s: no target yet, expected initTracking() before",
                        method);
    }
  }
};

vpCamshiftKalmanTracker::vpCamshiftKalmanTracker() : m_impl(std::make_unique<Impl>()) {}

vpCamshiftKalmanTracker::~vpCamshiftKalmanTracker() = default;

double vpCamshiftKalmanTracker::measurementSigma(double rho) const
{
  if (!(rho >= threshold && rho > 0)) {
    return std::numeric_limits<double>::infinity();
  }
  return noiseFloor + noiseScale * m_impl->size() * (1 - std::min(rho, 1.0)) / rho;
}

vpImagePoint vpCamshiftKalmanTracker::velocity() const
{
  m_impl->check("velocity");
  return m_impl->filter.velocity();
}

double vpCamshiftKalmanTracker::positionSigma() const
{
  m_impl->check("positionSigma");
  return m_impl->filter.positionSigma();
}

template <class Pixel>
vpTargetTracker::Sighting vpCamshiftKalmanTracker::beginWith(const vpImage<Pixel> &I, const vpRect &window)
{
  Impl &own = *m_impl;
  own = Impl();
  own.colour = std::is_same_v<Pixel, vpRGBa>;
  own.pictureWidth = I.getWidth();
  own.pictureHeight = I.getHeight();
  own.width = own.firstWidth = window.getWidth();
  own.height = own.firstHeight = window.getHeight();
  const auto binOf = binsOf(I);
  own.model.learn(own.colour, own.sums.histogram(I, binOf, window),
                  own.sums.histogramAround(I, binOf, window, scaled(window, surroundings)));

  // The middle of what tells the target from its surroundings need not be that of the window given.
  static const double farthest = 0.25;
  const Candidate rest = meanShift(I, window);
  const vpImagePoint middle = window.getCenter(), found = rest.window.getCenter();
  auto offset = [](double difference, double length) {
    return std::clamp(difference / length, -farthest, farthest);
  };
  own.offsetU = offset(middle.get_u() - found.get_u(), own.width);
  own.offsetV = offset(middle.get_v() - found.get_v(), own.height);
  Candidate given = rest;
  given.shares = own.sums.histogram(I, binOf, window);
  given.mass = own.model.mass(given.shares);
  own.appearance.begin(given);
  own.acceleration = steadiness * own.size();
  own.filter.init(middle, noiseFloor, startVelocity * own.size());
  return {window, own.model.bhattacharyya(given.shares), true};
}

template <class Pixel>
vpTargetTracker::Sighting vpCamshiftKalmanTracker::followIn(const vpImage<Pixel> &I)
{
  if (m_impl->colour != std::is_same_v<Pixel, vpRGBa>) {
    throw vpException(vpException::badValue,
                      m_impl->colour ? "track: the picture is grey, expected colours as in initTracking()"
                                     : "track: the picture has colours, expected grey as in initTracking()");
  }
  const vpRect predicted = predictWindow();
  m_impl->predicted = true;
  Candidate seen = meanShift(I, predicted);
  bool recognized = seen.coefficient >= (m_impl->missed == 0 ? threshold : regainThreshold);
  if (!recognized) {
    seen = bestOfEightNeighbours(I, predicted);
    recognized = seen.coefficient >= regainThreshold;
  }
  if (!recognized) {
    seen = bestOfGrownWindow(I, predicted);
    recognized = seen.coefficient >= regainThreshold;
  }
  if (recognized) {
    correctBy(seen);
    adaptSize(seen);
    refreshModel(I, seen);
    m_impl->missed = 0;
  } else {
    m_impl->filter.coast();
    ++m_impl->missed;
  }
  vpRect window(0, 0, m_impl->width, m_impl->height);
  window.moveCenter(m_impl->filter.position());
  return {window, seen.coefficient, recognized};
}

//! A target that left the picture is expected where it left: its velocity ends half a window outside.
vpRect vpCamshiftKalmanTracker::predictWindow()
{
  Impl &own = *m_impl;
  auto predict = [&own] { return own.filter.predict(own.acceleration); };
  vpImagePoint middle = predict();
  auto reachable = [](double x, double length, unsigned int pixels) {
    return std::clamp(x, -0.5 * length, pixels + 0.5 * length);
  };
  const vpImagePoint nearest(reachable(middle.get_v(), own.height, own.pictureHeight),
                             reachable(middle.get_u(), own.width, own.pictureWidth));
  if (nearest != middle) {
    own.filter.rest(nearest);
    middle = predict();
  }
  vpRect window(0, 0, own.width, own.height);
  window.moveCenter(middle);
  return window;
}

template <class Pixel>
vpCamshiftKalmanTracker::Candidate vpCamshiftKalmanTracker::meanShift(const vpImage<Pixel> &I,
                                                                      const vpRect &start)
{
  // Under a kernel that falls off, the mean of a target aside of the middle comes out nearer to it than the
  // target is, by about a third: steps are that much longer.
  static const double stride = 1.5;
  static const double finest = 0.2; // px
  const double still = std::max(finest, convergence * std::sqrt(start.getWidth() * start.getHeight()));
  Impl &own = *m_impl;
  const auto binOf = binsOf(I);
  const double offsetU = own.offsetU * start.getWidth();
  const double offsetV = own.offsetV * start.getHeight();
  Candidate candidate;
  vpRect search = scaled(moved(start, -offsetU, -offsetV), 1 + 2 * searchMargin);
  for (int i = 0; i < maxIterations; ++i) {
    candidate.moments = own.sums.moments(I, binOf, own.model.weights(), search, 1 / (1 + 2 * searchMargin));
    const double du = stride * candidate.moments.meanU, dv = stride * candidate.moments.meanV;
    search = moved(search, du, dv);
    if (std::hypot(du, dv) < still) {
      break;
    }
  }
  candidate.window = moved(scaled(search, 1 / (1 + 2 * searchMargin)), offsetU, offsetV);
  candidate.shares = own.sums.histogram(I, binOf, candidate.window);
  candidate.mass = own.model.mass(candidate.shares);
  candidate.visible = own.sums.visible();
  candidate.coefficient = candidate.visible < leastVisible ? 0 : own.model.bhattacharyya(candidate.shares);
  return candidate;
}

template <class Pixel>
vpCamshiftKalmanTracker::Candidate vpCamshiftKalmanTracker::bestOfEightNeighbours(const vpImage<Pixel> &I,
                                                                                  const vpRect &window)
{
  double highest = -1;
  vpRect best;
  for (int row = -1; row <= 1; ++row) {
    for (int column = -1; column <= 1; ++column) {
      if (row == 0 && column == 0) {
        continue;
      }
      const vpRect neighbour = moved(window, column * window.getWidth(), row * window.getHeight());
      const vpBinShares shares = m_impl->sums.histogram(I, binsOf(I), neighbour);
      const double coefficient =
          m_impl->sums.visible() < leastVisible ? 0 : m_impl->model.bhattacharyya(shares);
      if (coefficient > highest) {
        highest = coefficient;
        best = neighbour;
      }
    }
  }
  return meanShift(I, best);
}

template <class Pixel>
vpCamshiftKalmanTracker::Candidate vpCamshiftKalmanTracker::bestOfGrownWindow(const vpImage<Pixel> &I,
                                                                              const vpRect &window)
{
  static const double neighbourhood = 3; // windows on a side: what the eight neighbours cover
  static const double sigmas = 3;        // standard deviations of the prediction
  static const int places = 3;
  const double growth = std::pow(searchGrowth, m_impl->missed);
  const double width =
      neighbourhood * growth * window.getWidth() + 2 * sigmas * m_impl->filter.predictedSigma();
  const double height =
      neighbourhood * growth * window.getHeight() + 2 * sigmas * m_impl->filter.predictedSigma();
  vpRect region(0, 0, std::min(width, 3.0 * I.getWidth()), std::min(height, 3.0 * I.getHeight()));
  region.moveCenter(window.getCenter());
  Candidate best;
  best.window = window;
  for (const vpRect &place :
       m_impl->grown.find(I, binsOf(I), m_impl->model.weights(), region, window, places)) {
    const Candidate candidate = meanShift(I, place);
    if (candidate.coefficient > best.coefficient) {
      best = candidate;
    }
  }
  return best;
}

/*!
  The measurement noise covers what a sighting that is not as expected may be off by. An innovation beyond
  that, and beyond the prediction's own sigma, is the target's: it changes its velocity, and the prediction is
  made again with as much process noise, which then calms down slowly. So a target that goes straight is not
  pulled off by what hides half of it, and one that turns is followed.
*/
void vpCamshiftKalmanTracker::correctBy(const Candidate &seen)
{
  Impl &own = *m_impl;
  const vpImagePoint measured = seen.window.getCenter();
  const double innovation = vpImagePoint::distance(measured, own.filter.predicted());
  double sigma = measurementSigma(std::max(own.appearance.plausibility(seen), threshold)) / seen.visible;
  if (innovation > own.size()) { // farther than anything hidden could move the middle of the rest
    sigma = std::min(sigma, 0.25 * own.size());
  }
  correctBy(measured, sigma);
}

void vpCamshiftKalmanTracker::correctBy(const vpImagePoint &measured, double sigma)
{
  static const double covered = 2; // standard deviations
  static const double calming = 0.9;
  Impl &own = *m_impl;
  const double innovation = vpImagePoint::distance(measured, own.filter.predicted());
  const double manoeuvre = innovation - covered * std::hypot(sigma, own.filter.predictedSigma());
  own.acceleration = std::max(steadiness * own.size(), calming * own.acceleration);
  if (own.missed > 0 && manoeuvre > 0) { // no longer on its way: how it came there is unknown
    own.filter.init(measured, sigma, startVelocity * own.size());
    return;
  }
  if (manoeuvre > own.acceleration) {
    own.acceleration = std::min(manoeuvre, own.size());
    own.filter.predict(own.acceleration);
  }
  own.filter.correct(measured, sigma);
}

//! What comes nearer is where it was expected; what hides a part of the target, or passes by, pulls.
void vpCamshiftKalmanTracker::adaptSize(const Candidate &seen)
{
  static const double most = 3; // times the first size, or a part of it
  Impl &own = *m_impl;
  const double pulled = vpImagePoint::distance(seen.window.getCenter(), own.filter.predicted());
  const bool pulls = pulled > 0.05 * own.size() + 2 * own.filter.predictedSigma();
  if (seen.visible < nearlyWhole ||
      !(own.appearance.asExpected(seen) || (own.appearance.changedAlike(seen) && !pulls))) {
    return;
  }
  auto adapted = [this](double length, double growth, double first) {
    const double wanted = std::pow(growth, sizeRate);
    const double bounded = std::clamp(wanted, 1 / (1 + maxSizeChange), 1 + maxSizeChange);
    return std::clamp(length * bounded, std::max(4.0, first / most), first * most);
  };
  own.width = adapted(own.width, own.appearance.growthAcross(seen), own.firstWidth);
  own.height = adapted(own.height, own.appearance.growthDown(seen), own.firstHeight);
}

template <class Pixel>
void vpCamshiftKalmanTracker::refreshModel(const vpImage<Pixel> &I, const Candidate &seen)
{
  Impl &own = *m_impl;
  if (seen.coefficient < refreshThreshold || own.appearance.plausibility(seen) < refreshThreshold ||
      seen.visible < nearlyWhole) {
    return;
  }
  own.appearance.learn(seen);
  if (!own.appearance.asExpected(seen)) {
    return;
  }
  if (++own.refreshableFrames % std::max(1, refreshInterval) == 0) {
    own.model.refresh(seen.shares,
                      own.sums.histogramAround(I, binsOf(I), seen.window, scaled(seen.window, surroundings)),
                      refreshRate);
  }
}

vpTargetTracker::Sighting vpCamshiftKalmanTracker::begin(const vpImage<unsigned char> &I,
                                                         const vpRect &window)
{
  return beginWith(I, window);
}

vpTargetTracker::Sighting vpCamshiftKalmanTracker::begin(const vpImage<vpRGBa> &I, const vpRect &window)
{
  return beginWith(I, window);
}

//! The target is learned anew, its motion is not.
vpTargetTracker::Sighting vpCamshiftKalmanTracker::setRight(const vpImage<unsigned char> &I,
                                                            const vpRect &window)
{
  const vpPositionFilter filter = m_impl->filter;
  const double acceleration = m_impl->acceleration;
  const int missed = m_impl->missed;
  const bool moved = m_impl->predicted;
  Sighting sighting = beginWith(I, window);
  if (moved) {
    m_impl->filter = filter;
    m_impl->acceleration = acceleration;
    m_impl->missed = missed;
    correctBy(window.getCenter(), noiseFloor);
    m_impl->missed = 0;
    m_impl->predicted = true;
  }
  return sighting;
}

//! As good a measurement as there is; the model is not learned from it.
std::optional<vpTargetTracker::Sighting> vpCamshiftKalmanTracker::seenAt(const vpRect &window)
{
  predictWindow();
  m_impl->predicted = true;
  correctBy(window.getCenter(), noiseFloor);
  m_impl->width = window.getWidth();
  m_impl->height = window.getHeight();
  m_impl->missed = 0;
  return Sighting{window, similarity(), true};
}

vpTargetTracker::Sighting vpCamshiftKalmanTracker::follow(const vpImage<unsigned char> &I)
{
  return followIn(I);
}

vpTargetTracker::Sighting vpCamshiftKalmanTracker::follow(const vpImage<vpRGBa> &I)
{
  return followIn(I);
}

END_VISP_NAMESPACE
