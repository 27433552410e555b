/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_core/vpPrintable.h>

#include <array>
#include <cstdio>

BEGIN_VISP_NAMESPACE

namespace
{
//! The character's number in Unicode; \e length: that of its UTF-8, 1 or more.
unsigned int codeOf(const std::string &text, size_t i, size_t length)
{
  const unsigned int first = static_cast<unsigned char>(text[i]);
  unsigned int code = length == 1 ? first : first & (0x7F >> length);
  for (size_t k = 1; k < length; ++k) {
    code = code << 6 | (static_cast<unsigned char>(text[i + k]) & 0x3F);
  }
  return code;
}

//! Whether it does something else than to stand in its place.
bool isControl(unsigned int code)
{
  const bool control = code < 0x20 || (code >= 0x7F && code < 0xA0);
  const bool lineEnd = code == 0x2028 || code == 0x2029;
  const bool direction = code == 0x061C || code == 0x200E || code == 0x200F ||
                         (code >= 0x202A && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
  return control || lineEnd || direction;
}
} // namespace

size_t vpUtf8Length(const std::string &text, size_t i)
{
  const auto byte = [&text](size_t k) { return k < text.size() ? static_cast<unsigned char>(text[k]) : 0u; };
  const unsigned int first = byte(i);
  if (first < 0x80) {
    return i < text.size() ? 1 : 0;
  }
  if (first < 0xC2 || first > 0xF4) {
    return 0;
  }
  const size_t length = first < 0xE0 ? 2 : (first < 0xF0 ? 3 : 4);
  for (size_t k = 1; k < length; ++k) {
    if ((byte(i + k) & 0xC0) != 0x80) {
      return 0;
    }
  }
  const unsigned int second = byte(i + 1);
  const bool tooLong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
  const bool beyond = (first == 0xED && second >= 0xA0) || (first == 0xF4 && second >= 0x90);
  return tooLong || beyond ? 0 : length;
}

std::string vpPrintable(const std::string &text)
{
  std::string printable;
  for (size_t i = 0; i < text.size();) {
    const size_t length = vpUtf8Length(text, i);
    if (length > 0 && !isControl(codeOf(text, i, length))) {
      printable.append(text, i, length);
      i += length;
      continue;
    }
    for (const size_t end = i + (length > 0 ? length : 1); i < end; ++i) {
      std::array<char, 8> escape;
      std::snprintf(escape.data(), escape.size(), "\\x%02x",
                    static_cast<unsigned int>(static_cast<unsigned char>(text[i])));
      printable += escape.data();
    }
  }
  return printable;
}

END_VISP_NAMESPACE
