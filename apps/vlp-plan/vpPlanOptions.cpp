/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpPlanOptions.h"

#include <filesystem>
#include <map>
#include <set>

#include <CLI/CLI.hpp>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

#include "common/vpCommandLine.h"
#include "common/vpProgram.h"
#include "vpLampTimer.h"

BEGIN_VISP_NAMESPACE

namespace
{
const char *const description = "Plans how lamps blink so that a rig tells them apart: frequencies and "
                                "duties, or words; how many of them\n"
                                "there can be; and which lamps of a map may be taken for each other.\n";

const char *const footer = R"(
Examples:
  how many identifiers are there, and how does that change with the lamps' size in the picture?
    vlp-plan --rig rig.yaml --heights 1.2:2.5 --diameter 0.175 --picture capacity.png
  a map of 50 lamps whose ids are as far apart as can be, then put where they hang
    vlp-plan --rig rig.yaml --heights 1.2:2.5 --diameter 0.175 --lamps 50 --out lamps.yaml
  the same for lamps whose places are known, with cheap RC clocks and a low error
    vlp-plan --rig rig.yaml --place surveyed.yaml --oscillator rc --error 1e-5 --out lamps.yaml
  a hall of many lamps with 20 identifiers, laid so that three lamps in view say where the robot is
    vlp-plan --rig rig.yaml --place surveyed.csv --diameter 0.175 --reuse 20 --out lamps.yaml
  lamps that an Arduino drives, whose ceramic resonator is off by 5000 ppm
    vlp-plan --rig rig.yaml --heights 1.2:2.5 --diameter 0.175 --lamps 8 --clock 16e6 --oscillator resonator
  lamps that timers of an STM32 drive, and what to write into their registers
    vlp-plan --rig rig.yaml --heights 1.2:2.5 --diameter 0.175 --lamps 8 --timers stm32 --out lamps.yaml
  words of 14 bits instead of one frequency each
    vlp-plan --rig rig.yaml --heights 1.2:1.5 --diameter 0.175 --words --chip-rate 8000 --out lamps.yaml
  which lamps of a map are the easiest to confuse?
    vlp-plan --rig rig.yaml --check lamps.yaml --worst 20

Heights are those of the lamps above the camera, not above the floor: a lamp that is farther away has fewer lines
in the picture, so the farthest decides. A place is a lamp map (positions, ids, sizes are kept, all lamps get an
identifier) or a CSV with the header id,x_m,y_m,z_m. Without one, lamps hang on a grid that says it is a placeholder.
Reuse: vpIdentifierLayout gives the lamps of one view different identifiers, and sets of three that look like no
other set, as far as so few identifiers suffice: its table says what is left. A view is what the whole picture
shows of the ceiling at the greatest height (--heights, or the highest lamp of the place): its radius is that of
the smallest circle around the rays through the picture's corners.
A distance is in standard deviations of what is measured, half of it each way; 6.6 are an error of 1 in 1000.
SNR: 20 log10 of half the swing of a lamp's stripes over the noise of one line's mean, without any blur.
vpLedIdPlanner and vpStripePrediction explain the formulas; tutorial/plan goes through an example.

Exit code: 0 done; 2 bad usage or bad input; 3 the rig holds no identifiers like these, or not so many.
)";

//! The numbers between separators, or nothing where one is none.
std::vector<double> numbersOf(const std::string &text, char separator)
{
  std::vector<double> numbers;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(separator, begin), text.size());
    double number = 0;
    if (!vpParseNumber(text.substr(begin, end - begin), number) || !std::isfinite(number)) {
      return {};
    }
    numbers.push_back(number);
    begin = end + 1;
  }
  return numbers;
}

//! FROM:TO, or one number for both.
void readRange(const std::string &option, const std::string &text, const char *unit, double &low,
               double &high)
{
  const std::vector<double> ends = numbersOf(text, ':');
  if (ends.empty() || ends.size() > 2 || !(ends.front() > 0) || ends.back() < ends.front()) {
    vpBadInput(option + ": " + vpShown(text) + ", expected FROM:TO or one number (" + unit +
               "), above 0 and FROM not above TO");
  }
  low = ends.front();
  high = ends.back();
}

