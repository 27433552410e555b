/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpPlan.h"

#include <algorithm>
#include <iostream>

#include <spdlog/spdlog.h>
#include <visp3/vlp_evaluation/vpReportTable.h>

#include "vpPlanText.h"

BEGIN_VISP_NAMESPACE

namespace
{
std::string lampsOf(const vpLampMap &map, const vpIdentifier &identifier)
{
  const std::string first = map.lamps[identifier.lamps.front()].id;
  const size_t more = identifier.lamps.size() - 1;
  return more == 0 ? first : first + " and " + std::to_string(more) + " more";
}

vpReportTable pairTable(const vpLampMap &map, const std::vector<vpLedIdPair> &pairs, size_t worst)
{
  const std::vector<vpIdentifier> identifiers = map.identifiers();
  vpReportTable table;
  const size_t shown = std::min(worst, pairs.size());
  table.heading = "Pairs most likely to be confused (" + std::to_string(shown) + " of " +
                  std::to_string(pairs.size()) + ")";
  table.columns = {"lamp", "blinks", "and lamp", "blinks", "distance", "error", "chips apart"};
  for (size_t i = 0; i < shown; ++i) {
    const vpIdentifier &a = identifiers[pairs[i].first], &b = identifiers[pairs[i].second];
    table.rows.push_back({lampsOf(map, a), vpSignalText(a.modulation), lampsOf(map, b),
                          vpSignalText(b.modulation), vpFigureText(pairs[i].distance),
                          vpFigureText(pairs[i].error),
                          pairs[i].chips < 0 ? "" : std::to_string(pairs[i].chips)});
  }
  table.note = "Error: probability of taking the one for the other. Distance: standard deviations, at the "
               "phase of lamp "
               "against lines that hides most edges.";
  return table;
}

//! Lamps that blink faster than the rig can follow; empty where there are none.
std::string tooFast(const vpLampMap &map, const vpLedIdPlanner &planner)
{
  size_t count = 0;
  std::string first;
  for (const vpLamp &lamp : map.lamps) {
    if (lamp.modulation.frequency > planner.highest()) { // 0 of words
      first = count == 0 ? lamp.id : first;
      ++count;
    }
  }
  return count == 0 ? ""
                    : first + (count > 1 ? " and " + std::to_string(count - 1) + " more" : "") + ": above " +
                          vpFigureText(planner.highest()) +
                          " Hz, from where on exposure or rate of lines leave no stripes to rely on";
}

vpReportTable reuseTable(const vpLampMap &map, const std::vector<vpLedIdReuse> &shared, size_t worst)
{
  const std::vector<vpIdentifier> identifiers = map.identifiers();
  vpReportTable table;
  table.heading = "Identifiers that lamps share (" + std::to_string(shared.size()) + ")";
  table.columns = {"blinks", "lamps", "the nearest two", "", "m apart"};
  for (size_t i = 0; i < std::min(worst, shared.size()); ++i) {
    const vpIdentifier &identifier = identifiers[shared[i].identifier];
    table.rows.push_back({vpSignalText(identifier.modulation), std::to_string(identifier.lamps.size()),
                          map.lamps[shared[i].first].id, map.lamps[shared[i].second].id,
                          vpFigureText(shared[i].apart)});
  }
  table.note = "Only their places tell these lamps apart.";
  return table;
}
} // namespace

vpExitCode vpPlanCheck(const vpPlanOptions &options)
{
  const vpVlpRig rig = vpVlpRig::load(options.rig);
  const vpLampMap map = vpLampMap::load(options.check);
  const vpLedIdPlanner planner = options.planner(rig);
  const std::vector<vpLedIdPair> pairs = planner.confusion(map, options.highest, options.diameter);
  const std::vector<vpLedIdReuse> shared = vpLedIdPlanner::reuse(map);
  if (pairs.empty() && shared.empty()) {
    spdlog::error(options.check + ": no two lamps that blink alike, nothing to confuse");
    return vpExitCode::nothingFound;
  }
  if (const std::string warning = tooFast(map, planner); !warning.empty()) {
    spdlog::warn(warning);
  }
  if (!pairs.empty()) {
    std::cout << pairTable(map, pairs, options.worst).text();
    const size_t near = static_cast<size_t>(std::count_if(
        pairs.begin(), pairs.end(), [&](const vpLedIdPair &pair) { return pair.error > options.error / 2; }));
    std::cout << "  " << near << " nearer than an error of " << vpFigureText(options.error)
              << " with a neighbour on both sides allows.\n";
  }
  if (!shared.empty()) {
    std::cout << (pairs.empty() ? "" : "\n") << reuseTable(map, shared, options.worst).text();
  }
  return vpExitCode::done;
}

END_VISP_NAMESPACE
