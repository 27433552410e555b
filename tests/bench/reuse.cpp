/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Few identifiers over many lamps: how often a picture alone says where the robot is, and how long that
// takes; and how often geometry tells a reflection from its lamp. Prints two tables for tests/bench/reuse.md.

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <iomanip>
#include <iostream>
#include <numeric>
#include <sstream>

#include "vlp_localization/reuseScene.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
using reuseScene::Ceiling;
using reuseScene::Errors;
using reuseScene::View;
using Outcome = vpLampMatch::Outcome;

const size_t identifiers = 50;
int places = 1000;

//! Of this thread's own work: other programs of the machine do not count.
double milliseconds()
{
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

struct Times {
  std::vector<double> all; // ms

  double mean() const
  {
    return std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size());
  }
  double share95()
  {
    std::sort(all.begin(), all.end());
    return all[all.size() * 95 / 100];
  }
};

struct Score {
  int right = 0, refused = 0, wrong = 0;
  Times times;

  std::string shares() const
  {
    std::ostringstream text;
    text << std::fixed << std::setprecision(1) << right * 100.0 / places << " / " << refused * 100.0 / places
         << " / " << wrong;
    return text.str();
  }

  void match(const vpLampMatcher &matcher, const View &view, const std::optional<vpPoseHint> &hint)
  {
    const std::vector<size_t> all = view.all();
    const double start = milliseconds();
    const vpLampMatch match = matcher.match(view.observations, all, hint);
    times.all.push_back(milliseconds() - start);
    const bool isWrong = reuseScene::wrong(match, view);
    wrong += isWrong;
    right += match.outcome == Outcome::unique && !isWrong;
    refused += match.outcome != Outcome::unique;
  }
};

vpIdentifierAssignment layOver(const std::vector<Eigen::Vector3d> &positions)
{
  vpIdentifierLayout layout;
  layout.viewRadius = reuseScene::viewRadius;
  return layout.lay(positions, identifiers);
}

std::vector<size_t> atRandom(size_t lamps)
{
  lampScene::Random random(5);
  std::vector<size_t> given(lamps);
  for (size_t &identifier : given) {
    identifier = static_cast<size_t>(random.uniform(0, identifiers));
  }
  return given;
}

//! The robot was near here, and has moved by up to 0.2 m and 0.2 rad since.
vpPoseHint hintFor(Ceiling &ceiling, const vpHomogeneousMatrix &wMb)
{
  const double azimuth = ceiling.random().uniform(-M_PI, M_PI), moved = ceiling.random().uniform(0, 0.2);
  vpPoseHint hint;
  hint.wMb = lampScene::frame(moved * std::cos(azimuth), moved * std::sin(azimuth), 0, 0, 0, 0) * wMb *
             lampScene::frame(0, 0, 0, 0, 0, ceiling.random().uniform(-0.2, 0.2));
  hint.reach = hint.turn = 0.3;
  return hint;
}

struct Case {
  std::string name;
  double spacing = 1.2; // m
  double jitter = 0;    // m
  bool laid = true;     // else identifiers at random
  size_t exactly = 0;   // lamps in view of the places; 0: three or more
  Errors errors;
};

void coldStarts(const Case &each, size_t lamps)
{
  const std::vector<Eigen::Vector3d> positions = vpLampGrid(lamps, each.spacing, each.jitter, 7);
  const double start = milliseconds();
  const vpIdentifierAssignment laid = layOver(positions);
  const double layoutTime = (milliseconds() - start) / 1000;
  Ceiling ceiling(reuseScene::mapOf(positions, each.laid ? laid.identifiers : atRandom(lamps)), each.errors,
                  11);
  const vpLampMatcher matcher(reuseScene::rig(), ceiling.map);
  Score cold, warm, carried;
  double inView = 0;
  for (int place = 0; place < places;) {
    const View view = ceiling.look(ceiling.randomBase());
    if (each.exactly > 0 ? view.inView != each.exactly : view.inView < 3) {
      continue;
    }
    ++place;
    inView += static_cast<double>(view.inView) / places;
    cold.match(matcher, view, std::nullopt);
    warm.match(matcher, view, hintFor(ceiling, view.wMb));
    carried.match(matcher, view, hintFor(ceiling, ceiling.randomBase()));
  }
  std::cout << std::fixed << std::setprecision(1) << "| " << each.name << " | " << lamps << " | " << inView
            << " | ";
  if (each.laid) {
    std::cout << laid.repeatedTriples << " of " << laid.triples << ", " << layoutTime << " s | ";
  } else {
    std::cout << "- | ";
  }
  std::cout << cold.shares() << " | " << warm.shares() << " | " << carried.shares() << std::setprecision(3)
            << " | " << cold.times.mean() << " / " << cold.times.share95() << " | " << warm.times.mean()
            << " / " << warm.times.share95() << " |" << std::endl;
}

