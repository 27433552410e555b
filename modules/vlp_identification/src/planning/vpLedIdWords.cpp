/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// The words of vpLedIdPlanner.

#include <visp3/vlp_identification/vpLedIdPlanner.h>

#include <algorithm>
#include <cmath>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

#include "recognition/vpNormalTail.h"
#include "words/vpWordCode.h"

BEGIN_VISP_NAMESPACE

namespace
{
constexpr unsigned int mostOwnBits = 12; // 4096 words, each held against all others

[[noreturn]] void fail(const std::string &problem)
{
  throw vpException(vpException::badValue, "words: " + problem);
}

void check(const vpWordScheme &format)
{
  const size_t head = format.header.size();
  if (head == 0 || format.header.find_first_not_of("01") != std::string::npos) {
    fail("header: \"" + vpShown(format.header) + "\", expected one or more of 0 and 1");
  }
  if (!(std::isfinite(format.chipRate) && format.chipRate > 0)) {
    fail("chip rate: " + vpNumberText(format.chipRate) + ", expected a number of Hz above 0");
  }
  const size_t most = vpWordCode::mostChips / (format.code == vpModulation::Code::manchester ? 2 : 1);
  if (format.bits <= head || format.bits > std::min(head + mostOwnBits, most)) {
    fail("bits: " + std::to_string(format.bits) + ", expected " + std::to_string(head + 1) + " to " +
         std::to_string(std::min(head + mostOwnBits, most)) + " with this header and code");
  }
}

vpModulation wordOf(const vpWordScheme &format, const std::string &bits)
{
  vpModulation word;
  word.kind = vpModulation::Kind::word;
  word.bits = bits;
  word.chipRate = format.chipRate;
  word.code = format.code;
  return word;
}

//! The bits of \e value, the highest first.
std::string bitsOf(unsigned int value, unsigned int count)
{
  std::string bits;
  for (unsigned int i = count; i-- > 0;) {
    bits += (value >> i & 1) == 1 ? '1' : '0';
  }
  return bits;
}

//! The greedy choice: each word in turn that is far enough from all before.
void choose(const vpWordScheme &format, vpWordPlan &plan, std::vector<vpWordCode> &codes)
{
  const auto own = static_cast<unsigned int>(format.bits - format.header.size());
  const vpWordCode header(wordOf(format, format.header).chips());
  for (unsigned int value = 0; value < 1u << own; ++value) {
    const vpModulation word = wordOf(format, format.header + bitsOf(value, own));
    const vpWordCode code(word.chips());
    const bool apart = std::all_of(codes.begin(), codes.end(), [&](const vpWordCode &other) {
      return code.distance(other) >= std::max(1u, format.minDistance);
    });
    if (code.occurrences(header) == 1 && apart) {
      plan.words.push_back(word);
      codes.push_back(code);
    }
  }
}

//! The largest of the words' error bounds. \param distanceOfOne Of two words that differ in one chip.
void judge(vpWordPlan &plan, const std::vector<vpWordCode> &codes, double distanceOfOne)
{
  std::vector<double> missed; // by the number of chips that differ
  const unsigned int length = codes.front().length();
  for (unsigned int chips = 0; chips <= length; ++chips) {
    missed.push_back(vpNormalTail(0.5 * distanceOfOne * std::sqrt(chips)));
  }
  plan.distance = codes.size() > 1 ? length : 0;
  std::vector<double> error(codes.size(), 0);
  for (size_t i = 0; i < codes.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      for (unsigned int turn = 0; turn < length; ++turn) {
        const unsigned int chips = vpWordCode::differing(codes[i].turned(0), codes[j].turned(turn));
        plan.distance = std::min(plan.distance, chips);
        error[i] += missed[chips];
        error[j] += missed[chips];
      }
    }
  }
  plan.error = std::min(1.0, *std::max_element(error.begin(), error.end()));
}
} // namespace

vpWordPlan vpLedIdPlanner::words(double lines, const vpWordScheme &asked) const
{
  checkSettings();
  check(asked);
  vpWordScheme format = asked;
  format.chipRate = made(asked.chipRate);
  vpWordPlan plan;
  const double chips = format.bits * (format.code == vpModulation::Code::manchester ? 2. : 1.);
  plan.linesPerChip = 1 / (format.chipRate * prediction.lineTime());
  plan.repetitions = lines / (chips * plan.linesPerChip);
  const double contrast = prediction.contrast(format.chipRate / 2);
  if (plan.repetitions < 1) {
    plan.refusal = "a word takes " + vpNumberText(std::ceil(chips * plan.linesPerChip)) +
                   " lines, the smallest lamp has " + vpNumberText(std::floor(lines));
  } else if (plan.linesPerChip < 1) {
    plan.refusal = "chips are shorter than the time from line to line, some are never seen";
  } else if (contrast < leastContrast || 0.5 * format.chipRate * prediction.exposure() >= 1) {
    plan.refusal = "the exposure blurs the chips";
  }
  if (!plan.refusal.empty()) {
    return plan;
  }
  std::vector<vpWordCode> codes;
  choose(format, plan, codes);
  if (codes.empty()) {
    plan.refusal = "no word has its header at one rotation only";
    return plan;
  }
  const double linesOfOne = plan.linesPerChip * plan.repetitions;
  judge(plan, codes, 2 * contrast * std::sqrt(linesOfOne) / (prediction.lineNoise(0.5) * prediction.margin));
  return plan;
}

END_VISP_NAMESPACE
