/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpTextBlock_h
#define vpTextBlock_h

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! Numbers and words as std::printf writes them, up to 200 letters.
template <typename... Values>
std::string vpFormat(const char *format, Values... values)
{
  std::array<char, 200> buffer{};
  std::snprintf(buffer.data(), buffer.size(), format, values...);
  return buffer.data();
}

//! To 1/steps; no -0.
inline double vpRounded(double value, double steps)
{
  return std::round(value * steps) / steps + 0.0;
}

//! One line of text, its letters on \e baseLeft. \param unit Its size; 1 suits a picture of 800 pixels.
void vpDrawText(cv::Mat &picture, const std::string &text, const cv::Point &baseLeft, double unit,
                const cv::Scalar &colour);

//! Of that, without what hangs below the letters' base.
cv::Size vpTextSize(const std::string &text, double unit);

//! px, of its strokes.
int vpTextThickness(double unit);

//! \e text in lines of no more letters than \e columns, cut between words where there are blanks.
std::vector<std::string> vpWrapped(const std::string &text, size_t columns);

//! A heading and a few lines of text on a dark ground, to be drawn into a colour picture.
class vpTextBlock
{
public:
  /*!
    \param heading Drawn larger; may be empty. \param lines Wrapped where they are longer than \e columns.
    \param unit Size of what is drawn: 1 suits a picture of 800 pixels.
  */
  vpTextBlock(const std::string &heading, const std::vector<std::string> &lines, const cv::Scalar &colour,
              double unit, size_t columns = 26);

  cv::Size size() const { return m_size; }
  const cv::Scalar &colour() const { return m_colour; }

  void draw(cv::Mat &picture, const cv::Point &topLeft) const;

private:
  struct Line {
    std::string text;
    double scale; // of the font
    int thickness;
    int base; // px from the top of the block to where the letters stand
  };

  std::vector<Line> m_lines;
  cv::Scalar m_colour;
  int m_margin;
  cv::Size m_size;
};

//! Finds room for text blocks beside what must stay visible.
class vpTextLayout
{
public:
  explicit vpTextLayout(cv::Size picture) : m_picture(picture) {}

  //! Text shall rather not cover \e box from now on.
  void avoid(const cv::Rect &box) { m_taken.push_back(box & cv::Rect(cv::Point(), m_picture)); }

  //! A free place near \e box, inside the picture: \e gap pixels beside it, away from \e crowd, where there
  //! is room.
  cv::Rect beside(const cv::Rect &box, cv::Size text, int gap, const cv::Point2d &crowd) const;

  //! How much \e text would cover: the sum over what to avoid of the share that it hides, or of its own share
  //! where that is larger. 0: nothing.
  double covered(const cv::Rect &text) const;

private:
  cv::Rect inside(const cv::Point &topLeft, cv::Size text) const;

  cv::Size m_picture;
  std::vector<cv::Rect> m_taken;
};

END_VISP_NAMESPACE

#endif
