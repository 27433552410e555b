/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpDips.h"

#include <algorithm>
#include <array>
#include <vector>

#include <opencv2/core/hal/intrin.hpp>

BEGIN_VISP_NAMESPACE

namespace
{
const int strip = 4, // samples
    width = cv::v_uint8x16::nlanes;

//! Four strips side by side, followed from line to line.
class Strips
{
public:
  //! \param dip Line of an earlier one.
  void begin(double dip)
  {
    m_high.fill(0);
    m_low.fill(0);
    m_lastDip.fill(static_cast<float>(dip));
    m_falling.fill(0);
  }

  /*!
    The next line. \param row The first of its 16 samples. \param black Of a strip. \param rest Share that is
    left of the light in the shallowest dip, (1 - depth) / (1 + depth). \param tolerance That it is deeper.
    \return Whether one has a dip within \e longest lines of the one before.
  */
  bool add(const unsigned char *row, float line, float black, float rest, float tolerance, float longest)
  {
    const cv::v_float32x4 zero = cv::v_setzero_f32(),
                          sum = cv::v_cvt_f32(cv::v_reinterpret_as_s32(
                              cv::v_dotprod_expand(cv::v_load(row), cv::v_setall_u8(1)))),
                          light = cv::v_max(sum - cv::v_setall_f32(black), zero),
                          share = cv::v_setall_f32(rest), least = cv::v_setall_f32(tolerance);
    cv::v_float32x4 high = cv::v_load(m_high.data()), low = cv::v_load(m_low.data()),
                    last = cv::v_load(m_lastDip.data()), falling = cv::v_load(m_falling.data());
    const cv::v_float32x4 down = falling != zero, now = cv::v_setall_f32(line);
    high = cv::v_select(down, high, cv::v_max(high, light));
    low = cv::v_select(down, cv::v_min(low, light), light);
    const cv::v_float32x4 falls = ~down & (light < share * high - least),
                          dips = down & (low < share * light - least);
    const bool twice = cv::v_check_any(dips & (now - last <= cv::v_setall_f32(longest)));
    cv::v_store(m_high.data(), cv::v_select(dips, light, high));
    cv::v_store(m_low.data(), low);
    cv::v_store(m_lastDip.data(), cv::v_select(dips, now, last));
    cv::v_store(m_falling.data(),
                cv::v_select(falls, cv::v_setall_f32(1), cv::v_select(dips, zero, falling)));
    return twice;
  }

  //! Of the brightest, since its last dip.
  float brightest() const { return *std::max_element(m_high.begin(), m_high.end()); }

private:
  using Lanes = std::array<float, 4>;
  Lanes m_high, m_low; // since the last dip; since the light began to fall
  Lanes m_lastDip;     // line
  Lanes m_falling;     // 1 where it has fallen and not risen again
};
} // namespace

bool vpMayBlink(const cv::Mat_<unsigned char> &lines, const cv::Rect &box, double dark, double noise,
                double longestPeriod)
{
  static const double depth = 0.05, sigmas = 4, sqrtStrip = 2;
  if (lines.cols < width) {
    return true;
  }
  const auto black = static_cast<float>(strip * dark), rest = static_cast<float>((1 - depth) / (1 + depth)),
             tolerance = static_cast<float>(sigmas * sqrtStrip * noise),
             longest = static_cast<float>(longestPeriod);
  const int first = std::min(box.x, lines.cols - width), blocks = (box.br().x - first + width - 1) / width;
  std::vector<Strips> strips(static_cast<size_t>(blocks));
  for (Strips &each : strips) {
    each.begin(box.height > 2 * longestPeriod ? box.y - 2 * longestPeriod : box.br().y); // else one is enough
  }
  for (int y = box.y; y < box.br().y; ++y) {
    for (int k = 0; k < blocks; ++k) {
      const int x = std::min(first + k * width, lines.cols - width);
      if (strips[static_cast<size_t>(k)].add(lines[y] + x, static_cast<float>(y), black, rest, tolerance,
                                             longest)) {
        return true;
      }
    }
  }
  // What is too dim for the shallowest stripes that are planned to show may blink, too.
  static const double planned = 0.2; // depth
  const double shows = tolerance / (rest - (1 - planned) / (1 + planned));
  return std::none_of(strips.begin(), strips.end(),
                      [shows](const Strips &each) { return each.brightest() > shows; });
}

END_VISP_NAMESPACE
