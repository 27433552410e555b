/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpPlan.h"

#include <algorithm>
#include <iostream>
#include <optional>

#include <spdlog/spdlog.h>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpAtomicFile.h>
#include <visp3/vlp_evaluation/vpGnuplot.h>
#include <visp3/vlp_evaluation/vpReportTable.h>

#include "common/vpInterrupt.h"
#include "vpLampPlaces.h"
#include "vpLampTimer.h"
#include "vpPlanPicture.h"
#include "vpPlanReuse.h"
#include "vpPlanText.h"

BEGIN_VISP_NAMESPACE

namespace
{
//! The lamps as the rig will see them.
struct Seen {
  std::vector<double> lines;          // of the smallest and the largest lamp
  std::optional<vpLampPlaces> places; // where they hang, if that was said
  size_t wanted = 0;                  // identifiers; 0: all there are
  double highest = 0;                 // m above the camera
};

//! The option that says how many identifiers are wanted.
const char *countOption(const vpPlanOptions &options)
{
  return options.reuse > 0 ? "--reuse" : (options.place.empty() ? "--lamps" : "--place");
}

Seen seenBy(const vpVlpRig &rig, const vpLedIdPlanner &planner, const vpPlanOptions &options)
{
  Seen seen;
  if (options.place.empty()) {
    seen.lines = {planner.prediction.lines(options.diameter, options.highest),
                  planner.prediction.lines(options.diameter, options.lowest)};
    seen.wanted = options.lamps;
    seen.highest = options.highest;
    return seen;
  }
  seen.places = vpLampPlaces::load(options.place, options.diameter);
  const size_t lamps = seen.places->map.lamps.size();
  if (options.reuse > lamps) {
    throw vpException(vpException::badValue, "--reuse: " + std::to_string(options.reuse) +
                                                 ", expected at most the " + std::to_string(lamps) +
                                                 " lamps of " + options.place);
  }
  seen.wanted = options.reuse > 0 ? options.reuse : lamps;
  seen.lines = {planner.prediction.pictureLines(), 0};
  for (const vpLamp &lamp : seen.places->map.lamps) {
    const double own = lamp.position.z() - rig.bMc[2][3];
    const bool given = !std::isnan(options.highest);
    const double high = given ? options.highest : own, low = given ? options.lowest : own;
    if (!(low > 0)) {
      throw vpException(vpException::badValue, options.place + ": lamp " + vpShown(lamp.id) + ": " +
                                                   vpNumberText(own) +
                                                   " m above the camera, expected more than 0");
    }
    seen.highest = std::max(seen.highest, high);
    seen.lines[0] = std::min(seen.lines[0], planner.prediction.lines(lamp.size, high));
    seen.lines[1] = std::max(seen.lines[1], planner.prediction.lines(lamp.size, low));
  }
  return seen;
}

//! What there is, and what was chosen of it.
struct Choice {
  std::vector<vpModulation> signals;
  size_t capacity = 0;
  vpReportTable table;
  std::string refusal; // why there is none; empty where there is
};

std::string percent(double share)
{
  return vpFigureText(100 * share) + " %";
}

void refuseTooMany(Choice &choice, size_t wanted, const char *option)
{
  if (choice.capacity < wanted) {
    choice.refusal = std::string(option) + ": " + std::to_string(wanted) + ", expected at most the " +
                     std::to_string(choice.capacity) + " identifiers that the rig holds";
  }
}

Choice chooseFrequencies(const vpLedIdPlanner &planner, const vpPlanOptions &options, const Seen &seen)
{
  const double lines = seen.lines.front(), ppm = options.oscillatorPpm;
  vpLedIdPlan plan = planner.largest(lines, ppm);
  Choice choice;
  choice.capacity = plan.identifiers.size();
  if (choice.capacity == 0) {
    choice.refusal = "no frequency is left: from " + vpFigureText(planner.lowest(lines)) +
                     " Hz (stripes on " + vpFigureText(lines) + " lines) to " +
                     vpFigureText(planner.highest()) + " Hz";
    return choice;
  }
  refuseTooMany(choice, seen.wanted, countOption(options));
  if (seen.wanted > 0 && choice.refusal.empty()) {
    plan = planner.spread(lines, ppm, seen.wanted);
  }
  choice.signals = plan.identifiers;
  std::vector<double> duties;
  for (const vpModulation &lamp : plan.identifiers) {
    duties.push_back(*lamp.duty);
  }
  std::sort(duties.begin(), duties.end());
  duties.erase(std::unique(duties.begin(), duties.end()), duties.end());
  std::string dutyText;
  for (const double duty : duties) {
    dutyText += (dutyText.empty() ? "" : ", ") + vpNumberText(duty);
  }
  choice.table.rows = {{"frequencies to choose from, Hz",
                        vpFigureText(planner.lowest(lines)) + " to " + vpFigureText(planner.highest())},
                       {"at most, by counting stripes", std::to_string(planner.bins(lines))},
                       {"at most", std::to_string(choice.capacity)},
                       {"chosen", std::to_string(plan.identifiers.size())},
                       {"their duties", dutyText},
                       {"least distance, standard deviations", vpFigureText(plan.separation)},
                       {"probability of a wrong id, at most", vpFigureText(plan.error)},
                       {"lamps that get an id, at least", percent(plan.acceptance)}};
  return choice;
}

Choice chooseWords(const vpLedIdPlanner &planner, const vpPlanOptions &options, const Seen &seen)
{
  const vpWordPlan plan = planner.words(seen.lines.front(), options.format);
  Choice choice;
  choice.capacity = plan.words.size();
  choice.refusal = plan.refusal;
  if (!choice.refusal.empty()) {
    return choice;
  }
  if (plan.error > options.error) {
    choice.refusal = "words are wrong with a probability of " + vpFigureText(plan.error) +
                     ", expected at most " + vpFigureText(options.error) + " (--error, --chips-apart)";
  }
  refuseTooMany(choice, seen.wanted, countOption(options));
  choice.signals = plan.words;
  if (seen.wanted > 0 && choice.refusal.empty()) {
    choice.signals.resize(seen.wanted);
  }
  choice.table.rows = {
      {"words of " + std::to_string(options.format.bits) + " bits, at most", std::to_string(choice.capacity)},
      {"chosen", std::to_string(choice.signals.size())},
      {"chips in which two differ, at least", std::to_string(plan.distance)},
      {"lines for each chip", vpFigureText(plan.linesPerChip)},
      {"times that the smallest lamp shows its word", vpFigureText(plan.repetitions)},
      {"probability of a wrong word, at most", vpFigureText(plan.error)}};
  return choice;
}

//! The lamps with what was chosen.
struct Filled {
  vpLampPlaces places;
  std::optional<vpReportTable> laid; // where lamps share identifiers: how well
};

Filled fill(const vpVlpRig &rig, const vpPlanOptions &options, const Seen &seen, const Choice &choice)
{
  Filled filled;
  filled.places = seen.places ? *seen.places
                              : vpLampPlaces::grid(choice.signals.size(), options.diameter,
                                                   rig.bMc[2][3] + options.highest);
  std::vector<vpLamp> &lamps = filled.places.map.lamps;
  for (vpLamp &lamp : lamps) {
    lamp.oscillatorPpm = options.oscillatorPpm;
  }
  if (options.reuse > 0) {
    const bool given = !std::isnan(options.viewRadius);
    const double radius = given ? options.viewRadius : vpViewRadius(rig, seen.highest);
    filled.laid = vpLayOver(filled.places.map, choice.signals, radius);
    return filled;
  }
  for (size_t i = 0; i < lamps.size(); ++i) {
    lamps[i].modulation = choice.signals[i];
  }
  return filled;
}

void print(const Seen &seen, vpReportTable table)
{
  table.heading = "Identifiers";
  table.columns = {"", ""};
  const std::string smallest = vpFigureText(seen.lines.front()), largest = vpFigureText(seen.lines.back());
  table.rows.insert(table.rows.begin(),
                    {"lines of the smallest lamp, and of the largest", smallest + ", " + largest});
  table.note = "Planned for the smallest lamp; larger ones are told apart better.";
  std::cout << table.text();
}
} // namespace

