/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_core/vpCsvTable.h>

#include <algorithm>
#include <cmath>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_core/vpPrintable.h>
#include <visp3/vlp_core/vpReadFile.h>

BEGIN_VISP_NAMESPACE

namespace
{
[[noreturn]] void failAt(const std::string &filename, size_t line, const std::string &problem)
{
  throw vpException(vpException::badValue,
                    vpPrintable(filename) + ":" + std::to_string(line) + ": " + problem);
}

std::string joined(const std::vector<std::string> &columns)
{
  std::string text;
  for (const std::string &column : columns) {
    text += (text.empty() ? "" : ",") + column;
  }
  return text;
}

//! Lines without their ends; blank lines at the end of the file do not count.
std::vector<std::string> linesOf(const std::string &bytes)
{
  const bool marked = bytes.compare(0, 3, "\xEF\xBB\xBF") == 0; // byte order mark of spreadsheets
  std::vector<std::string> lines;
  for (size_t begin = marked ? 3 : 0; begin < bytes.size();) {
    const size_t end = std::min(bytes.find('\n', begin), bytes.size());
    const bool carriageReturn = end > begin && bytes[end - 1] == '\r';
    lines.push_back(bytes.substr(begin, end - begin - (carriageReturn ? 1 : 0)));
    begin = end + 1;
  }
  while (!lines.empty() && lines.back().find_first_not_of(" \t") == std::string::npos) {
    lines.pop_back();
  }
  return lines;
}

//! Fields of one line; false where a quote is left open or stands inside an unquoted field.
bool split(const std::string &line, std::vector<std::string> &fields)
{
  fields.assign(1, std::string());
  bool quoted = false, closed = false;
  for (size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    std::string &field = fields.back();
    if (quoted && c == '"' && i + 1 < line.size() && line[i + 1] == '"') {
      field += line[++i];
    } else if (quoted && c == '"') {
      quoted = false;
      closed = true;
    } else if (quoted) {
      field += c;
    } else if (c == ',') {
      fields.emplace_back();
      closed = false;
    } else if (c == '"' && field.empty() && !closed) {
      quoted = true;
    } else if (c == '"' || closed) {
      return false;
    } else {
      field += c;
    }
  }
  return !quoted;
}
} // namespace

vpCsvTable vpCsvTable::load(const std::string &filename, const std::vector<std::string> &columns)
{
  vpCsvTable table;
  table.m_filename = filename;
  table.m_columns = columns;

  const std::vector<std::string> lines = linesOf(vpReadFile(filename));
  std::vector<std::string> fields;
  if (lines.empty()) {
    failAt(filename, 1, "header: nothing, expected " + joined(columns));
  }
  if (!split(lines[0], fields) || fields != columns) {
    failAt(filename, 1, "header: " + vpShown(lines[0]) + ", expected " + joined(columns));
  }
  for (size_t i = 1; i < lines.size(); ++i) {
    if (!split(lines[i], fields)) {
      failAt(filename, i + 1, "misplaced quote: " + vpShown(lines[i]) + ", expected " + joined(columns));
    }
    if (fields.size() != columns.size()) {
      failAt(filename, i + 1,
             std::to_string(fields.size()) + (fields.size() == 1 ? " field" : " fields") + ", expected " +
                 std::to_string(columns.size()) + ": " + joined(columns));
    }
    table.m_rows.push_back(fields);
  }
  return table;
}

double vpCsvTable::number(size_t row, size_t column) const
{
  double value = 0;
  if (!vpParseNumber(text(row, column), value) || !std::isfinite(value)) {
    fail(row, column, "expected a finite number");
  }
  return value;
}

void vpCsvTable::fail(size_t row, size_t column, const std::string &problem) const
{
  const std::string &came = text(row, column);
  failAt(m_filename, row + 2,
         m_columns[column] + ": " + (came.empty() ? std::string("nothing") : vpShown(came)) + ", " + problem);
}

std::string vpCsvTable::field(const std::string &text)
{
  const auto isControl = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  if (text.find_first_of(",\"") == std::string::npos && std::none_of(text.begin(), text.end(), isControl)) {
    return text;
  }
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') {
      quoted += '"';
    }
    quoted += isControl(c) ? ' ' : c; // a row is a line
  }
  return quoted + "\"";
}

END_VISP_NAMESPACE
