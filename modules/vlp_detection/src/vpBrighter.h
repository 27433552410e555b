/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpBrighter_h
#define vpBrighter_h

#include <cstdint>

#include <opencv2/core/hal/intrin.hpp>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! Samples of a line that are brighter than a threshold, a block at a time.
namespace vpBrighter
{
constexpr int block = 64; // samples

//! Bit i is set where sample i of a block, of which there are so many, is brighter than \e grey.
inline std::uint64_t mask(const unsigned char *row, int samples, unsigned char grey)
{
  std::uint64_t bits = 0;
  const cv::v_uint8x16 threshold = cv::v_setall_u8(grey);
  static constexpr int width = cv::v_uint8x16::nlanes;
  int i = 0;
  for (; i + width <= samples; i += width) {
    const auto part = static_cast<std::uint64_t>(cv::v_signmask(cv::v_load(row + i) > threshold));
    bits |= part << i;
  }
  for (; i < samples; ++i) {
    bits |= static_cast<std::uint64_t>(row[i] > grey) << i;
  }
  return bits;
}

//! Whether any sample of a whole block is.
inline bool any(const unsigned char *row, unsigned char grey)
{
  static constexpr int width = cv::v_uint8x16::nlanes;
  const cv::v_uint8x16 most = cv::v_max(cv::v_max(cv::v_load(row), cv::v_load(row + width)),
                                        cv::v_max(cv::v_load(row + 2 * width), cv::v_load(row + 3 * width)));
  return cv::v_check_any(most > cv::v_setall_u8(grey));
}
} // namespace vpBrighter

END_VISP_NAMESPACE

#endif
