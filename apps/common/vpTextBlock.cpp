/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "common/vpTextBlock.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

BEGIN_VISP_NAMESPACE

namespace
{
constexpr int font = cv::FONT_HERSHEY_SIMPLEX;
constexpr double fontScale = 0.42; // of a unit

//! The first of the cheapest places.
template <typename Cost>
cv::Rect cheapest(const std::vector<cv::Rect> &places, const Cost &cost)
{
  size_t best = 0;
  double least = cost(places[0]);
  for (size_t i = 1; i < places.size(); ++i) {
    const double here = cost(places[i]);
    if (here < least) {
      least = here;
      best = i;
    }
  }
  return places[best];
}
} // namespace

int vpTextThickness(double unit)
{
  return unit < 1.8 ? 1 : 2;
}

cv::Size vpTextSize(const std::string &text, double unit)
{
  int descent = 0;
  return cv::getTextSize(text, font, fontScale * unit, vpTextThickness(unit), &descent);
}

void vpDrawText(cv::Mat &picture, const std::string &text, const cv::Point &baseLeft, double unit,
                const cv::Scalar &colour)
{
  cv::putText(picture, text, baseLeft, font, fontScale * unit, colour, vpTextThickness(unit), cv::LINE_AA);
}

std::vector<std::string> vpWrapped(const std::string &text, size_t columns)
{
  std::vector<std::string> lines;
  std::string rest = text;
  while (rest.size() > columns) {
    const size_t blank = rest.rfind(' ', columns);
    const bool cut = blank == std::string::npos || blank == 0; // one long word
    lines.push_back(rest.substr(0, cut ? columns : blank));
    rest.erase(0, cut ? columns : blank + 1);
  }
  lines.push_back(rest);
  return lines;
}

vpTextBlock::vpTextBlock(const std::string &heading, const std::vector<std::string> &lines,
                         const cv::Scalar &colour, double unit, size_t columns)
    : m_colour(colour), m_margin(cvRound(4 * unit))
{
  const double scale = fontScale * unit;
  const int thickness = vpTextThickness(unit);
  int width = 0, height = 0;
  const auto add = [&](const std::string &text, double textScale, int textThickness) {
    int descent = 0;
    const cv::Size size = cv::getTextSize(text, font, textScale, textThickness, &descent);
    width = std::max(width, size.width);
    m_lines.push_back({text, textScale, textThickness, height + m_margin / 2 + size.height});
    height = m_lines.back().base + descent;
  };
  if (!heading.empty()) {
    add(heading, 1.5 * scale, thickness + 1);
  }
  for (const std::string &line : lines) {
    for (const std::string &piece : vpWrapped(line, columns)) {
      add(piece, scale, thickness);
    }
  }
  m_size = cv::Size(width + 2 * m_margin, height + m_margin / 2);
}

void vpTextBlock::draw(cv::Mat &picture, const cv::Point &topLeft) const
{
  const cv::Rect ground = cv::Rect(topLeft, m_size) & cv::Rect(cv::Point(), picture.size());
  if (!ground.empty()) {
    picture(ground) *= 0.3; // dims what is below instead of hiding it
  }
  for (const Line &line : m_lines) {
    cv::putText(picture, line.text, topLeft + cv::Point(m_margin, line.base), font, line.scale, m_colour,
                line.thickness, cv::LINE_AA);
  }
}

cv::Rect vpTextLayout::inside(const cv::Point &topLeft, cv::Size text) const
{
  return {std::max(0, std::min(topLeft.x, m_picture.width - text.width)),
          std::max(0, std::min(topLeft.y, m_picture.height - text.height)), text.width, text.height};
}

double vpTextLayout::covered(const cv::Rect &text) const
{
  double sum = 0;
  for (const cv::Rect &box : m_taken) {
    sum += static_cast<double>((box & text).area()) / std::max(1, std::min(box.area(), text.area()));
  }
  return sum;
}

cv::Rect vpTextLayout::beside(const cv::Rect &box, cv::Size text, int gap, const cv::Point2d &crowd) const
{
  std::vector<cv::Rect> places;
  const int left = box.x - gap - text.width, right = box.x + box.width + gap;
  const int above = box.y - gap - text.height, below = box.y + box.height + gap;
  const int x = box.x + (box.width - text.width) / 2, y = box.y + (box.height - text.height) / 2;
  for (const cv::Point &topLeft :
       {cv::Point(right, y), cv::Point(left, y), cv::Point(x, below), cv::Point(x, above)}) {
    places.push_back(inside(topLeft, text));
  }
  const int step = 2 * gap;
  for (int v = gap; v < m_picture.height - text.height; v += step) { // anywhere else, in a crowd
    for (int u = gap; u < m_picture.width - text.width; u += step) {
      places.push_back(inside({u, v}, text));
    }
  }

  const double diagonal = std::hypot(m_picture.width, m_picture.height);
  const auto middle = [](const cv::Rect &rect) { return 0.5 * cv::Point2d(rect.tl() + rect.br()); };
  return cheapest(places, [&](const cv::Rect &place) {
    const int across = std::max({0, place.x - box.br().x, box.x - place.br().x});
    const int along = std::max({0, place.y - box.br().y, box.y - place.br().y});
    // Rather near than wholly free, and rather outwards, where the others do not want to be.
    return 10 * covered(place) +
           (std::hypot(across, along) - 0.3 * cv::norm(middle(place) - crowd)) / diagonal;
  });
}

END_VISP_NAMESPACE