//! \e inView lamps and a reflection of one of them.
void reflections(const std::string &name, const vpLampMap &map, size_t inView, bool inWall)
{
  Ceiling ceiling(map, Errors(), 13);
  const vpLampMatcher matcher(reuseScene::rig(), map);
  int views = 0, refused = 0, right = 0, wrong = 0, taken = 0, noFix = 0;
  while (views < places) {
    View view = ceiling.look(ceiling.randomBase());
    if (view.observations.size() < inView) {
      continue;
    }
    view.observations.resize(inView);
    view.truth.resize(inView);
    if (!ceiling.addReflection(view, view.truth[static_cast<size_t>(views) % inView], inWall)) {
      continue;
    }
    ++views;
    const vpLampMatch match = matcher.match(view.observations, view.all());
    const bool isTaken = match.lamps.back() != vpLampMatch::noLamp;
    taken += isTaken;
    refused += !isTaken;
    const bool isWrong = reuseScene::wrong(match, view);
    wrong += isWrong;
    noFix += match.outcome != Outcome::unique;
    right += match.outcome == Outcome::unique && !isWrong;
  }
  const double percent = 100.0 / places;
  std::cout << std::fixed << std::setprecision(1) << "| " << name << " | " << inView << " | "
            << (inWall ? "in a wall" : "anywhere") << " | " << refused * percent << " | " << right * percent
            << " | " << noFix * percent << " | " << wrong << " |" << std::endl;
}
} // namespace

//! bench_reuse [PLACES]
int main(int argc, char **argv)
{
  if (argc > 1) {
    places = std::max(1, std::atoi(argv[1]));
  }
  std::cout
      << identifiers << " identifiers, " << places
      << " places; image points 0.03 to 0.1 px, survey 1 cm, lean 0.1 degrees, 1 % of lamps missing, 1 % "
         "reflections; coarse: survey 3 cm, lean 0.3 degrees, 5 % missing, 5 % reflections.\n"
         "Shares: right, %, refused, %, and the number of wrong ones. Times: milliseconds of one core, mean "
         "and 95 %.\n\n"
      << "| ceiling | lamps | in view | sets of three repeated, layout | cold start | from the last pose | "
         "carried elsewhere since | cold start, ms | from the last pose, ms |\n"
      << "|---|---|---|---|---|---|---|---|---|" << std::endl;
  Errors fine, coarse;
  fine.missing = fine.reflections = 0.01;
  coarse.missing = coarse.reflections = 0.05;
  coarse.survey = 0.03;
  coarse.tilt = 0.3 * lampScene::degree;
  const std::vector<Case> cases = {{"grid of 1.2 m", 1.2, 0, true, 0, fine},
                                   {"1.2 m, off by up to 0.2 m", 1.2, 0.2, true, 0, fine},
                                   {"grid of 2 m", 2, 0, true, 0, fine},
                                   {"2 m, off by up to 0.3 m", 2, 0.3, true, 0, fine}};
  for (size_t lamps : {100, 1000, 10000}) {
    for (const Case &each : cases) {
      coldStarts(each, lamps);
    }
  }
  coldStarts({"grid of 2 m, three in view", 2, 0, true, 3, fine}, 10000);
  coldStarts({"the same, identifiers at random", 2, 0, false, 3, fine}, 10000);
  for (size_t lamps : {100, 10000}) {
    coldStarts({"grid of 2 m, two in view", 2, 0, true, 2, fine}, lamps);
  }
  coldStarts({"grid of 1.2 m, coarse", 1.2, 0, true, 0, coarse}, 10000);
  coldStarts({"grid of 2 m, coarse", 2, 0, true, 0, coarse}, 10000);

  std::cout
      << "\n| map | lamps in view | reflection | refused, % | fix kept and right, % | no fix, % | wrong "
         "|\n|---|---|---|---|---|---|---|"
      << std::endl;
  const std::vector<Eigen::Vector3d> hall = vpLampGrid(36, 1.2, 0, 7);
  std::vector<size_t> own(hall.size());
  std::iota(own.begin(), own.end(), 0);
  const std::vector<Eigen::Vector3d> building = vpLampGrid(1000, 1.2, 0, 7);
  const vpLampMap alone = reuseScene::mapOf(hall, own);
  const vpLampMap shared = reuseScene::mapOf(building, layOver(building).identifiers);
  for (size_t inView : {3, 4, 5}) {
    for (bool inWall : {false, true}) {
      reflections("36 lamps, 36 identifiers", alone, inView, inWall);
      reflections("1000 lamps, 50 identifiers", shared, inView, inWall);
    }
  }
  return 0;
}
