/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "common/vpMapPanel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Eigenvalues>
#include <opencv2/imgproc.hpp>
#include <visp3/vlp_core/vpPoseText.h>

#include "common/vpMapSheet.h"
#include "common/vpTextBlock.h"
#include "common/vpVlpColours.h"

BEGIN_VISP_NAMESPACE

namespace
{
using Box = Eigen::AlignedBox2d;

constexpr size_t mostShown = 80;      // lamps of a map that is shown whole
constexpr size_t mostLabels = 100;    // lamps whose ids are written; of more, of those that are seen
constexpr double around = 60;         // lamps that are shown of a larger one
constexpr double leastExtent = 1;     // m
constexpr double farthestPlace = 1e7; // m; farther away, a grid's lines would have no numbers of their own

//! Lamps that count, others that are seen, all others.
const std::array<cv::Scalar, 3> lampColours = {vpVlpColours::green, vpVlpColours::yellow, vpVlpColours::grey};

bool isNear(const Eigen::Vector2d &place)
{
  return place.allFinite() && place.cwiseAbs().maxCoeff() < farthestPlace;
}

//! Larger by \e margin (m) on each side.
Box widened(const Box &box, double margin)
{
  const Eigen::Vector2d more = Eigen::Vector2d::Constant(margin);
  return {box.min() - more, box.max() + more};
}

//! As large as a map has to be to be read.
Box readable(const Box &box)
{
  const Eigen::Vector2d half = (0.5 * box.sizes()).cwiseMax(0.5 * leastExtent);
  return {box.center() - half, box.center() + half};
}

//! The points at 3 sigma; none where the covariance is none.
std::vector<Eigen::Vector2d> ellipse(const Eigen::Vector2d &centre, const Eigen::Matrix2d &covariance)
{
  if (!covariance.allFinite()) {
    return {};
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(covariance);
  const Eigen::Vector2d variance = axes.eigenvalues();
  if (variance.minCoeff() < -1e-9 * std::abs(variance.maxCoeff())) {
    return {};
  }
  const Eigen::Matrix2d reach =
      3 * axes.eigenvectors() * variance.cwiseMax(0).cwiseSqrt().asDiagonal().toDenseMatrix();
  constexpr int count = 90;
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < count; ++i) {
    const double t = 2 * M_PI * i / count;
    points.emplace_back(centre + reach * Eigen::Vector2d(std::cos(t), std::sin(t)));
  }
  return points;
}

std::vector<Eigen::Vector2d> circle(const Eigen::Vector2d &centre, double radius, int corners,
                                    double first = 0)
{
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < corners; ++i) {
    const double t = first + 2 * M_PI * i / corners;
    points.emplace_back(centre + radius * Eigen::Vector2d(std::cos(t), std::sin(t)));
  }
  return points;
}

//! The lamp as large as it is, and no smaller than is seen well where \e count of them share the sheet.
std::vector<Eigen::Vector2d> outline(const vpLamp &lamp, const vpMapSheet &sheet, size_t count)
{
  const double room = sheet.side() / std::sqrt(static_cast<double>(count)); // px, from lamp to lamp
  const double least = std::clamp(0.3 * room, 2.5 * sheet.unit(), 9 * sheet.unit()) / sheet.scale();
  const double size = std::isfinite(lamp.size) ? std::max(lamp.size, least) : least;
  const Eigen::Vector2d place = lamp.position.head<2>();
  return lamp.shape == vpLamp::Shape::square ? circle(place, size / std::sqrt(2.0), 4, lamp.yaw + M_PI / 4)
                                             : circle(place, size / 2, size * sheet.scale() < 8 ? 8 : 40);
}

constexpr int legendRows = 2;

int legendRow(double unit)
{
  return cvRound(16 * unit);
}

//! What the colours mean, below the map.
void drawLegend(cv::Mat &panel, int top, double unit)
{
  const std::array<std::vector<std::pair<cv::Scalar, std::string>>, legendRows> rows = {
      {{{lampColours[0], "lamp counts"},
        {lampColours[1], "seen, not counted"},
        {lampColours[2], "not seen"},
        {vpVlpColours::white, "3 sigma"}},
       {{vpVlpColours::ofState("fix"), "fix"},
        {vpVlpColours::ofState("tracking"), "tracking"},
        {vpVlpColours::ofState("coasting"), "coasting"},
        {vpVlpColours::ofState("relocated"), "relocated"},
        {vpVlpColours::ofState("ambiguous"), "ambiguous"}}}};
  const int row = legendRow(unit), radius = cvRound(3.5 * unit), gap = cvRound(5 * unit);
  for (size_t i = 0; i < rows.size(); ++i) {
    int u = 2 * gap;
    const int v = top + static_cast<int>(i) * row + row / 2;
    for (const auto &[colour, text] : rows[i]) {
      cv::circle(panel, {u + radius, v}, radius, colour, i == 0 ? cv::FILLED : 2, cv::LINE_AA);
      u += 2 * radius + gap;
      const cv::Size size = vpTextSize(text, vpMapSheet::textUnit * unit);
      vpDrawText(panel, text, {u, v + size.height / 2}, vpMapSheet::textUnit * unit, vpMapSheet::textColour);
      u += size.width + 2 * gap;
    }
  }
}
} // namespace

