/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLampNames.h"

#include <algorithm>

BEGIN_VISP_NAMESPACE

namespace
{
size_t timesSeen(const std::string &id, const std::vector<vpLampObservation> &observations)
{
  return static_cast<size_t>(std::count_if(observations.begin(), observations.end(),
                                           [&](const vpLampObservation &other) { return other.id == id; }));
}

} // namespace

bool namedApart(const std::vector<vpLampObservation> &observations, const std::vector<size_t> &usable)
{
  return std::all_of(usable.begin(), usable.end(), [&](size_t i) {
    const std::string &id = observations[i].id;
    return !id.empty() && timesSeen(id, observations) == 1;
  });
}

void nameByPlace(const vpLampMatch &match, const vpLampMap &map, std::vector<vpLampObservation> &observations,
                 std::vector<size_t> &usable)
{
  const bool unique = match.outcome == vpLampMatch::Outcome::unique;
  std::vector<size_t> named;
  for (size_t i : usable) {
    vpLampObservation &lamp = observations[i];
    const size_t times = lamp.id.empty() ? 0 : timesSeen(lamp.id, observations);
    if (unique && match.lamps[i] != vpLampMatch::noLamp) {
      lamp.id = map.lamps[match.lamps[i]].id;
      lamp.confidence = match.probabilities[i];
      lamp.remark.clear();
      named.push_back(i);
    } else if (unique) {
      lamp.remark = (lamp.id.empty() ? "no lamp of the map hangs there: a reflection"
                                     : "a reflection of lamp " + lamp.id) +
                    ", or another lamp that blinks alike";
    } else if (times == 1) {
      named.push_back(i);
    } else {
      lamp.remark =
          times == 0 ? match.refusal
                     : "seen " + std::to_string(times) + " times, a reflection among them: " + match.refusal;
    }
  }
  usable = named;
}

END_VISP_NAMESPACE
