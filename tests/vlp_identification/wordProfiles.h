/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef wordProfiles_h
#define wordProfiles_h

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include <visp3/vlp_identification/vpStripeAnalyzer.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

//! A lamp that sends a word, as a rolling shutter of 43.1 us a line sees it: lit instants counted, nothing
//! shared with the code under test.
struct SentWord {
  static constexpr double rowTime = 43.1e-6;

  std::string chips;
  double chipRate = 8000;    // Hz
  int lines = 146;           // delivered
  double step = 1;           // sensor lines from one delivered line to the next: line k is floor(k step)
  double exposure = rowTime; // s
  double statedExposure = 0; // s; 0: as it is
  double amplitude = 150;    // grey levels
  double decibel = 20;       // amplitude over the noise of one line
  double rim = 1;            // by which the light is dimmer at the first and last line
  double saturation = 1;     // share of the amplitude at which the light is cut off
  bool reversed = false;     // last line first
  bool quantised = false;    // light in whole grey levels

  vpStripeProfile profile(std::mt19937 &random) const
  {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    const double noise = amplitude * std::pow(10, -decibel / 20);
    const double start = uniform(random) * static_cast<double>(chips.size()), shift = uniform(random);
    vpStripeProfile profile;
    profile.exposure = statedExposure > 0 ? statedExposure : exposure;
    for (int k = 0; k < lines; ++k) {
      const double sensorLine = std::floor(k * step + shift);
      const double time = rowTime * (reversed ? step * lines - sensorLine : sensorLine);
      const double y = 2.0 * k / (lines - 1) - 1;
      const double envelope = amplitude * (1 - (1 - 1 / rim) * y * y);
      const double light = envelope * std::min(saturation, litShare(time, start)) + noise * normal(random);
      profile.time.push_back(time);
      profile.light.push_back(quantised ? std::round(light) : light);
      profile.sigma.push_back(std::max(noise, 0.3));
    }
    return profile;
  }

  //! Of all rotations the greatest.
  std::string canonical() const
  {
    std::string word = chips, greatest = chips;
    for (size_t k = 0; k < chips.size(); ++k) {
      word = word.substr(1) + word[0];
      greatest = std::max(greatest, word);
    }
    return greatest;
  }

  vpWordFormat format(double tolerance = 1e-4) const { return {chips.size(), chipRate, tolerance}; }

private:
  double litShare(double middle, double start) const
  {
    static const int instants = 400;
    int lit = 0;
    for (int i = 0; i < instants; ++i) {
      const double t = middle + exposure * ((i + 0.5) / instants - 0.5);
      const auto chip = static_cast<long>(std::floor(t * chipRate + start));
      const auto n = static_cast<long>(chips.size());
      lit += chips[static_cast<size_t>((chip % n + n) % n)] == '1' ? 1 : 0;
    }
    return static_cast<double>(lit) / instants;
  }
};

//! Preamble 011110 and eight bits of identifier, Manchester-coded: 1 is lit-dark.
inline std::string manchester(unsigned int id)
{
  std::string chips;
  auto bit = [&chips](bool one) { chips += one ? "10" : "01"; };
  for (char c : std::string("011110")) {
    bit(c == '1');
  }
  for (int k = 7; k >= 0; --k) {
    bit((id >> k & 1) != 0);
  }
  return chips;
}

//! Header 01010 and \e bits bits, a chip each.
inline std::string onOff(unsigned int id, int bits)
{
  std::string chips = "01010";
  for (int k = bits - 1; k >= 0; --k) {
    chips += (id >> k & 1) != 0 ? '1' : '0';
  }
  return chips;
}

//! Whether a word is the one sent, or the one that it says several times over: no light tells the two apart.
inline bool sameSignal(const std::string &seen, const std::string &sent)
{
  std::string repeated = seen;
  while (repeated.size() < sent.size()) {
    repeated += seen;
  }
  return repeated == sent;
}

//! How often words were read right, wrong, not at all.
struct WordScore {
  int right = 0, wrong = 0, refused = 0, notCoded = 0;
  double worstFrequency = 0; // sigmas
  double frequencySquares = 0;

  void add(const SentWord &sent, const vpStripeFeatures &seen)
  {
    notCoded += seen.signal == vpStripeFeatures::Signal::coded ? 0 : 1;
    if (seen.chips.empty()) {
      ++refused;
    } else if (sameSignal(seen.chips, sent.canonical())) {
      ++right;
      const double rate = seen.frequency * static_cast<double>(seen.chips.size());
      const double z = (rate / sent.chipRate - 1) * seen.frequency / seen.frequencySigma;
      worstFrequency = std::max(worstFrequency, std::abs(z));
      frequencySquares += z * z;
    } else {
      ++wrong;
    }
  }
  int trials() const { return right + wrong + refused; }
  double rightShare() const { return static_cast<double>(right) / trials(); }
  void print(const std::string &what) const
  {
    std::cout << std::left << std::setw(52) << what << std::right << "right " << std::setw(5) << right
              << "  wrong " << std::setw(3) << wrong << "  refused " << std::setw(5) << refused
              << "  not coded " << std::setw(3) << notCoded << "  frequency off by "
              << std::sqrt(frequencySquares / std::max(right, 1)) << " sigma rms, " << worstFrequency
              << " at most\n";
  }
};

#endif
