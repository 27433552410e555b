/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// What odometry makes of the poses, right and wrong, beside the same frames without it: the lamps' middles
// are simulated, no picture is (vpSeenLamps). bench_sources [SEEDS] (8)

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include <Eigen/LU>

#include "common/vpSeenLamps.h"
#include "vpSimulatedStripes.h"

namespace
{
const double framesPerSecond = 12;
const double offFrom = 1; // s, from when on a source is off, or only one lamp is left

struct Drive {
  std::string name;
  std::vector<vpPlannedLeg> legs;
  vpPlannedPlace start;
};

const std::vector<Drive> drives = {
    {"straight", {{0.5, 0, 0}, {4, 0.2, 0}, {0.5, 0, 0}}, {-0.4, 0.05, 0}},
    {"curve", {{0.5, 0, 0}, {4, 0.15, 0.6}, {0.5, 0, 0}}, {-0.2, -0.3, 0}},
    {"square",
     {{0.3, 0, 0}, {1.5, 0.2, 0}, {1.57, 0, 1}, {1.5, 0.2, 0}, {1.57, 0, 1}, {1.5, 0.2, 0}, {0.3, 0, 0}},
     {-0.15, -0.15, 0}},
    {"spin", {{0.5, 0, 0}, {4, 0, 1}, {0.5, 0, 0}}, {0.05, 0.05, 0}},
};

//! What is wrong with the wheels.
struct Fault {
  std::string name;
  double heading = 0; // rad, that the way has in the base's frame
  std::function<void(std::vector<vpOdometry> &)> apply = [](std::vector<vpOdometry> &) {};
  double noise = 0; // white, of each sample, as a share of it; 0: that of encoder ticks
};

Fault scaled(double by)
{
  return {"scaled by " + std::to_string(by).substr(0, 3), 0, [by](std::vector<vpOdometry> &samples) {
            for (vpOdometry &sample : samples) {
              sample.v *= by;
              sample.w *= by;
            }
          }};
}

std::vector<Fault> faults()
{
  std::vector<Fault> all{{"right"}, scaled(0.8), scaled(1.2), {"turned by 5 degrees", 5 * M_PI / 180}};
  all.push_back({"late by 0.2 s", 0, [](std::vector<vpOdometry> &samples) {
                   for (vpOdometry &sample : samples) {
                     sample.timestamp += 0.2;
                   }
                 }});
  all.push_back({"frozen from 1 s on", 0, [](std::vector<vpOdometry> &samples) {
                   const vpOdometry *last = nullptr;
                   for (vpOdometry &sample : samples) {
                     if (sample.timestamp < offFrom) {
                       last = &sample;
                     } else if (last != nullptr) {
                       sample.v = last->v;
                       sample.w = last->w;
                     }
                   }
                 }});
  all.push_back({"sign turned", 0, [](std::vector<vpOdometry> &samples) {
                   for (vpOdometry &sample : samples) {
                     sample.v = -sample.v;
                     sample.w = -sample.w;
                   }
                 }});
  all.push_back({"a wheel slips from 2 to 4 s", 0, [](std::vector<vpOdometry> &samples) {
                   static const double faster = 0.1, track = 0.16; // m/s, m: it turns without a grip
                   for (vpOdometry &sample : samples) {
                     if (sample.timestamp > 2 && sample.timestamp < 4) {
                       sample.v += 0.5 * faster;
                       sample.w += faster / track;
                     }
                   }
                 }});
  all.push_back({"gyro bias of 5 degrees/s", 0, [](std::vector<vpOdometry> &samples) {
                   for (vpOdometry &sample : samples) {
                     sample.w += 5 * M_PI / 180;
                   }
                 }});
  return all;
}

//! Of one run.
struct Errors {
  double sum = 0, nees = 0; // m, horizontal; of x and y
  int frames = 0, fixes = 0;