double oscillatorOf(const std::string &text)
{
  double ppm = 0;
  static const std::map<std::string, double> kinds = {{"crystal", 50}, {"resonator", 5000}, {"rc", 10000}};
  if (const auto kind = kinds.find(text); kind != kinds.end()) {
    return kind->second;
  }
  if (!vpParseNumber(text, ppm) || !std::isfinite(ppm) || ppm < 0) {
    vpBadInput(
        "--oscillator: " + vpShown(text) +
        ", expected crystal (50 ppm), resonator (5000 ppm), rc (10000 ppm) or a number of ppm from 0 up");
  }
  return ppm;
}

std::vector<double> dutiesOf(const std::string &text)
{
  std::vector<double> duties = numbersOf(text, ',');
  bool good = !duties.empty() && duties.size() <= 8 &&
              std::set<double>(duties.begin(), duties.end()).size() == duties.size();
  for (const double duty : duties) {
    good = good && duty > 0 && duty < 1;
  }
  if (!good) {
    vpBadInput("--duties: " + vpShown(text) +
               ", expected up to 8 different numbers between 0 and 1, as 0.2,0.5,0.8");
  }
  return duties;
}

//! A number that a text holds, within bounds (excluded); the value stays where the text is empty.
void readNumber(const std::string &option, const std::string &text, double low, double high,
                const char *expected, double &value)
{
  if (!text.empty() && (!vpParseNumber(text, value) || !(value > low && value < high))) {
    vpBadInput(option + ": " + vpShown(text) + ", expected " + expected);
  }
}
} // namespace

bool vpPlanOptions::parse(int argc, char **argv)
{
  CLI::App app(description, "vlp-plan");
  app.footer(footer);
  app.get_formatter()->column_width(28);
  std::string heights, size, oscillator = "crystal", wrong, snr, dutyList, frequencies, chipRate, view,
                             clockText, code = "manchester";
  size_t bits = format.bits, apart = format.minDistance;
  vpAddInput(app, "--rig", rig, "FILE", "the camera on the robot");
  vpAddName(app, "--heights", heights, "FROM:TO", "m, how far above the camera the lamps will hang");
  vpAddName(app, "--diameter", size, "M",
            "of the lamps, or side of square ones; of those without one in a map");
  vpAddName(app, "--oscillator", oscillator, "crystal|resonator|rc|PPM",
            "standard deviation of the lamps' clocks: 50 ppm (default), 5000, 10000, or as said");
  vpAddName(app, "--clock", clockText, "HZ",
            "of the lamps' timers, as 16e6: only what whole cycles of it make; default: any frequency");
  vpAddChoice(app, "--timers", timers, vpLampTimer::names(),
              "print the registers of such timers for each lamp, and plan what they make; --clock: theirs");
  vpAddCount(app, "--lamps", lamps,
             "how many identifiers to choose, as far apart as can be; default: all there are");
  vpAddName(app, "--error", wrong, "P", "probability of taking a lamp for another one; default 0.001");
  vpAddName(app, "--snr-db", snr, "DB", "stripes against the noise of a line; default 20, which is careful");
  vpAddName(app, "--duties", dutyList, "D,D,...", "that lamps may have; default 0.2,0.5,0.8");
  vpAddName(app, "--frequencies", frequencies, "FROM:TO",
            "Hz; default: from 3 stripes or 500 Hz to where exposure or rate of lines end it");
  vpAddName(app, "--place", place, "FILE", "where the lamps hang: a lamp map, or a CSV of positions");
  vpAddCount(app, "--reuse", reuse,
             "identifiers for all lamps of --place, each on many of them; default: each lamp its own");
  vpAddName(app, "--view-radius", view, "M",
            "of what a picture shows of the ceiling, for --reuse; default: as the rig and the heights say");
  vpAddName(app, "--out", out, "FILE", "write the lamp map");
  vpAddName(app, "--picture", picture, "FILE.png",
            "draw how many identifiers there are for lamps of any size");
  CLI::Option *const asWords = app.add_flag("--words", words, "plan words instead of frequencies");
  const std::vector<CLI::Option *> ofWords = {
      vpAddCount(app, "--bits", bits, "of a word, header included; default 14"),
      app.add_option("--header", format.header, "bits that a word begins with; default 011110")
          ->type_name("BITS"),
      app.add_option("--chip-rate", chipRate, "Hz; default 8000")->type_name("HZ"),
      vpAddCount(app, "--chips-apart", apart,
                 "in which two words differ at least, however turned; default 2")};
  vpAddChoice(app, "--code", code, {"manchester", "ook"}, "of the words; default manchester");
  vpAddName(app, "--check", check, "FILE", "judge this lamp map: the pairs most likely to be confused");
  vpAddCount(app, "--worst", worst, "how many pairs of --check to print; default 10");
  for (CLI::Option *const option : ofWords) {
    option->needs(asWords);
  }
  if (!vpParseCommandLine(app, argc, argv)) {
    return false;
  }
  if (!heights.empty()) {
    readRange("--heights", heights, "m", lowest, highest);
  }
  if (!frequencies.empty()) {
    readRange("--frequencies", frequencies, "Hz", lowestFrequency, highestFrequency);
  }
  readNumber("--diameter", size, 0, INFINITY, "a number of metres above 0", diameter);
  readNumber("--error", wrong, 0, 0.5, "a probability above 0 and below 0.5", error);
  readNumber("--snr-db", snr, -100, 200, "a number of dB, as 20", snrDb);
  readNumber("--clock", clockText, 1e4, 1e10, "a number of Hz from 10 kHz to 10 GHz", clock);
  readNumber("--view-radius", view, 0, INFINITY, "a number of metres above 0", viewRadius);
  readNumber("--chip-rate", chipRate, 0, INFINITY, "a number of Hz above 0", format.chipRate);
  oscillatorPpm = oscillatorOf(oscillator);
  duties = dutyList.empty() ? duties : dutiesOf(dutyList);
  format.bits = static_cast<unsigned int>(bits);
  format.minDistance = static_cast<unsigned int>(apart);
  format.code = code == "ook" ? vpModulation::Code::ook : vpModulation::Code::manchester;
  checkTogether(code == "ook");
  return true;
}

