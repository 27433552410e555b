/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLampTrack.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

BEGIN_VISP_NAMESPACE

//! What the picture shows at its place.
void vpLampTracker::Track::remember(const vpImage<unsigned char> &I)
{
  look.clear();
  const auto left = static_cast<unsigned int>(place.getLeft()),
             top = static_cast<unsigned int>(place.getTop()),
             width = static_cast<unsigned int>(place.getWidth()),
             height = static_cast<unsigned int>(place.getHeight());
  for (unsigned int v = top; v < top + height; ++v) {
    look.insert(look.end(), I[v] + left, I[v] + left + width);
  }
}

bool vpLampTracker::Track::isElsewhere(const vpLampObservation &lamp) const
{
  static const double far = 1, farthest = 1.4; // of its size; of one that is no plain wave
  static const double vague = 5, off = 3;      // times the sigma of what is known; sigma
  const vpStripeFeatures &now = lamp.features, &past = evidence.features();
  if (!vpLedIdEvidence::tells(now) || !vpLedIdEvidence::tells(past) ||
      now.frequencySigma <= vague * past.frequencySigma) {
    return false;
  }
  const vpImagePoint middle(lamp.outline.centre.y(), lamp.outline.centre.x());
  const bool pwm = now.signal == vpStripeFeatures::Signal::pwm && past.signal == now.signal;
  return vpImagePoint::distance(middle, told.getCenter()) >
             (pwm ? far : farthest) * std::max(told.getWidth(), told.getHeight()) ||
         (pwm && std::abs(now.frequency - past.frequency) > off * now.frequencySigma);
}

//! A lamp that is recognised for certain may be reacquired in the next frame. What fits none, shows
//! no word, and is not as it was in the frame before, is a stranger.
void vpLampTracker::Track::learn(const vpLampObservation &lamp, unsigned int enough, double minConfidence)
{
  fits = !lamp.candidates.empty();
  if (fits || !lamp.features.chips.empty() || found) {
    strange = 0;
  } else if (vpLedIdEvidence::tells(lamp.features)) {
    ++strange;
  }
  const bool decided = lamp.candidates.size() <= 1 && lamp.confidence >= minConfidence;
  sure = decided && evidence.frames() >= enough;
  if (sure) {
    known = lamp;
  }
}

//! Whether another one shows the same, pixel for pixel.
bool vpLampTracker::Track::showsAgain(const vpImage<unsigned char> &I) const
{
  const auto left = static_cast<unsigned int>(place.getLeft()),
             top = static_cast<unsigned int>(place.getTop()),
             width = static_cast<unsigned int>(place.getWidth());
  for (size_t line = 0; line * width < look.size(); ++line) {
    const auto first = look.begin() + static_cast<std::ptrdiff_t>(line * width);
    if (!std::equal(first, first + width, I[top + static_cast<unsigned int>(line)] + left)) {
      return false;
    }
  }
  return true;
}

END_VISP_NAMESPACE
