/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_core/vpTrajectory.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpAtomicFile.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_core/vpPoseText.h>
#include <visp3/vlp_core/vpPrintable.h>
#include <visp3/vlp_core/vpReadFile.h>

BEGIN_VISP_NAMESPACE

namespace
{
constexpr size_t fieldCount = 8;
const std::array<const char *, fieldCount> fieldNames = {"timestamp", "tx", "ty", "tz",
                                                         "qx",        "qy", "qz", "qw"};

//! One row of a TUM file, and where it stands.
class Row
{
public:
  Row(const std::string &filename, size_t line, const std::string &text)
      : m_place(vpPrintable(filename) + ":" + std::to_string(line) + ": ")
  {
    std::istringstream words(text);
    for (std::string word; words >> word;) {
      m_words.push_back(word);
    }
    if (m_words.size() != fieldCount) {
      fail(std::to_string(m_words.size()) + (m_words.size() == 1 ? " field" : " fields") +
           ", expected 8: timestamp tx ty tz qx qy qz qw");
    }
    for (size_t i = 0; i < fieldCount; ++i) {
      if (!vpParseNumber(m_words[i], m_values[i]) || !std::isfinite(m_values[i])) {
        fail(i, "expected a finite number");
      }
    }
  }

  double timestamp() const { return m_values[0]; }

  vpHomogeneousMatrix pose() const
  {
    constexpr double tolerance = 0.01;
    Eigen::Quaterniond q(m_values[7], m_values[4], m_values[5], m_values[6]);
    const double length = q.coeffs().stableNorm();
    if (!(std::abs(length - 1) <= tolerance)) {
      fail("qx qy qz qw: of length " + vpNumberText(length) + ", expected a unit quaternion");
    }
    q.coeffs() /= length;
    return vpPoseOf({m_values[1], m_values[2], m_values[3]}, q);
  }

  [[noreturn]] void fail(size_t field, const std::string &problem) const
  {
    fail(std::string(fieldNames[field]) + ": " + vpShown(m_words[field]) + ", " + problem);
  }

private:
  [[noreturn]] void fail(const std::string &problem) const
  {
    throw vpException(vpException::badValue, m_place + problem);
  }

  std::string m_place;
  std::vector<std::string> m_words;
  std::array<double, fieldCount> m_values{};
};
} // namespace

vpTrajectory vpTrajectory::load(const std::string &filename)
{
  const std::string bytes = vpReadFile(filename);
  vpTrajectory trajectory;
  size_t number = 0;
  const bool marked = bytes.compare(0, 3, "\xEF\xBB\xBF") == 0; // byte order mark of some editors
  for (size_t begin = marked ? 3 : 0; begin < bytes.size(); ++number) {
    const size_t end = std::min(bytes.find('\n', begin), bytes.size());
    const std::string line = bytes.substr(begin, end - begin);
    begin = end + 1;
    const size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') {
      continue;
    }
    const Row row(filename, number + 1, line);
    if (!trajectory.empty() && row.timestamp() <= trajectory.m_poses.back().timestamp) {
      row.fail(0, "expected a time after that of the row above, " +
                      vpNumberText(trajectory.m_poses.back().timestamp));
    }
    trajectory.m_poses.push_back({row.timestamp(), row.pose()});
  }
  return trajectory;
}

void vpTrajectory::save(const std::string &filename) const
{
  vpAtomicFile file(filename);
  file.stream() << vpTumHeader << "\n";
  for (const vpTimedPose &pose : m_poses) {
    file.stream() << vpTumRow(pose.timestamp, pose.wMb) << "\n";
  }
  file.commit();
}

void vpTrajectory::add(double timestamp, const vpHomogeneousMatrix &wMb)
{
  if (!std::isfinite(timestamp) || (!empty() && timestamp <= m_poses.back().timestamp)) {
    throw vpException(vpException::badValue, "timestamp: " + vpNumberText(timestamp) + ", expected " +
                                                 (empty() ? "a finite number"
                                                          : "a time after that of the pose before, " +
                                                                vpNumberText(m_poses.back().timestamp)));
  }
  m_poses.push_back({timestamp, wMb});
}

std::optional<vpHomogeneousMatrix> vpTrajectory::at(double time, double longestGap) const
{
  const auto after =
      std::lower_bound(m_poses.begin(), m_poses.end(), time,
                       [](const vpTimedPose &pose, double wanted) { return pose.timestamp < wanted; });
  if (after == m_poses.end() || std::isnan(time)) {
    return std::nullopt;
  }
  if (after->timestamp == time) {
    return after->wMb;
  }
  if (after == m_poses.begin()) {
    return std::nullopt;
  }
  const vpTimedPose &a = *(after - 1), &b = *after;
  const double gap = b.timestamp - a.timestamp;
  if (!(gap <= longestGap)) {
    return std::nullopt;
  }
  const double share = (time - a.timestamp) / gap;
  Eigen::Vector3d position;
  for (unsigned int i = 0; i < 3; ++i) {
    position[i] = a.wMb[i][3] + share * (b.wMb[i][3] - a.wMb[i][3]);
  }
  return vpPoseOf(position, vpQuaternionOf(a.wMb).slerp(share, vpQuaternionOf(b.wMb)).normalized());
}

END_VISP_NAMESPACE
