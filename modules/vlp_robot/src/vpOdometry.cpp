/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_robot/vpOdometry.h>

#include <cmath>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpAtomicFile.h>
#include <visp3/vlp_core/vpCsvTable.h>
#include <visp3/vlp_core/vpNumberText.h>

BEGIN_VISP_NAMESPACE

namespace
{
[[noreturn]] void refuse(const std::string &filename, size_t row, const std::string &column, double value,
                         const std::string &expected)
{
  throw vpException(vpException::badValue, vpShown(filename) + ": sample " + std::to_string(row) + ": " +
                                               column + ": " + vpNumberText(value) + ", expected " +
                                               expected);
}
} // namespace

std::vector<vpOdometry> vpReadOdometry(const std::string &filename)
{
  const vpCsvTable table = vpCsvTable::load(filename, {"timestamp_s", "v_m_s", "w_rad_s"});
  if (table.rows() == 0) {
    throw vpException(vpException::badValue, vpShown(filename) + ": no samples, expected one or more");
  }
  std::vector<vpOdometry> samples;
  samples.reserve(table.rows());
  for (size_t row = 0; row < table.rows(); ++row) {
    const vpOdometry sample{table.number(row, 0), table.number(row, 1), table.number(row, 2)};
    if (row > 0 && !(sample.timestamp > samples.back().timestamp)) {
      table.fail(row, 0, "expected a time after that of the line above");
    }
    samples.push_back(sample);
  }
  return samples;
}

void vpWriteOdometry(const std::string &filename, const std::vector<vpOdometry> &samples)
{
  vpAtomicFile file(filename);
  file.stream() << "timestamp_s,v_m_s,w_rad_s\n";
  for (size_t row = 0; row < samples.size(); ++row) {
    const vpOdometry &sample = samples[row];
    if (!std::isfinite(sample.timestamp) || (row > 0 && !(sample.timestamp > samples[row - 1].timestamp))) {
      refuse(filename, row, "timestamp_s", sample.timestamp, "a finite time after that of the sample before");
    }
    if (!std::isfinite(sample.v)) {
      refuse(filename, row, "v_m_s", sample.v, "a finite number");
    }
    if (!std::isfinite(sample.w)) {
      refuse(filename, row, "w_rad_s", sample.w, "a finite number");
    }
    file.stream() << vpNumberText(sample.timestamp) << ',' << vpNumberText(sample.v) << ','
                  << vpNumberText(sample.w) << '\n';
  }
  file.commit();
}

END_VISP_NAMESPACE
