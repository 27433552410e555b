/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_sensor/vpResizedSource.h>

#include <utility>

#include <opencv2/imgproc.hpp>

BEGIN_VISP_NAMESPACE

vpResizedSource::vpResizedSource(std::unique_ptr<vpFrameSource> source, const vpVlpRig &rig)
    : m_source(std::move(source)), m_resize(rig.resize), m_width(rig.width), m_height(rig.height)
{
}

bool vpResizedSource::next(vpVlpFrame &frame)
{
  if (!m_source->next(m_taken)) {
    return false;
  }
  const vpImage<unsigned char> &from = m_taken.I;
  if (m_resize.method == vpPictureResize::Method::none || from.getWidth() != m_resize.sourceWidth ||
      from.getHeight() != m_resize.sourceHeight) {
    swap(frame.I, m_taken.I); // in ViSP 3.5 std::swap would leave both pictures without an owner
    std::swap(frame.I.display, m_taken.I.display); // stays
    frame.timestamp = m_taken.timestamp;
    frame.name = m_taken.name;
    return true;
  }
  frame.I.resize(m_height, m_width);
  const cv::Mat source(static_cast<int>(from.getHeight()), static_cast<int>(from.getWidth()), CV_8UC1,
                       from.bitmap);
  cv::Mat target(static_cast<int>(m_height), static_cast<int>(m_width), CV_8UC1, frame.I.bitmap);
  cv::resize(source, target, target.size(), 0, 0,
             m_resize.method == vpPictureResize::Method::nearest ? cv::INTER_NEAREST : cv::INTER_AREA);
  frame.timestamp = m_taken.timestamp;
  frame.name = m_taken.name;
  return true;
}

END_VISP_NAMESPACE
