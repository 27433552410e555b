/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "common/vpMapSheet.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>
#include <visp3/vlp_core/vpRoundStep.h>

#include "common/vpTextBlock.h"

BEGIN_VISP_NAMESPACE

namespace
{
const cv::Scalar paper(44, 38, 34), gridColour(74, 66, 60), axisColour(110, 98, 90);
constexpr int subPixel = 4;         // bits that OpenCV's drawing takes as the fraction of a coordinate
constexpr double farthest = 100000; // px; OpenCV's drawing overflows at a multiple of it

std::string metres(double value, double step)
{
  const int digits = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  return vpFormat("%.*f", digits, std::round(value / step) * step + 0.0);
}
} // namespace

const cv::Scalar vpMapSheet::ground(28, 24, 22), vpMapSheet::textColour(190, 184, 180);

vpMapSheet::vpMapSheet(const Eigen::AlignedBox2d &view, cv::Size size, double unit)
    : m_view(view), m_unit(unit)
{
  int widest =
      vpTextSize("y, m", textUnit * unit).width; // of the numbers on the left, a little beyond the view, too
  for (const double share : {-1.0, 0.0, 1.0, 2.0}) {
    const double y = view.min().y() + share * view.sizes().y();
    widest = std::max(widest, vpTextSize(metres(y, step()), textUnit * unit).width);
  }
  const int letters = vpTextSize("0", textUnit * unit).height, gap = cvRound(5 * unit);
  const int left = widest + 2 * gap, top = letters + 2 * gap, below = letters + 2 * gap, right = 2 * gap;
  m_area = cv::Rect(left, top, size.width - left - right, size.height - top - below);
  const int least = cvRound(20 * unit);
  if (m_area.width < least || m_area.height < least) {
    m_area = cv::Rect();
    return;
  }
  picture = cv::Mat(size, CV_8UC3, ground);
  m_scale = std::min(m_area.width / view.sizes().x(), m_area.height / view.sizes().y());
}

Eigen::Vector2d vpMapSheet::operator()(const Eigen::Vector2d &place) const
{
  const Eigen::Vector2d middle(m_area.x + 0.5 * (m_area.width - 1), m_area.y + 0.5 * (m_area.height - 1));
  const Eigen::Vector2d from = m_scale * (place - m_view.center());
  return middle + Eigen::Vector2d(from.x(), -from.y());
}

bool vpMapSheet::shows(const Eigen::Vector2d &place) const
{
  const Eigen::Vector2d at = (*this)(place);
  return at.x() >= m_area.x && at.y() >= m_area.y && at.x() < m_area.br().x && at.y() < m_area.br().y;
}

//! m, between lines of the grid.
double vpMapSheet::step() const
{
  return vpRoundStep(m_view.sizes().maxCoeff() / 8);
}

void vpMapSheet::drawGrid()
{
  cv::rectangle(picture, m_area, paper, cv::FILLED);
  const double every = step();
  const Eigen::Vector2d half = 0.5 / m_scale * Eigen::Vector2d(m_area.width - 1, m_area.height - 1);
  const Eigen::Vector2d low = m_view.center() - half, high = m_view.center() + half;
  const int gap = cvRound(5 * m_unit);
  const cv::Size axis = vpTextSize("x, m", textUnit * m_unit);
  const cv::Point xName(m_area.br().x - axis.width, m_area.br().y + gap + axis.height);
  const auto widthOf = [&](double x) { return vpTextSize(metres(x, every), textUnit * m_unit).width; };
  const double room = std::max(widthOf(low.x()), widthOf(high.x())) + 2 * gap; // px, of a number
  const double stride = std::ceil(room / (every * m_scale));                   // lines
  for (double i = std::ceil(low.x() / every); i * every <= high.x(); ++i) {
    const int u = cvRound((*this)({i * every, 0}).x());
    cv::line(picture, {u, m_area.y}, {u, m_area.br().y - 1}, i == 0 ? axisColour : gridColour);
    const std::string text = metres(i * every, every);
    const cv::Size size = vpTextSize(text, textUnit * m_unit);
    if (std::fmod(i, stride) == 0 && u + size.width / 2 + gap < xName.x) {
      vpDrawText(picture, text, {u - size.width / 2, m_area.br().y + gap + size.height}, textUnit * m_unit,
                 textColour);
    }
  }
  for (double i = std::ceil(low.y() / every); i * every <= high.y(); ++i) {
    const int v = cvRound((*this)({0, i * every}).y());
    cv::line(picture, {m_area.x, v}, {m_area.br().x - 1, v}, i == 0 ? axisColour : gridColour);
    const std::string text = metres(i * every, every);
    const cv::Size size = vpTextSize(text, textUnit * m_unit);
    vpDrawText(picture, text, {m_area.x - gap - size.width, v + size.height / 2}, textUnit * m_unit,
               textColour);
  }
  cv::rectangle(picture, m_area, axisColour, 1);
  vpDrawText(picture, "x, m", xName, textUnit * m_unit, textColour);
  vpDrawText(picture, "y, m", {gap, m_area.y - gap}, textUnit * m_unit, textColour);
}

