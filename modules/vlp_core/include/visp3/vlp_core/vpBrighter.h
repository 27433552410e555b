/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpBrighter_h
#define vpBrighter_h

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include <opencv2/core/hal/intrin.hpp>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! Samples of a line that are brighter than a threshold, a block at a time.
namespace vpBrighter
{
constexpr int block = 64; // samples
constexpr int width = cv::v_uint8x16::nlanes;
constexpr unsigned char nearlyWhite = 250; // grey value from which on there may have been more light

//! So many samples, fewer than \e width; the rest is black.
inline cv::v_uint8x16 rest(const unsigned char *row, int samples)
{
  std::array<unsigned char, width> values{};
  std::memcpy(values.data(), row, static_cast<size_t>(samples));
  return cv::v_load(values.data());
}

//! Bit i is set where sample i of a block, of which there are so many, is brighter than \e grey.
inline std::uint64_t mask(const unsigned char *row, int samples, unsigned char grey)
{
  std::uint64_t bits = 0;
  const cv::v_uint8x16 threshold = cv::v_setall_u8(grey);
  int i = 0;
  for (; i + width <= samples; i += width) {
    const auto part = static_cast<std::uint64_t>(cv::v_signmask(cv::v_load(row + i) > threshold));
    bits |= part << i;
  }
  if (i < samples) {
    bits |= static_cast<std::uint64_t>(cv::v_signmask(rest(row + i, samples - i) > threshold)) << i;
  }
  return bits;
}

//! The brightest of each \e width-th sample of a whole block.
inline cv::v_uint8x16 most(const unsigned char *row)
{
  return cv::v_max(cv::v_max(cv::v_load(row), cv::v_load(row + width)),
                   cv::v_max(cv::v_load(row + 2 * width), cv::v_load(row + 3 * width)));
}

//! Whether any sample of a whole block is.
inline bool any(const unsigned char *row, unsigned char grey)
{
  return cv::v_check_any(most(row) > cv::v_setall_u8(grey));
}

constexpr int wide = 4 * block; // samples

//! Whether any of \e wide samples is.
inline bool anyWide(const unsigned char *row, unsigned char grey)
{
  const cv::v_uint8x16 brightest = cv::v_max(cv::v_max(most(row), most(row + block)),
                                             cv::v_max(most(row + 2 * block), most(row + 3 * block)));
  return cv::v_check_any(brightest > cv::v_setall_u8(grey));
}

//! How many of so many samples are.
inline int count(const unsigned char *row, int samples, unsigned char grey)
{
  int brighter = 0;
  for (int x = 0; x < samples; x += block) {
    brighter += __builtin_popcountll(mask(row + x, std::min(block, samples - x), grey));
  }
  return brighter;
}

//! Of so many samples.
inline unsigned char brightest(const unsigned char *row, int samples)
{
  unsigned char peak = 0;
  int i = 0;
  if (samples >= block) {
    cv::v_uint8x16 values = most(row);
    for (i = block; i + block <= samples; i += block) {
      values = cv::v_max(values, most(row + i));
    }
    peak = cv::v_reduce_max(values);
  }
  for (; i < samples; ++i) {
    peak = std::max(peak, row[i]);
  }
  return peak;
}

//! Of so many samples.
inline int sum(const unsigned char *row, int samples)
{
  int sum = 0, i = 0;
  for (; i + width <= samples; i += width) {
    sum += static_cast<int>(cv::v_reduce_sum(cv::v_load(row + i)));
  }
  return i < samples ? sum + static_cast<int>(cv::v_reduce_sum(rest(row + i, samples - i))) : sum;
}

//! Sums over samples.
struct Sums {
  int all = 0, brighter = 0; // grey levels
  int samplesBrighter = 0;
};

//! Of so many samples.
inline Sums sums(const unsigned char *row, int samples, unsigned char grey)
{
  Sums sums;
  const cv::v_uint8x16 threshold = cv::v_setall_u8(grey);
  auto add = [&](const cv::v_uint8x16 &values) {
    sums.all += static_cast<int>(cv::v_reduce_sum(values));
    const cv::v_uint8x16 brighter = values > threshold;
    if (const int bits = cv::v_signmask(brighter)) {
      sums.brighter += static_cast<int>(cv::v_reduce_sum(values & brighter));
      sums.samplesBrighter += __builtin_popcount(static_cast<unsigned int>(bits));
    }
  };
  int i = 0;
  for (; i + width <= samples; i += width) {
    add(cv::v_load(row + i));
  }
  if (i < samples) {
    add(rest(row + i, samples - i));
  }
  return sums;
}
} // namespace vpBrighter

END_VISP_NAMESPACE

#endif