  void add(const Errors &other)
  {
    sum += other.sum;
    nees += other.nees;
    frames += other.frames;
    fixes += other.fixes;
  }
  double mean() const { return 1000 * sum / fixes; }
};

Errors run(const Drive &drive, const Fault &fault, size_t lamps, double proud, bool odometry,
           std::mt19937_64 generator)
{
  vpSeenLamps world(std::max<size_t>(2, lamps));
  if (proud > 0) {
    world.claim(proud, generator);
  }
  const vpPlannedDrive path(drive.start, drive.legs, fault.heading);
  std::vector<vpOdometry> samples = path.odometry(0.02);
  std::normal_distribution<double> normal;
  for (vpOdometry &sample : samples) {
    sample.v += (fault.noise > 0 ? fault.noise * sample.v : 0.002) * normal(generator); // m/s
    sample.w += (fault.noise > 0 ? fault.noise * sample.w : 0.003) * normal(generator); // rad/s
  }
  fault.apply(samples);
  vpVlpLocalizer localizer(world.rig, world.map);
  Errors errors;
  size_t given = 0;
  for (double t = 0; t < path.duration(); t += 1 / framesPerSecond) {
    static const double read = 0.08; // s after the time stamp: by then the frame is there
    for (; odometry && given < samples.size() && samples[given].timestamp <= t + read; ++given) {
      localizer.filter.addOdometry(samples[given]);
    }
    const std::vector<bool> lit{true, lamps > 1 || t < offFrom};
    const auto place = [&path](double at) { return path.at(at); };
    const vpVlpLocation location = localizer.locate(t, world.see(t, place, generator, lit));
    if (t < offFrom) {
      continue;
    }
    ++errors.frames;
    if (!location.fix.valid) {
      continue;
    }
    const vpPlannedPlace truth = path.at(t);
    const Eigen::Vector2d off(location.fix.wMb[0][3] - truth.x, location.fix.wMb[1][3] - truth.y);
    ++errors.fixes;
    errors.sum += off.norm();
    errors.nees += off.dot(location.fix.covariance.topLeftCorner<2, 2>().inverse() * off);
  }
  return errors;
}

Errors runs(const Drive &drive, const Fault &fault, size_t lamps, double proud, bool odometry, int seeds)
{
  std::vector<Errors> all(static_cast<size_t>(seeds));
  vpRunTrials(seeds, [&](int seed, std::mt19937_64 &generator) {
    all[static_cast<size_t>(seed)] = run(drive, fault, lamps, proud, odometry, generator);
  });
  Errors sum;
  for (const Errors &errors : all) {
    sum.add(errors);
  }
  return sum;
}

//! m, of the first frame of all, of a robot that drives already.
double firstError(size_t lamps, bool odometry, std::mt19937_64 generator)
{
  const vpSeenLamps world(lamps);
  const vpPlannedDrive path({-0.3, 0.05, 0}, {{3, 0.2, 0}});
  vpVlpLocalizer localizer(world.rig, world.map);
  static const double begins = 1, read = 0.08; // s; after the time stamp: by then the frame is there
  for (const vpOdometry &sample : path.odometry(0.02)) {
    if (odometry && sample.timestamp <= begins + read) {
      localizer.filter.addOdometry(sample);
    }
  }
  const auto place = [&path](double at) { return path.at(at); };
  return vpErrorOf(localizer.locate(begins, world.see(begins, place, generator)).fix, path.at(begins));
}

//! A camera that is turned, noise, and the first frame.
void others(int seeds)
{
  std::printf(
      "Exact rig and map, mean horizontal error:\n\n| drive and odometry | lamps | with odometry, mm | "
      "without, mm | ratio |\n|---|---|---|---|---|\n");
  const auto row = [](const char *name, size_t lamps, double with, double without) {
    std::printf("| %s | %zu | %.3f | %.3f | %.2f |\n", name, lamps, with, without, with / without);
  };
  const Drive circle{"circle", {{0.5, 0, 0}, {10.5, 0.15, 0.6}, {0.5, 0, 0}}, {0, -0.25, 0}};
  Fault noisy{"1 % of white noise a sample"};
  noisy.noise = 0.01;
  const Fault turned{"turned by 2.9 degrees", 2.9 * M_PI / 180};
  for (const size_t lamps : {2, 4}) {
    row("straight, 0.2 m/s, camera turned by 2.9 degrees", lamps,
        runs(drives.front(), turned, lamps, 0, true, seeds).mean(),
        runs(drives.front(), turned, lamps, 0, false, seeds).mean());
    row("circle, 1 % of white noise a sample", lamps, runs(circle, noisy, lamps, 0, true, seeds).mean(),
        runs(circle, noisy, lamps, 0, false, seeds).mean());
    double with = 0, without = 0; // mm
    std::mutex mutex;
    vpRunTrials(seeds, [&](int, std::mt19937_64 &generator) {
      const double one = firstError(lamps, true, generator), other = firstError(lamps, false, generator);
      const std::lock_guard<std::mutex> lock(mutex);
      with += 1000 * one / seeds;
      without += 1000 * other / seeds;
    });
    row("first frame at 0.2 m/s", lamps, with, without);
  }
  std::printf("\n");
}

/*!
  Two lamps are in view; from a second on two others with their frequencies shine 36 cm beside them, and they
  are dark.
*/
void copies(int seeds)
{
  std::printf("Two lamps give way to two others with their frequencies, 36 cm beside:\n\n| odometry | frames "
              "with a pose "
              "that is 5 cm off or more, neither ambiguous nor relocated, %% | ambiguous or relocated, %% | "
              "largest error of "
              "others, mm |\n|---|---|---|---|\n");
  for (const bool odometry : {false, true}) {
    int frames = 0, wrong = 0, told = 0;
    double largest = 0; // m
    std::mutex mutex;
    vpRunTrials(seeds, [&](int, std::mt19937_64 &generator) {
      vpSeenLamps world(2), copy(2);
      for (size_t k = 0; k < 2; ++k) {
        copy.hung(k).y() += 0.36;
      }
      const vpPlannedDrive path({-0.4, 0.05, 0}, {{5, 0.2, 0}});
      const std::vector<vpOdometry> samples = path.odometry(0.02);
      vpVlpLocalizer localizer(world.rig, world.map);
      size_t given = 0;
      for (double t = 0; t < path.duration() - 1; t += 1 / framesPerSecond) {
        static const double read = 0.08; // s after the time stamp: by then the frame is there
        for (; odometry && given < samples.size() && samples[given].timestamp <= t + read; ++given) {
          localizer.filter.addOdometry(samples[given]);
        }
        const auto place = [&path](double at) { return path.at(at); };
        const vpVlpLocation location =
            localizer.locate(t, (t < offFrom ? world : copy).see(t, place, generator));
        const vpPlannedPlace truth = path.at(t);
        const double error = vpErrorOf(location.fix, truth);
        const std::lock_guard<std::mutex> lock(mutex);
        if (t < offFrom || !location.fix.valid) {
          continue;
        }
        static const double far = 0.05; // m
        const bool unsure = location.fix.ambiguous || location.relocated;
        ++frames;
        told += unsure;
        wrong += !unsure && error > far;
        largest = unsure ? largest : std::max(largest, error);
      }
    });
    std::printf("| %s | %.1f | %.1f | %.1f |\n", odometry ? "right" : "none", 100. * wrong / frames,
                100. * told / frames, 1000 * largest);
  }
  std::printf("\n");
}
} // namespace

