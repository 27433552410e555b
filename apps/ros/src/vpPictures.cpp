/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpPictures.h"

#include <algorithm>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <visp3/core/vpException.h>

#include "vpRosMessages.h"
#include "vpRosNode.h"

namespace
{
//! Whether image_transport has its plugin for compressed pictures.
bool hasPlugin(const image_transport::ImageTransport &transport)
{
  const std::vector<std::string> all = transport.getLoadableTransports();
  return std::count(all.begin(), all.end(), "image_transport/compressed") > 0;
}
} // namespace

vpVlpFrame vpDecoded(const sensor_msgs::CompressedImage &image)
{
  const cv::Mat grey = image.data.empty() ? cv::Mat() : cv::imdecode(image.data, cv::IMREAD_GRAYSCALE);
  if (grey.empty()) {
    throw vpException(vpException::badValue, "compressed image: " + std::to_string(image.data.size()) +
                                                 " bytes, expected a picture in JPEG or PNG");
  }
  vpVlpFrame frame;
  frame.timestamp = image.header.stamp.toSec();
  frame.name = "image " + std::to_string(image.header.seq);
  frame.I.resize(static_cast<unsigned int>(grey.rows), static_cast<unsigned int>(grey.cols));
  grey.copyTo(cv::Mat(grey.rows, grey.cols, CV_8UC1, frame.I.bitmap));
  return frame;
}

vpPicturePublisher::vpPicturePublisher(ros::NodeHandle &nh, const ros::NodeHandle &own, const vpVlpRig &rig)
    : m_transport(nh), m_pictures(m_transport.advertiseCamera("camera/image", 1)),
      m_info(vpRosMessages::cameraInfo(rig)), m_frameId(own.param<std::string>("frame_id", "camera")),
      m_quality(own.param("jpeg_quality", 0))
{
  if (m_quality < 0 || m_quality > 100) {
    throw vpException(vpException::badValue, own.resolveName("jpeg_quality") + ": " +
                                                 std::to_string(m_quality) +
                                                 ", expected a number from 0 to 100");
  }
  if (!hasPlugin(m_transport)) {
    m_compressed = nh.advertise<sensor_msgs::CompressedImage>("camera/image/compressed", 1);
  }
}

void vpPicturePublisher::publish(const vpVlpFrame &frame)
{
  m_info.header.stamp = ros::Time().fromSec(frame.timestamp);
  m_info.header.frame_id = m_frameId;
  if (m_pictures.getNumSubscribers() > 0) {
    m_pictures.publish(vpRosMessages::image(frame, m_frameId), m_info);
  }
  if (m_compressed && m_compressed.getNumSubscribers() > 0) {
    sensor_msgs::CompressedImage image;
    image.header = m_info.header;
    image.format = m_quality > 0 ? "jpeg" : "png";
    const cv::Mat grey(static_cast<int>(frame.I.getHeight()), static_cast<int>(frame.I.getWidth()), CV_8UC1,
                       frame.I.bitmap);
    // Of a noisy picture no run of bytes comes twice: codes by frequency alone are shorter and sooner found.
    const std::vector<int> jpeg = {cv::IMWRITE_JPEG_QUALITY, m_quality},
                           png = {cv::IMWRITE_PNG_COMPRESSION, 1, cv::IMWRITE_PNG_STRATEGY,
                                  cv::IMWRITE_PNG_STRATEGY_HUFFMAN_ONLY};
    cv::imencode("." + image.format, grey, image.data, m_quality > 0 ? jpeg : png);
    m_compressed.publish(image);
  }
}

vpPictureSubscriber::vpPictureSubscriber(ros::NodeHandle &nh, const ros::NodeHandle &own, const Use &use)
    : m_transport(nh), m_use(use)
{
  const std::string how = own.param<std::string>("image_transport", "raw");
  if (how != "raw" && how != "compressed") {
    throw vpException(vpException::badValue,
                      own.resolveName("image_transport") + ": '" + how + "', expected raw or compressed");
  }
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  if (how == "raw" || hasPlugin(m_transport)) {
    m_pictures = m_transport.subscribe(
        "camera/image", 1,
        [this](const sensor_msgs::ImageConstPtr &image) {
          vpHandle([&] { m_use(vpRosMessages::frame(*image), image->header); });
        },
        ros::VoidPtr(), image_transport::TransportHints(how, hints));
  } else {
    m_compressed = nh.subscribe<sensor_msgs::CompressedImage>(
        "camera/image/compressed", 1,
        [this](const sensor_msgs::CompressedImageConstPtr &image) {
          vpHandle([&] { m_use(vpDecoded(*image), image->header); });
        },
        ros::VoidConstPtr(), hints);
  }
}
