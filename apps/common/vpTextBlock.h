/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpTextBlock_h
#define vpTextBlock_h

#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

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

  //! The freest corner of the picture, the upper left one if that is as good as any.
  cv::Rect corner(cv::Size text, int gap) const;

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