int main(int argc, char **argv)
{
  const int seeds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 8;
  std::printf(
      "Mean horizontal error, mm, without odometry -> with it; mean NEES of x and y with it (2 is right); "
      "frames with a pose, %%, with it where not all.\n\n");
  for (const double proud : {0., 1., 2., 5.}) {
    std::printf("Errors of rig and map: %g times what they state%s\n\n", proud,
                proud == 0 ? ", which is exact" : "");
    std::printf(
        "| drive | odometry | four lamps | two lamps | one lamp from 1 s on |\n|---|---|---|---|---|\n");
    int worse = 0, cells = 0;
    for (const Drive &drive : drives) {
      for (const Fault &fault : faults()) {
        std::printf("| %s | %s |", drive.name.c_str(), fault.name.c_str());
        for (const size_t lamps : {4, 2, 1}) {
          const Errors without = runs(drive, fault, lamps, proud, false, seeds),
                       with = runs(drive, fault, lamps, proud, true, seeds);
          const bool bad = lamps > 1 && (with.mean() > 1.5 * without.mean() || with.fixes < without.fixes);
          cells += lamps > 1;
          worse += bad;
          std::printf(" %s%.3f -> %.3f%s; %.1f", bad ? "**" : "", without.mean(), with.mean(),
                      bad ? "**" : "", with.nees / with.fixes);
          if (with.fixes < with.frames) {
            std::printf("; %.0f %%", 100. * with.fixes / with.frames);
          }
          std::printf(" |");
        }
        std::printf("\n");
        std::fflush(stdout);
      }
    }
    std::printf("\nWorse than 1.5 times the error without odometry: %d of %d with two lamps or more.\n\n",
                worse, cells);
  }
  others(seeds);
  copies(seeds);
  return 0;
}
