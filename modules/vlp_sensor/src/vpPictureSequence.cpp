/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_sensor/vpPictureSequence.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpCsvTable.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_sensor/vpReadGreyPicture.h>

BEGIN_VISP_NAMESPACE

namespace
{
namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string &name, const std::string &problem)
{
  throw vpException(vpException::badValue, vpShown(name) + ": " + problem);
}

//! A file name with one number in it, taken apart: never handed to printf, since it comes from outside.
class NumberedName
{
public:
  explicit NumberedName(const std::string &pattern)
  {
    const std::string wanted = "expected one number as %d or %04d";
    bool found = false;
    for (size_t i = 0; i < pattern.size(); ++i) {
      std::string &part = found ? m_suffix : m_prefix;
      if (pattern[i] != '%') {
        part += pattern[i];
        continue;
      }
      if (pattern.compare(i, 2, "%%") == 0) {
        part += pattern[i++];
        continue;
      }
      const size_t end = pattern.find_first_not_of("0123456789", i + 1);
      if (end == std::string::npos || (pattern[end] != 'd' && pattern[end] != 'i' && pattern[end] != 'u')) {
        fail(pattern, "unknown conversion at character " + std::to_string(i + 1) + ", " + wanted);
      }
      if (found) {
        fail(pattern, "a second conversion at character " + std::to_string(i + 1) + ", " + wanted);
      }
      const std::string digits = pattern.substr(i + 1, end - i - 1);
      if (digits.size() > 3 || (!digits.empty() && digits[0] != '0')) { // %4d pads with blanks
        fail(pattern, "conversion %" + digits + pattern[end] + ", " + wanted);
      }
      m_width = digits.empty() ? 0 : static_cast<size_t>(std::stoul(digits));
      found = true;
      i = end;
    }
    if (!found) {
      fail(pattern, "no number, " + wanted);
    }
    if (m_suffix.find('/') != std::string::npos) {
      fail(pattern, "the number is in the folder's name, expected it in the file's");
    }
  }

  std::string operator()(std::uint64_t number) const
  {
    const std::string digits = std::to_string(number);
    return m_prefix + std::string(m_width > digits.size() ? m_width - digits.size() : 0, '0') + digits +
           m_suffix;
  }

  //! All numbers whose file exists, the lowest first.
  std::vector<std::uint64_t> numbers() const
  {
    const size_t slash = m_prefix.rfind('/');
    const std::string folder = slash == std::string::npos ? "" : m_prefix.substr(0, slash + 1);
    std::vector<std::uint64_t> found;
    std::error_code error;
    for (fs::directory_iterator entry(folder.empty() ? "." : folder, error), end; !error && entry != end;
         entry.increment(error)) {
      const std::optional<std::uint64_t> number = numberOf(folder + entry->path().filename().string());
      if (number) {
        found.push_back(*number);
      }
    }
    std::sort(found.begin(), found.end());
    return found;
  }

private:
  std::optional<std::uint64_t> numberOf(const std::string &name) const
  {
    const size_t around = m_prefix.size() + m_suffix.size();
    if (name.size() <= around || name.size() > around + std::numeric_limits<std::uint64_t>::digits10 ||
        name.compare(0, m_prefix.size(), m_prefix) != 0) {
      return std::nullopt;
    }
    const std::string digits = name.substr(m_prefix.size(), name.size() - around);
    if (!std::all_of(digits.begin(), digits.end(), [](unsigned char c) { return std::isdigit(c) != 0; })) {
      return std::nullopt;
    }
    const std::uint64_t number = std::stoull(digits);
    return (*this)(number) == name ? std::optional<std::uint64_t>(number) : std::nullopt;
  }

  std::string m_prefix;
  std::string m_suffix;
  size_t m_width = 0;
};
} // namespace

vpPictureSequence::vpPictureSequence(const std::vector<std::string> &files)
{
  if (files.empty()) {
    throw vpException(vpException::badValue, "picture files: none, expected one or more");
  }
  for (const std::string &file : files) {
    m_pictures.push_back({file, static_cast<double>(m_pictures.size())});
  }
}

vpPictureSequence vpPictureSequence::fromPattern(const std::string &pattern)
{
  const NumberedName name(pattern);
  const std::vector<std::uint64_t> numbers = name.numbers();
  if (numbers.empty()) {
    throw vpException(vpException::ioError, vpShown(pattern) + ": no such file, whatever the number");
  }
  std::vector<std::string> files{name(numbers[0])};
  while (files.size() < numbers.size() && numbers[files.size()] == numbers[0] + files.size()) {
    files.push_back(name(numbers[files.size()]));
  }
  vpPictureSequence sequence(files);
  if (files.size() < numbers.size()) {
    sequence.m_remark = vpShown(name(numbers[0] + files.size())) +
                        ": missing, expected numbers without gaps; pictures from " +
                        vpShown(name(numbers[files.size()])) + " on are left out, " +
                        std::to_string(numbers.size() - files.size());
  }
  return sequence;
}

vpPictureSequence vpPictureSequence::fromRun(const std::string &folder)
{
  const std::string list = (fs::path(folder) / "frames.csv").string();
  const vpCsvTable table = vpCsvTable::load(list, {"timestamp_s", "file"});
  if (table.rows() == 0) {
    fail(list, "no frames, expected one or more");
  }
  vpPictureSequence sequence;
  size_t late = 0;
  for (size_t row = 0; row < table.rows(); ++row) {
    const double timestamp = table.number(row, 0);
    if (row > 0 && timestamp <= sequence.m_pictures.back().timestamp && ++late == 1) {
      sequence.m_remark = list + ":" + std::to_string(row + 2) +
                          ": timestamp_s: " + vpShown(table.text(row, 0)) + ", not after the " +
                          vpShown(table.text(row - 1, 0)) + " of the line above";
    }
    if (table.text(row, 1).empty()) {
      table.fail(row, 1, "expected a file's name");
    }
    sequence.m_pictures.push_back({(fs::path(folder) / table.text(row, 1)).string(), timestamp});
  }
  if (late > 1) {
    sequence.m_remark += " (the first of " + std::to_string(late) + " such lines)";
  }
  return sequence;
}

bool vpPictureSequence::next(vpVlpFrame &frame)
{
  if (m_next == m_pictures.size()) {
    return false;
  }
  const Picture &picture = m_pictures[m_next++];
  vpReadGreyPicture(picture.file, frame.I);
  frame.timestamp = picture.timestamp;
  frame.name = picture.file;
  return true;
}

END_VISP_NAMESPACE
