/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpCsvTable_h
#define vpCsvTable_h

#include <string>
#include <vector>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  A table read strictly from a CSV file: a header line with exactly the columns expected, then rows of that
  many fields. Fields that hold a comma or a quote stand in double quotes. Every error is a vpException whose
  one line names file, line, column, what came and what was expected: `odometry.csv:7: v_m_s: abc, expected a
  finite number`.
*/
class VISP_EXPORT vpCsvTable
{
public:
  static vpCsvTable load(const std::string &filename, const std::vector<std::string> &columns);

  size_t rows() const { return m_rows.size(); }

  //! Field of row \e row (0 is the first below the header) and column number \e column.
  const std::string &text(size_t row, size_t column) const { return m_rows.at(row).at(column); }

  //! The same, which must be a finite number.
  double number(size_t row, size_t column) const;

  //! Throws the one-line error about a field.
  [[noreturn]] void fail(size_t row, size_t column, const std::string &problem) const;

  //! \e text as a field of a CSV file, in quotes where it needs them.
  static std::string field(const std::string &text);

private:
  std::string m_filename;
  std::vector<std::string> m_columns;
  std::vector<std::vector<std::string>> m_rows;
};

END_VISP_NAMESPACE

#endif
