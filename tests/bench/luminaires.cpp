/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Which ids the detector reads off luminaires of many emission patterns, drawn and taken off real pictures,
// and how far off their middles are: the table of tests/bench/luminaires.md.
//
// bench_luminaires [LAMPS of each family] [FAMILY|all|drawn|real] [SEED] [linear|phone|clipped] [FOLDER]
// (540 all 1 linear). Real families need VLP_INPUT_IMAGE_PATH. A phone's pictures have a tone curve of 2.2
// and are JPEGs of quality 90. Clipped ones are 1 to 4 times as bright as white. A folder gets rig, map and
// picture of each trial that is not all right.

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include <Eigen/LU>
#include <opencv2/imgcodecs.hpp>
#include <visp3/vlp_identification/vpLedDetector.h>

#include "luminaires/vpHalfRealTrial.h"
#include "vpSimulatedStripes.h"

namespace
{
const double threeSigma = 3.44; // of two coordinates: exceeded as rarely as 3 by one

//! What became of the lamps of a family.
struct Outcome {
  int lamps = 0, right = 0, wrong = 0;
  std::map<std::string, int> missing; // by remark
  std::vector<double> errors, shares; // of middles, px; of their standard deviations

  bool good() const
  {
    return right == lamps && wrong == 0 &&
           std::all_of(shares.begin(), shares.end(), [](double share) { return share < threeSigma; });
  }

  void add(const Outcome &other)
  {
    lamps += other.lamps;
    right += other.right;
    wrong += other.wrong;
    for (const auto &[remark, count] : other.missing) {
      missing[remark] += count;
    }
    errors.insert(errors.end(), other.errors.begin(), other.errors.end());
    shares.insert(shares.end(), other.shares.begin(), other.shares.end());
  }
};

//! Whether an observation is of a lamp: its middle lies on it, or it surrounds the lamp's.
bool isOf(const vpLampObservation &seen, const vpHalfRealLamp &lamp)
{
  static const double glow = 1.25; // radii of the outline
  const Eigen::Vector4d box = seen.outline.box();
  const bool around = box(0) < lamp.middle.x() && lamp.middle.x() < box(2) && box(1) < lamp.middle.y() &&
                      lamp.middle.y() < box(3);
  return around || (seen.outline.centre - lamp.middle).norm() < glow * 0.5 * lamp.diameter;
}

//! Of the observation's own standard deviation and the truth's, for two coordinates together.
double inSigmas(const vpLampObservation &seen, const vpHalfRealLamp &lamp)
{
  const Eigen::Vector2d off = seen.point - lamp.middle;
  const Eigen::Matrix2d covariance =
      seen.covariance + lamp.middleSigma() * lamp.middleSigma() * Eigen::Matrix2d::Identity();
  return std::sqrt(off.dot(covariance.inverse() * off));
}

//! The lamp that an observation is of, the nearest where it may be several; -1: none.
int lampOf(const vpLampObservation &seen, const std::vector<vpHalfRealLamp> &lamps)
{
  int nearest = -1;
  for (size_t i = 0; i < lamps.size(); ++i) {
    auto away = [&seen, &lamps](size_t lamp) { return (seen.point - lamps[lamp].middle).norm(); };
    if (isOf(seen, lamps[i]) && (nearest < 0 || away(i) < away(static_cast<size_t>(nearest)))) {
      nearest = static_cast<int>(i);
    }
  }
  return nearest;
}

//! A lamp counts once as right or missing; each id that is not its own counts as wrong.
Outcome judged(const vpHalfRealTrial &trial, const std::vector<vpLampObservation> &observations)
{
  Outcome outcome;
  const std::vector<vpHalfRealLamp> &lamps = trial.picture.lamps;
  std::vector<bool> right(lamps.size(), false);
  std::vector<std::string> remarks(lamps.size(), "no region");
  for (const vpLampObservation &seen : observations) {
    const int of = lampOf(seen, lamps);
    if (of < 0) {
      outcome.wrong += !seen.id.empty();
      continue;
    }
    const auto which = static_cast<size_t>(of);
    if (seen.id.empty()) {
      remarks[which] = seen.remark;
    } else if (seen.id != lamps[which].id) {
      ++outcome.wrong;
    } else if (!right[which]) {
      right[which] = true;
      outcome.errors.push_back((seen.point - lamps[which].middle).norm());
      outcome.shares.push_back(inSigmas(seen, lamps[which]));
    }
  }
  outcome.lamps = static_cast<int>(lamps.size());
  for (size_t i = 0; i < lamps.size(); ++i) {
    outcome.right += right[i];
    if (!right[i]) {
      ++outcome.missing[remarks[i]];
    }
  }
  return outcome;
}

//! What vlp-locate needs to show the trial, named by the family and a number.
void keep(const vpHalfRealTrial &trial, const vpImage<unsigned char> &I, const std::string &name)
{
  trial.rig.save(name + "-rig.yaml");
  trial.map.save(name + "-lamps.yaml");
  cv::imwrite(name + ".png",
              cv::Mat(static_cast<int>(I.getHeight()), static_cast<int>(I.getWidth()), CV_8U, I.bitmap));
  std::ofstream truth(name + ".csv");
  for (const vpHalfRealLamp &lamp : trial.picture.lamps) {
    truth << lamp.id << "," << lamp.middle.x() << "," << lamp.middle.y() << "," << lamp.diameter << ","
          << lamp.lines() << "," << lamp.modulation.frequency << "," << *lamp.modulation.duty << ","
          << lamp.level << "," << lamp.modulation.frequency * trial.picture.rowTime << ","
          << lamp.modulation.frequency * trial.picture.exposure << ","
          << trial.rig.shutter.exposure / trial.picture.exposure << "\n";
  }
}

Outcome tried(const vpLuminaireFamily &family, const vpHalfRealRanges &ranges, int lamps, unsigned int seed,
              const std::string &folder)
{
  Outcome all;
  std::mutex guard;
  const int perPicture = (ranges.fewest + ranges.most) / 2;
  vpRunTrials((lamps + perPicture - 1) / perPicture,
              [&](int number, std::mt19937_64 &generator) {
                vpHalfRealTrial trial = vpDrawTrial(ranges, generator);
                vpDrawLamps(ranges, family.patterns, trial, generator);
                vpLedDetector detector(trial.rig, trial.map);
                const vpImage<unsigned char> I = trial.picture.render();
                detector.detect(I);
                const Outcome outcome = judged(trial, detector.observations());
                if (!folder.empty() && !outcome.good()) {
                  keep(trial, I, folder + "/" + family.name + std::to_string(number));
                }
                const std::lock_guard<std::mutex> lock(guard);
                all.add(outcome);
              },
              seed);
  return all;
}

double percentile(std::vector<double> values, double share)
{
  if (values.empty()) {
    return std::nan("");
  }
  std::sort(values.begin(), values.end());
  return values[static_cast<size_t>(share * static_cast<double>(values.size() - 1))];
}

void print(const std::string &name, const Outcome &outcome)
{
  const auto within = std::count_if(outcome.shares.begin(), outcome.shares.end(),
                                    [](double share) { return share < threeSigma; });
  std::printf(
      "| %s | %d | %.1f %% | %d | %d | %.2f / %.2f / %.2f | %.1f %% |", name.c_str(), outcome.lamps,
      100. * outcome.right / std::max(1, outcome.lamps), outcome.wrong, outcome.lamps - outcome.right,
      percentile(outcome.errors, 0.5), percentile(outcome.errors, 0.95), percentile(outcome.errors, 1),
      100. * static_cast<double>(within) / std::max<double>(1, static_cast<double>(outcome.shares.size())));
  for (const auto &[remark, count] : outcome.missing) {
    std::printf(" %s: %d;", remark.c_str(), count);
  }
  std::printf("\n");
  std::fflush(stdout);
}
} // namespace