vpMapPanel::vpMapPanel(const vpLampMap &map) : m_map(map)
{
  size_t shown = 0;
  for (size_t i = 0; i < map.lamps.size(); ++i) {
    m_lampOf.emplace(map.lamps[i].id, i);
    const Eigen::Vector2d place = map.lamps[i].position.head<2>();
    if (isNear(place)) {
      m_extent.extend(place);
      ++shown;
    }
  }
  if (shown > mostShown) { // by how dense they hang, in a hall or along a corridor
    const Eigen::Vector2d size = m_extent.sizes();
    const double share = around / static_cast<double>(shown);
    m_reach = 0.5 * std::max({std::sqrt(share * size.prod()), share * size.maxCoeff() / 3, leastExtent});
  }
  const Box all = readable(m_extent.isEmpty() ? Box(Eigen::Vector2d(0, 0)) : m_extent);
  m_view = widened(all, 0.12 * all.sizes().maxCoeff());
}

void vpMapPanel::setPath(const std::vector<Eigen::Vector2d> &places)
{
  m_path = places;
  Box all = m_view;
  for (const Eigen::Vector2d &place : places) {
    all.extend(place);
  }
  m_view = m_view.contains(all) ? m_view : widened(all, 0.12 * all.sizes().maxCoeff());
}

void vpMapPanel::setTruth(const std::optional<vpHomogeneousMatrix> &wMb)
{
  m_truth = wMb ? std::make_optional(Eigen::Vector2d((*wMb)[0][3], (*wMb)[1][3])) : std::nullopt;
}

void vpMapPanel::add(const vpVlpLocation &location)
{
  m_seen.clear();
  for (const vpLampObservation &lamp : location.observations) {
    if (const auto found = m_lampOf.find(lamp.id); found != m_lampOf.end()) {
      bool &counts = m_seen[found->second];
      counts = counts || lamp.accepted;
    }
  }

  const bool connected = m_pose.has_value() && location.tracked;
  m_pose.reset();
  m_other.reset();
  const auto poseOf = [&location](const vpHomogeneousMatrix &wMb) {
    return Pose{{wMb[0][3], wMb[1][3]},
                vpRollPitchYaw(wMb).z(),
                location.fix.covariance.topLeftCorner<2, 2>(),
                vpStateOf(location)};
  };
  if (location.fix.valid) {
    const Pose pose = poseOf(location.fix.wMb), other = poseOf(location.fix.other);
    if (isNear(pose.place) && std::isfinite(pose.yaw)) {
      m_pose = pose;
      m_trail.push_back({pose.place, pose.state, connected});
    }
    if (location.fix.ambiguous && isNear(other.place) && std::isfinite(other.yaw)) {
      m_other = other;
    }
  }
  while (m_trail.size() > longestTrail) {
    m_trail.pop_front();
  }
  follow();
}

//! Keeps in view what has to be seen.
void vpMapPanel::follow()
{
  if (!m_pose) {
    return;
  }
  Box needed = m_reach > 0 ? widened(Box(m_pose->place), 0.4 * m_reach) : m_extent;
  needed.extend(m_pose->place);
  for (const auto &[lamp, counts] : m_seen) {
    const Eigen::Vector2d place = m_map.lamps[lamp].position.head<2>();
    if (counts && isNear(place)) {
      needed.extend(place);
    }
  }
  for (const Eigen::Vector2d &place : m_path) {
    needed.extend(place);
  }
  needed = readable(needed);
  const double size = needed.sizes().maxCoeff();
  const Box wanted = widened(needed, std::max(0.12 * size, 0.6 * m_reach));
  constexpr double muchLarger = 2;
  if (!m_view.contains(needed) || m_view.sizes().maxCoeff() > muchLarger * wanted.sizes().maxCoeff()) {
    m_view = wanted;
  }
}

vpMapSheet vpMapPanel::sheet(cv::Size size, double unit) const
{
  return vpMapSheet(m_view, {size.width, size.height - legendRows * legendRow(unit)}, unit);
}

Eigen::Vector2d vpMapPanel::pixel(const Eigen::Vector2d &place, cv::Size size, double unit) const
{
  return sheet(size, unit)(place);
}

cv::Mat vpMapPanel::draw(cv::Size size, double unit) const
{
  cv::Mat panel(std::max(0, size.height), std::max(0, size.width), CV_8UC3, vpMapSheet::ground);
  vpMapSheet map = sheet(size, unit);
  if (map.picture.empty()) {
    return panel;
  }
  map.drawGrid();
  const std::vector<size_t> lamps = shown(map);
  drawLamps(map, lamps);
  drawPath(map);
  drawTrail(map);
  drawRobot(map);
  drawTruth(map);
  drawLabels(map, lamps);
  map.picture.copyTo(panel(cv::Rect(cv::Point(), map.picture.size())));
  drawLegend(panel, map.picture.rows, unit);
  return panel;
}