std::vector<cv::Point> vpMapSheet::fixed(const std::vector<Eigen::Vector2d> &places) const
{
  std::vector<cv::Point> points;
  for (const Eigen::Vector2d &place : places) {
    const Eigen::Vector2d at = (*this)(place)-Eigen::Vector2d(m_area.x, m_area.y);
    if (!at.allFinite() || at.cwiseAbs().maxCoeff() > farthest) {
      return {};
    }
    points.emplace_back(cvRound(at.x() * (1 << subPixel)), cvRound(at.y() * (1 << subPixel)));
  }
  return points;
}

void vpMapSheet::drawLine(const std::vector<Eigen::Vector2d> &places, bool closed, const cv::Scalar &colour,
                          double thickness)
{
  if (const std::vector<cv::Point> points = fixed(places); !points.empty()) {
    cv::Mat grid = picture(m_area);
    cv::polylines(grid, points, closed, colour, std::max(1, cvRound(thickness * m_unit)), cv::LINE_AA,
                  subPixel);
  }
}

void vpMapSheet::fill(const std::vector<Eigen::Vector2d> &places, const cv::Scalar &colour)
{
  if (const std::vector<cv::Point> points = fixed(places); !points.empty()) {
    cv::Mat grid = picture(m_area);
    cv::fillConvexPoly(grid, points, colour, cv::LINE_AA, subPixel);
  }
}

//! In the picture, px.
cv::Rect vpMapSheet::box(const std::vector<Eigen::Vector2d> &places) const
{
  std::vector<cv::Point> points = fixed(places);
  for (cv::Point &point : points) {
    point = cv::Point(point.x >> subPixel, point.y >> subPixel) + m_area.tl();
  }
  return points.empty() ? cv::Rect() : cv::boundingRect(points);
}

void vpMapSheet::avoid(const std::vector<Eigen::Vector2d> &places)
{
  m_taken.push_back(box(places));
}

void vpMapSheet::drawLabel(const std::string &text, const std::vector<Eigen::Vector2d> &places,
                           const cv::Scalar &colour)
{
  const cv::Rect of = box(places);
  const cv::Size size = vpTextSize(text, textUnit * m_unit);
  const int gap = cvRound(4 * m_unit);
  const int x = of.x + (of.width - size.width) / 2, y = of.y + (of.height - size.height) / 2;
  for (const cv::Point &topLeft : {cv::Point(of.br().x + gap, y), cv::Point(of.x - gap - size.width, y),
                                   cv::Point(x, of.br().y + gap), cv::Point(x, of.y - gap - size.height)}) {
    const cv::Rect place(topLeft, size);
    const bool free = (place & m_area) == place &&
                      std::none_of(m_taken.begin(), m_taken.end(),
                                   [&place](const cv::Rect &taken) { return !(taken & place).empty(); });
    if (!of.empty() && free) {
      vpDrawText(picture, text, {place.x, place.br().y}, textUnit * m_unit, colour);
      m_taken.push_back(place);
      return;
    }
  }
}

END_VISP_NAMESPACE
