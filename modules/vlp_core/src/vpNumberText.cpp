/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_core/vpNumberText.h>

#include <array>
#include <charconv>
#include <cmath>

#include <visp3/vlp_core/vpPrintable.h>

BEGIN_VISP_NAMESPACE

std::string vpNumberText(double value)
{
  std::array<char, 64> buffer;
  const auto result =
      std::to_chars(buffer.data(), buffer.data() + buffer.size(), value == 0 ? 0 : value); // no -0
  return std::string(buffer.data(), result.ptr);
}

std::string vpDegreesText(double radians)
{
  const double degrees = radians * 180 / M_PI;
  for (int digits = 1; digits <= 17; ++digits) {
    std::array<char, 64> buffer;
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), degrees == 0 ? 0 : degrees,
                                   std::chars_format::general, digits);
    const std::string text(buffer.data(), end.ptr);
    double back = 0;
    if (vpParseNumber(text, back) && back * M_PI / 180 == radians) {
      return vpNumberText(back); // 180, not 1.8e+02
    }
  }
  return vpNumberText(degrees);
}

bool vpParseNumber(const std::string &text, double &value)
{
  const char *const blanks = " \t\r";
  const size_t first = text.find_first_not_of(blanks);
  if (first == std::string::npos) {
    return false;
  }
  const char *begin = text.data() + first;
  const char *const end = text.data() + text.find_last_not_of(blanks) + 1;
  if (*begin == '+' && end - begin > 1 && begin[1] != '-' && begin[1] != '+') {
    ++begin;
  }
  const auto result = std::from_chars(begin, end, value);
  return result.ec == std::errc() && result.ptr == end;
}

std::string vpShown(const std::string &text)
{
  constexpr size_t longest = 80;
  if (text.size() <= longest) {
    return vpPrintable(text);
  }
  size_t end = longest;
  while (end > longest - 4 &&
         (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) { // inside a character of UTF-8
    --end;
  }
  return vpPrintable(text.substr(0, end)) + "...";
}

END_VISP_NAMESPACE