void vpPlanOptions::checkTogether(bool ook) const
{
  if (rig.empty()) {
    vpBadInput("--rig: nothing, expected the file of the camera on the robot (--help explains the options)");
  }
  if (ook && !words) {
    vpBadInput("--code: ook without --words, expected only with it");
  }
  if (!check.empty()) {
    if (!out.empty() || !picture.empty() || !place.empty() || lamps > 0 || reuse > 0 || words || clock > 0 ||
        !timers.empty()) {
      vpBadInput("--check: with --out, --picture, --place, --lamps, --reuse, --words, --clock or --timers, "
                 "expected none of these: it "
                 "plans nothing");
    }
    return;
  }
  if (place.empty() && std::isnan(highest)) {
    vpBadInput("--heights: nothing, expected how far above the camera the lamps will hang (m), or --place");
  }
  if (place.empty() && std::isnan(diameter)) {
    vpBadInput("--diameter: nothing, expected the diameter of the lamps (m)");
  }
  if (!place.empty() && lamps > 0) {
    vpBadInput("--lamps: with --place, expected one of them: a place says how many lamps there are");
  }
  if (reuse > 0 && place.empty()) {
    vpBadInput(
        "--reuse: without --place, expected only with it: where lamps hang decides which are told apart");
  }
  if (reuse == 1) {
    vpBadInput("--reuse: 1, expected 2 or more");
  }
  if (reuse == 0 && !std::isnan(viewRadius)) {
    vpBadInput("--view-radius: without --reuse, expected only with it");
  }
  if (!picture.empty() && std::filesystem::path(picture).extension() != ".png") {
    vpBadInput("--picture: " + vpShown(picture) + ", expected a name that ends in .png");
  }
  for (const std::string &input : {rig, place}) {
    std::error_code ignored;
    for (const std::string &output : {out, picture}) {
      if (!input.empty() && !output.empty() && std::filesystem::equivalent(input, output, ignored)) {
        vpBadInput((output == out ? "--out: " : "--picture: ") + vpShown(output) +
                   ", which is an input, expected another file");
      }
    }
  }
}

vpLedIdPlanner vpPlanOptions::planner(const vpVlpRig &camera) const
{
  vpLedIdPlanner planner(camera);
  planner.prediction.snrDb = snrDb;
  planner.maxError = error;
  planner.duties = duties;
  planner.clock = clock;
  planner.lowestFrequency = lowestFrequency;
  planner.highestFrequency = highestFrequency;
  return planner;
}

END_VISP_NAMESPACE
