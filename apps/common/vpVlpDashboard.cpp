/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "common/vpVlpDashboard.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <visp3/vlp_core/vpPoseText.h>

#include "common/vpMapSheet.h"
#include "common/vpTextBlock.h"
#include "common/vpVlpColours.h"
#include "common/vpVlpOverlay.h"

BEGIN_VISP_NAMESPACE

namespace
{
//! Of the day, UTC, where the time is that of the host's clock, s since 1970.
std::string timeText(double time)
{
  static const double clock = 1e8, day = 86400; // s
  if (!(time > clock)) {
    return vpFormat("%.3f s", time);
  }
  const double second = std::fmod(time, day);
  return vpFormat("%02.0f:", std::floor(second / 3600)) +
         vpFormat("%02.0f:", std::floor(std::fmod(second, 3600) / 60)) +
         vpFormat("%06.3f", std::fmod(second, 60));
}

//! A line of the status: up to three cells, each at its own place.
using Row = std::array<std::string, 3>;

constexpr size_t mostRows = 7, columns = 50; // letters of a line

std::string counted(size_t count, const std::string &thing)
{
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

//! With two digits or more, and no power of ten: `0.0038`, `0.38`, `190`.
std::string sigmaText(double sigma, const char *unit)
{
  const int digits = sigma > 0 && std::isfinite(sigma)
                         ? std::clamp(1 - static_cast<int>(std::floor(std::log10(sigma))), 0, 6)
                         : 0;
  return vpFormat("+/- %.*f %s", digits, sigma, unit);
}

void addPose(std::vector<Row> &rows, const vpVlpFix &fix)
{
  const auto sigma = [&fix](int i) { return std::sqrt(fix.covariance(i, i)); };
  const double degree = M_PI / 180;
  for (unsigned int i = 0; i < 3; ++i) {
    rows.push_back({std::string(1, "xyz"[i]), vpFormat("%.4f m", vpRounded(fix.wMb[i][3], 1e4)),
                    sigmaText(1000 * sigma(static_cast<int>(i)), "mm")});
  }
  rows.push_back({"yaw", vpFormat("%.3f deg", vpRounded(vpRollPitchYaw(fix.wMb).z() / degree, 1e3)),
                  sigmaText(sigma(5) / degree, "deg")});
}

void addRefusal(std::vector<Row> &rows, const std::string &refusal)
{
  constexpr size_t most = 4; // rows, as many as a pose has
  for (const std::string &line : vpWrapped(refusal, columns)) {
    if (rows.size() < 1 + most) {
      rows.push_back({line, "", ""});
    }
  }
}

//! How many count, and which.
std::string lampsText(const vpVlpLocation &location)
{
  size_t counts = 0;
  std::string ids;
  for (const vpLampObservation &lamp : location.observations) {
    if (lamp.accepted) {
      ids += (counts++ == 0 ? ": " : ", ") + lamp.id;
    }
  }
  const std::string text =
      counted(counts, "lamp") + " of " + counted(location.observations.size(), "region") + ids;
  return text.size() <= columns ? text : text.substr(0, columns - 3) + "...";
}

int rowHeight(double unit)
{
  return cvRound(18 * unit);
}

int statusHeight(double unit)
{
  return cvRound(34 * unit) + static_cast<int>(mostRows) * rowHeight(unit);
}

void drawStatus(cv::Mat &picture, const vpVlpLocation &location, double compute, double unit)
{
  const vpVlpFix &fix = location.fix;
  std::vector<Row> rows = {
      {"t", timeText(location.timestamp), vpFormat("%.1f ms per frame", 1000 * compute)}};
  if (fix.valid) {
    addPose(rows, fix);
  } else {
    addRefusal(rows, fix.refusal);
  }
  rows.resize(mostRows - 2);
  rows.push_back({lampsText(location), "", ""});
  rows.push_back({location.searched.empty()
                      ? "all of the picture searched"
                      : "blue: " + counted(location.searched.size(), "window") + " searched",
                  "", ""});

  const std::string state = vpStateOf(location);
  const std::string heading = !fix.valid           ? "no position"
                              : fix.ambiguous      ? "ambiguous: two poses fit"
                              : location.relocated ? "relocated: not borne out yet"
                                                   : state;
  const int left = cvRound(10 * unit);
  int base = cvRound(24 * unit);
  const cv::Scalar colour = fix.valid ? vpVlpColours::ofState(state) : vpVlpColours::yellow;
  vpDrawText(picture, heading, {left, base}, 1.5 * unit, colour);
  base += cvRound(4 * unit);
  for (const Row &row : rows) {
    base += rowHeight(unit);
    for (size_t i = 0; i < row.size(); ++i) {
      const std::array<double, 3> tabs = {0, 40, 150};
      vpDrawText(picture, row[i], {left + cvRound(tabs[i] * unit), base}, unit, vpVlpColours::white);
    }
  }
}
} // namespace

cv::Mat vpVlpDashboard::draw(const vpImage<unsigned char> &I, const vpVlpLocation &location, double compute,
                             const std::vector<vpLampChart> &charts)
{
  m_panel.add(location);
  const cv::Mat picture = vpDrawVlpOverlay(I, location, charts);
  const double unit = std::max(picture.cols, picture.rows) / 800.0; // as the overlay's
  const int width = cvRound(400 * unit), least = cvRound(520 * unit);
  const int height = std::max(picture.rows, least);

  cv::Mat all(height, picture.cols + width, CV_8UC3, vpMapSheet::ground);
  picture.copyTo(all(cv::Rect(cv::Point(), picture.size())));
  cv::Mat status = all(cv::Rect(picture.cols, 0, width, statusHeight(unit)));
  drawStatus(status, location, compute, unit);
  const cv::Rect below(picture.cols, status.rows, width, height - status.rows);
  m_panel.draw(below.size(), unit).copyTo(all(below));
  return all;
}

END_VISP_NAMESPACE