int main(int argc, char **argv)
{
  const int lamps = argc > 1 ? std::atoi(argv[1]) : 540;
  const std::string which = argc > 2 ? argv[2] : "all";
  const auto seed = static_cast<unsigned int>(argc > 3 ? std::atoi(argv[3]) : 1);
  const std::string pictures = argc > 4 ? argv[4] : "linear";
  vpHalfRealRanges ranges;
  if (pictures == "phone") {
    ranges.gamma = 2.2;
    ranges.jpeg = 90;
  } else if (pictures == "clipped") {
    ranges.leastLevel = 255;
    ranges.mostLevel = 4 * 255;
  }
  std::cout.setstate(std::ios::failbit); // sets tell which pictures they read
  static const int patterns = 16;        // of each drawn family
  std::vector<vpLuminaireFamily> families;
  if (which != "real") {
    families = vpDrawnFamilies(patterns, seed);
  }
  const char *root = std::getenv("VLP_INPUT_IMAGE_PATH");
  if (which != "drawn" && root != nullptr) {
    const std::vector<vpLuminaireFamily> real = vpRealFamilies(root);
    families.insert(families.end(), real.begin(), real.end());
  }
  std::printf(
      "| family | lamps | right | wrong | missing | middle off, px: median / 95 %% / max | within 3 sigma "
      "| why missing\n");
  Outcome all;
  for (const vpLuminaireFamily &family : families) {
    if (which == "all" || which == "drawn" || which == "real" || which == family.name) {
      const Outcome outcome = tried(family, ranges, lamps, seed, argc > 5 ? argv[5] : "");
      print(family.name, outcome);
      all.add(outcome);
    }
  }
  print("all", all);
  return 0;
}
