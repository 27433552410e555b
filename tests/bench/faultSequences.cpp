/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Random fault sequences of the servo loop in simulated time: what became of each, and whether a property
// broke. bench_faultSequences [SEQUENCES] [FIRST SEED]: rows of Markdown tables; exit code 1 where one broke.
// bench_faultSequences alone [DRIVES]: each fault by itself. bench_faultSequences torn [SEQUENCES]: pictures
// are lost and then torn.

#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

#include "vlp_servo/vpFaultSequence.h"

namespace
{
//! The reason without its numbers.
std::string kindOf(const vpFaultSequence &sequence)
{
  if (sequence.run.end == vpServoRun::End::arrived) {
    return "arrived";
  }
  if (sequence.run.end == vpServoRun::End::stopped) {
    return "on its way after 30 s";
  }
  std::string kind;
  for (const char c : sequence.run.reason.substr(0, sequence.run.reason.find(','))) {
    kind += c >= '0' && c <= '9' ? '#' : c;
  }
  for (const char *const twice : {"##", "#.#", "-#"}) {
    for (size_t at; (at = kind.find(twice)) != std::string::npos;) {
      kind.replace(at, std::string(twice).size(), "#");
    }
  }
  return kind;
}

void eachAlone(long drives)
{
  std::printf("| fault, from then on | drives | arrived | stood; longest after, s | most off the end of the "
              "path, mm |\n"
              "|---|---|---|---|---|\n");
  for (size_t kind = 0; kind < vpServoFault::names.size(); ++kind) {
    std::mt19937_64 random(1);
    long arrived = 0;
    double longest = 0, farthest = 0; // s, m
    for (long drive = 0; drive < drives; ++drive) {
      vpServoFault fault = vpFaultSequence::drawn(static_cast<vpServoFault::Kind>(kind), random);
      fault.from = 1 + 0.5 * fault.from; // under way
      fault.until = 1e9;
      const vpFaultSequence sequence({fault}, static_cast<std::uint64_t>(drive + 1));
      if (sequence.run.end == vpServoRun::End::arrived) {
        ++arrived;
        farthest = std::max(farthest, sequence.missedBy());
      } else {
        longest = std::max(longest, sequence.standsAfter(fault.from));
      }
    }
    std::printf("| %s | %ld | %ld | %ld; %.2f | %.0f |\n", vpServoFault::names[kind], drives, arrived,
                drives - arrived, longest, 1000 * farthest);
  }
}

//! \return Exit code.
int lostThenTorn(long sequences)
{
  std::mt19937_64 random(1);
  long arrived = 0, broken = 0;
  double farthest = 0; // m
  for (long seed = 1; seed <= sequences; ++seed) {
    const vpFaultSequence sequence(vpFaultSequence::lostThenTorn(random), static_cast<std::uint64_t>(seed));
    if (sequence.run.end == vpServoRun::End::arrived) {
      ++arrived;
      farthest = std::max(farthest, sequence.missedBy());
    }
    if (!sequence.broken.empty()) {
      ++broken;
      std::fprintf(stderr, "seed %ld: %s\n", seed, sequence.broken.c_str());
    }
  }
  std::printf("%ld sequences, %ld arrived, at most %.0f mm off the end of the path; broken: %ld\n", sequences,
              arrived, 1000 * farthest, broken);
  return broken == 0 ? 0 : 1;
}
} // namespace

int main(int argc, char **argv)
{
  if (argc > 1 && std::string(argv[1]) == "alone") {
    eachAlone(argc > 2 ? std::atol(argv[2]) : 100);
    return 0;
  }
  if (argc > 1 && std::string(argv[1]) == "torn") {
    return lostThenTorn(argc > 2 ? std::atol(argv[2]) : 1000);
  }
  const long sequences = argc > 1 ? std::atol(argv[1]) : 1000;
  const long first = argc > 2 ? std::atol(argv[2]) : 1;
  std::map<std::string, long> outcomes, broken;
  std::map<std::string, std::pair<long, long>> byFault; // sequences with it, of them arrived
  double farthest = 0;                                  // m, off the end of the path, of those that arrived
  for (long seed = first; seed < first + sequences; ++seed) {
    const vpFaultSequence sequence(static_cast<std::uint64_t>(seed));
    ++outcomes[kindOf(sequence)];
    const bool arrived = sequence.run.end == vpServoRun::End::arrived;
    for (const vpServoFault &one : sequence.faults) {
      auto &[all, ofThem] = byFault[vpServoFault::names[static_cast<size_t>(one.kind)]];
      ++all;
      ofThem += arrived;
    }
    farthest = arrived ? std::max(farthest, sequence.missedBy()) : farthest;
    if (!sequence.broken.empty()) {
      ++broken[sequence.broken];
      std::fprintf(stderr, "seed %ld: %s\n", seed, sequence.broken.c_str());
    }
  }
  std::printf("| fault | faults | of drives that arrived |\n|---|---|---|\n");
  for (const auto &[name, counts] : byFault) {
    std::printf("| %s | %ld | %ld |\n", name.c_str(), counts.first, counts.second);
  }
  std::printf("\n| outcome | drives |\n|---|---|\n");
  for (const auto &[name, count] : outcomes) {
    std::printf("| %s | %ld |\n", name.c_str(), count);
  }
  std::printf("\n%ld sequences; farthest off the end of the path where it says that it arrived: %.0f mm\n",
              sequences, 1000 * farthest);
  for (const auto &[name, count] : broken) {
    std::printf("broken: %s: %ld\n", name.c_str(), count);
  }
  return broken.empty() ? 0 : 1;
}