vpExitCode vpPlan(const vpPlanOptions &options)
{
  if (!options.check.empty()) {
    return vpPlanCheck(options);
  }
  const vpVlpRig rig = vpVlpRig::load(options.rig);
  vpLedIdPlanner planner = options.planner(rig);
  const Seen seen = seenBy(rig, planner, options);
  vpLampTimer timer;
  unsigned int prescaler = 1;
  if (!options.timers.empty()) {
    timer = vpLampTimer::named(options.timers);
    timer.clock = options.clock > 0 ? options.clock : timer.clock;
    prescaler =
        timer.prescalerFor(options.words ? options.format.chipRate : planner.lowest(seen.lines.front()));
    planner.clock = timer.clock / prescaler;
  }
  const Choice choice =
      options.words ? chooseWords(planner, options, seen) : chooseFrequencies(planner, options, seen);
  if (!choice.refusal.empty()) {
    spdlog::error(choice.refusal);
    return vpExitCode::nothingFound;
  }
  if (!options.picture.empty()) {
    vpGnuplot::check();
    vpInterrupt::install();             // from here on there is something to take away
    vpAtomicFile file(options.picture); // tells before the work whether it can be written
    const std::string bytes = vpPlanPicture(options, planner, seen.lines, choice.capacity);
    file.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.commit();
  }
  if (!options.out.empty()) {
    const vpAtomicFile probe(options.out); // gone again: only tells whether it can be written
  }
  const Filled filled = fill(rig, options, seen, choice);
  if (!options.out.empty()) {
    filled.places.map.save(options.out, filled.places.comment);
  }
  print(seen, choice.table);
  if (filled.laid) {
    std::cout << "\n" << filled.laid->text();
  }
  if (!options.timers.empty()) {
    std::cout << "\n" << timer.registers(filled.places.map, prescaler).text();
  }
  return vpExitCode::done;
}

END_VISP_NAMESPACE