//! Lamps that the sheet holds: those that count, others that were seen, all others.
std::vector<size_t> vpMapPanel::shown(const vpMapSheet &sheet) const
{
  std::vector<size_t> lamps;
  for (size_t i = 0; i < m_map.lamps.size(); ++i) {
    const Eigen::Vector2d place = m_map.lamps[i].position.head<2>();
    if (isNear(place) && sheet.shows(place)) {
      lamps.push_back(i);
    }
  }
  std::stable_sort(lamps.begin(), lamps.end(), [this](size_t a, size_t b) { return rank(a) < rank(b); });
  return lamps;
}

int vpMapPanel::rank(size_t lamp) const
{
  const auto seen = m_seen.find(lamp);
  return seen == m_seen.end() ? 2 : (seen->second ? 0 : 1);
}

void vpMapPanel::drawLamps(vpMapSheet &sheet, const std::vector<size_t> &lamps) const
{
  for (auto lamp = lamps.rbegin(); lamp != lamps.rend(); ++lamp) { // those that count on top
    const std::vector<Eigen::Vector2d> points = outline(m_map.lamps[*lamp], sheet, lamps.size());
    const cv::Scalar &colour = lampColours[static_cast<size_t>(rank(*lamp))];
    sheet.fill(points, 0.45 * colour);
    sheet.drawLine(points, true, colour, 1);
    sheet.avoid(points);
  }
}

void vpMapPanel::drawLabels(vpMapSheet &sheet, const std::vector<size_t> &lamps) const
{
  constexpr size_t longest = 16; // letters
  for (const size_t i : lamps) {
    if (lamps.size() > mostLabels && rank(i) == 2) {
      break; // too dense
    }
    sheet.drawLabel(m_map.lamps[i].id.substr(0, longest), outline(m_map.lamps[i], sheet, lamps.size()),
                    rank(i) == 2 ? vpVlpColours::grey : vpVlpColours::white);
  }
}

void vpMapPanel::drawPath(vpMapSheet &sheet) const
{
  if (!m_path.empty()) {
    sheet.drawLine(m_path, false, vpVlpColours::grey, 1);
  }
}

void vpMapPanel::drawTruth(vpMapSheet &sheet) const
{
  if (!m_truth) {
    return;
  }
  const double arm = 12 * sheet.unit() / sheet.scale(); // m
  for (const Eigen::Vector2d &way : {Eigen::Vector2d(arm, 0), Eigen::Vector2d(0, arm)}) {
    sheet.drawLine({*m_truth - way, *m_truth + way}, false, vpVlpColours::white, 1);
  }
}

void vpMapPanel::drawTrail(vpMapSheet &sheet) const
{
  for (size_t i = 0; i < m_trail.size(); ++i) {
    const Step &step = m_trail[i];
    const cv::Scalar colour = 0.75 * vpVlpColours::ofState(step.state);
    const std::vector<Eigen::Vector2d> dot = circle(step.place, 1.5 * sheet.unit() / sheet.scale(), 12);
    if (i > 0 && step.joined) {
      sheet.drawLine({m_trail[i - 1].place, step.place}, false, colour, 1.5);
    } else {
      sheet.fill(dot, colour);
    }
    sheet.avoid(dot);
  }
}

void vpMapPanel::drawRobot(vpMapSheet &sheet) const
{
  const double px = sheet.unit() / sheet.scale(); // m
  for (const std::optional<Pose> *pose : {&m_other, &m_pose}) {
    if (!pose->has_value()) {
      continue;
    }
    const Eigen::Vector2d place = (*pose)->place;
    const Eigen::Vector2d ahead(std::cos((*pose)->yaw), std::sin((*pose)->yaw)), left(-ahead.y(), ahead.x());
    const cv::Scalar colour = vpVlpColours::ofState((*pose)->state);
    const std::vector<Eigen::Vector2d> body = circle(place, 8 * px, 40);
    const std::vector<Eigen::Vector2d> head = {place + 24 * px * ahead,
                                               place + 13 * px * ahead + 5 * px * left,
                                               place + 13 * px * ahead - 5 * px * left};
    sheet.fill(body, vpMapSheet::ground); // the trail ends there
    sheet.drawLine({place + 8 * px * ahead, place + 14 * px * ahead}, false, colour, 1.5);
    sheet.drawLine(body, true, colour, 1.5);
    sheet.avoid(body);
    sheet.avoid(head);
    if (pose == &m_other) { // the less likely one stays hollow
      sheet.drawLine(head, true, colour, 1);
      continue;
    }
    sheet.fill(head, colour);
    sheet.drawLine(ellipse(place, (*pose)->covariance), true, vpVlpColours::white, 1);
    sheet.fill(circle(place, 2 * px, 16), colour);
  }
}
