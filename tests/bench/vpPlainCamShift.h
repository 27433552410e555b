/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPlainCamShift_h
#define vpPlainCamShift_h

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Core>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

/*!
  cv::CamShift as OpenCV's example has it: a histogram of the first window, back projected onto each frame,
  and the window widened where it has shrunk to nothing.
*/
class vpPlainCamShift
{
public:
  double share = 1;   // of the window that the histogram is of, about its middle
  double darkest = 0; // value below which nothing is of the target
  double reach =
      std::numeric_limits<double>::infinity(); // window sizes about the last one that are back projected

  //! \param feature One channel. \param mask Where it counts; empty: everywhere. \param end Of its range.
  void begin(const cv::Mat &feature, const cv::Mat &mask, float end, const cv::Rect &window)
  {
    m_window = window;
    m_range[1] = end;
    const int aside = cvRound(0.5 * (1 - share) * window.width),
              above = cvRound(0.5 * (1 - share) * window.height);
    const cv::Rect middle(window.x + aside, window.y + above, window.width - 2 * aside,
                          window.height - 2 * above);
    const cv::Mat part = feature(middle);
    const float *range = m_range;
    cv::calcHist(&part, 1, &m_channel, mask.empty() ? mask : mask(middle), m_histogram, 1, &m_bins, &range);
    const int dark = static_cast<int>(std::ceil(darkest * m_bins / end));
    m_histogram.rowRange(0, dark) = 0;
    cv::normalize(m_histogram, m_histogram, 0, 255, cv::NORM_MINMAX);
  }

  //! Middle of the target, px.
  Eigen::Vector2d track(const cv::Mat &feature, const cv::Mat &mask)
  {
    const cv::Rect picture(0, 0, feature.cols, feature.rows), part = around(picture);
    const cv::Mat seen = feature(part);
    const float *range = m_range;
    cv::calcBackProject(&seen, 1, &m_channel, m_histogram, m_projection, &range);
    if (!mask.empty()) {
      m_projection &= mask(part);
    }
    cv::Rect window = m_window - part.tl();
    const cv::TermCriteria until(cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 10, 1);
    const cv::RotatedRect found = cv::CamShift(m_projection, window, until);
    m_window = window + part.tl();
    if (m_window.area() <= 1) {
      const int more = (std::min(feature.cols, feature.rows) + 5) / 6;
      m_window = cv::Rect(m_window.x - more, m_window.y - more, 2 * more, 2 * more) & picture;
      if (m_window.area() <= 0) {
        m_window = picture;
      }
      return {m_window.x + 0.5 * (m_window.width - 1), m_window.y + 0.5 * (m_window.height - 1)};
    }
    return {found.center.x + part.x, found.center.y + part.y};
  }

private:
  cv::Rect around(const cv::Rect &picture) const
  {
    if (!std::isfinite(reach)) {
      return picture;
    }
    const int aside = cvRound(reach * m_window.width), above = cvRound(reach * m_window.height);
    return cv::Rect(m_window.x - aside, m_window.y - above, m_window.width + 2 * aside,
                    m_window.height + 2 * above) &
           picture;
  }

  const int m_channel = 0, m_bins = 16;
  float m_range[2] = {0, 256};
  cv::Rect m_window;
  cv::Mat m_histogram, m_projection;
};

#endif
