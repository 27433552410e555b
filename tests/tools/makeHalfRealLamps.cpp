/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
/*!
  \file makeHalfRealLamps.cpp
  Makes a folder of pictures of lamps whose emission patterns come from real pictures, and whose modulation,
  place and size are known. vlp-locate reads it.
*/

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <opencv2/imgcodecs.hpp>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpAtomicFile.h>
#include <visp3/vlp_core/vpNumberText.h>

#include "luminaires/vpHalfRealTrial.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
namespace fs = std::filesystem;

struct Settings {
  std::string real, out, family = "lumia-floor", patterns, kind = "pwm";
  int frames = 20;
  uint64_t seed = 1;
  vpHalfRealRanges ranges;
};

void write(const cv::Mat &picture, const fs::path &file)
{
  if (!cv::imwrite(file.string(), picture)) {
    throw vpException(vpException::ioError, file.string() + ": cannot be written");
  }
}

void writeText(const fs::path &name, const std::string &text)
{
  vpAtomicFile file(name.string());
  file.stream() << text;
  file.commit();
}

//! Name of a file that may stand for a pattern: its folders joined.
std::string flat(std::string name)
{
  for (char &letter : name) {
    letter = letter == '/' ? '_' : letter;
  }
  return name;
}

std::vector<vpLuminaireFamily> families(const Settings &settings)
{
  std::vector<vpLuminaireFamily> all = vpDrawnFamilies(8, settings.seed);
  if (!settings.real.empty()) {
    const std::vector<vpLuminaireFamily> real = vpRealFamilies(settings.real);
    all.insert(all.begin(), real.begin(), real.end());
  }
  return all;
}

const vpLuminaireFamily &chosen(const std::vector<vpLuminaireFamily> &all, const std::string &name)
{
  std::string known;
  for (const vpLuminaireFamily &family : all) {
    if (family.name == name) {
      return family;
    }
    known += (known.empty() ? "" : ", ") + family.name;
  }
  throw vpException(vpException::badValue, "--family: got \"" + name + "\", expected one of: " + known +
                                               "; real ones need VLP_INPUT_IMAGE_PATH or --real");
}

std::string truthRow(const std::string &file, const vpHalfRealLamp &lamp, const vpHalfRealPicture &picture)
{
  std::string row = file + "," + lamp.id;
  for (double value : {lamp.middle.x(), lamp.middle.y(), lamp.middleSigma(), lamp.diameter, lamp.lines(),
                       lamp.modulation.repetitionFrequency() * lamp.rate, lamp.modulation.harmonic(0).real(),
                       lamp.phase, lamp.angle, lamp.tilt, lamp.level, picture.rowTime, picture.exposure}) {
    row += "," + vpNumberText(value);
  }
  return row + "," + lamp.pattern->name + "\n";
}

void makeRun(const Settings &settings)
{
  const std::vector<vpLuminaireFamily> all = families(settings);
  const vpLuminaireFamily &family = chosen(all, settings.family);
  const fs::path folder = settings.out;
  fs::create_directories(folder);
  std::mt19937_64 generator(settings.seed);
  vpHalfRealTrial trial = vpDrawTrial(settings.ranges, generator);
  trial.rig.save((folder / "rig.yaml").string());
  trial.map.save((folder / "lamps.yaml").string());
  std::string frames = "timestamp_s,file\n";
  std::string truth = "file,lamp_id,u,v,middle_sigma_px,diameter_px,lines,frequency_hz,duty,phase,angle_rad,"
                      "tilt_rad,level,row_time_s,exposure_s,pattern\n";
  for (int i = 0; i < settings.frames; ++i) {
    vpDrawLamps(settings.ranges, family.patterns, trial, generator);
    const vpImage<unsigned char> I = trial.picture.render();
    char file[32];
    std::snprintf(file, sizeof file, "frame%04d.png", i);
    write(cv::Mat(static_cast<int>(I.getHeight()), static_cast<int>(I.getWidth()), CV_8U, I.bitmap),
          folder / file);
    frames += vpNumberText(i) + "," + file + "\n";
    for (const vpHalfRealLamp &lamp : trial.picture.lamps) {
      truth += truthRow(file, lamp, trial.picture);
    }
  }
  writeText(folder / "frames.csv", frames);
  writeText(folder / "truth.csv", truth);
}

void writePatterns(const Settings &settings)
{
  for (const vpLuminaireFamily &family : families(settings)) {
    const fs::path folder = fs::path(settings.patterns) / family.name;
    fs::create_directories(folder);
    for (const vpEmissionPattern &pattern : family.patterns) {
      write(vpPatternPicture(pattern), folder / (flat(pattern.name) + ".png"));
    }
  }
}

void addOptions(CLI::App &app, Settings &settings)
{
  vpHalfRealRanges &ranges = settings.ranges;
  app.add_option("--real", settings.real, "Folder of the real sets; default: VLP_INPUT_IMAGE_PATH");
  app.add_option("--out", settings.out, "Folder for pictures, rig.yaml, lamps.yaml, frames.csv, truth.csv");
  app.add_option("--patterns", settings.patterns, "Folder for a picture of each emission pattern");
  app.add_option("--family", settings.family, "Family of luminaires")->capture_default_str();
  app.add_option("--frames", settings.frames, "Number of pictures")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  app.add_option("--seed", settings.seed, "Seed of all that is random")->capture_default_str();
  app.add_option("--kind", settings.kind, "Modulation of the lamps")
      ->check(CLI::IsMember({"pwm", "twoPulse", "word"}))
      ->capture_default_str();
  app.add_option("--gamma", ranges.gamma, "Tone curve; a phone's is about 2.2")
      ->check(CLI::Range(1., 3.))
      ->capture_default_str();
  app.add_option("--jpeg", ranges.jpeg, "JPEG quality that the pictures go through, 1 to 100; 0: none")
      ->check(CLI::Range(0, 100))
      ->capture_default_str();
}
} // namespace

int main(int argc, char **argv)
{
  Settings settings;
  CLI::App app("Pictures of lamps with real emission patterns and known truth.\n"
               "Example: makeHalfRealLamps --family lumia-floor --frames 50 --out build/half-real");
  addOptions(app, settings);
  try {
    app.parse(argc, argv);
    if (settings.out.empty() && settings.patterns.empty()) {
      throw CLI::RequiredError("--out or --patterns");
    }
  } catch (const CLI::ParseError &error) {
    const bool help = error.get_exit_code() == 0;
    app.exit(error);
    return help ? 0 : 2;
  }
  settings.ranges.kind = settings.kind == "word"       ? vpModulation::Kind::word
                         : settings.kind == "twoPulse" ? vpModulation::Kind::twoPulse
                                                       : vpModulation::Kind::pwm;
  const char *root = std::getenv("VLP_INPUT_IMAGE_PATH");
  if (settings.real.empty() && root != nullptr) {
    settings.real = root;
  }
  std::cout.setstate(std::ios::failbit); // sets tell which pictures they read
  try {
    if (!settings.patterns.empty()) {
      writePatterns(settings);
    }
    if (!settings.out.empty()) {
      makeRun(settings);
    }
  } catch (const std::exception &error) {
    std::cerr << "makeHalfRealLamps: " << error.what() << "\n";
    return 2;
  }
  return 0;
}
