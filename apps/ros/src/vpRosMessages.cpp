/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpRosMessages.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>
#include <sensor_msgs/image_encodings.h>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

namespace
{
[[noreturn]] void fail(const std::string &problem)
{
  throw vpException(vpException::badValue, problem);
}

double finite(double value, const char *field)
{
  if (!std::isfinite(value)) {
    fail(std::string(field) + ": " + vpNumberText(value) + ", expected a finite number");
  }
  return value;
}

ros::Time stamp(double time)
{
  return ros::Time().fromSec(time);
}

//! What takes an encoding's bytes to grey: bytes of a pixel, and OpenCV's conversion, -1 for none.
struct Encoding {
  unsigned int bytes;
  int toGrey;
};

const std::map<std::string, Encoding> encodings = {
    {sensor_msgs::image_encodings::MONO8, {1, -1}},
    {sensor_msgs::image_encodings::BGR8, {3, cv::COLOR_BGR2GRAY}},
    {sensor_msgs::image_encodings::RGB8, {3, cv::COLOR_RGB2GRAY}},
    {sensor_msgs::image_encodings::BGRA8, {4, cv::COLOR_BGRA2GRAY}},
    {sensor_msgs::image_encodings::RGBA8, {4, cv::COLOR_RGBA2GRAY}}};
} // namespace

namespace vpRosMessages
{
sensor_msgs::Image image(const vpVlpFrame &frame, const std::string &frameId)
{
  sensor_msgs::Image image;
  image.header.stamp = stamp(frame.timestamp);
  image.header.frame_id = frameId;
  image.width = frame.I.getWidth();
  image.height = frame.I.getHeight();
  image.encoding = sensor_msgs::image_encodings::MONO8;
  image.step = image.width;
  image.data.assign(frame.I.bitmap, frame.I.bitmap + frame.I.getSize());
  return image;
}

vpVlpFrame frame(const sensor_msgs::Image &image)
{
  const auto encoding = encodings.find(image.encoding);
  if (encoding == encodings.end()) {
    fail("image.encoding: '" + image.encoding + "', expected mono8, bgr8, rgb8, bgra8 or rgba8");
  }
  const std::uint64_t line = std::uint64_t{image.width} * encoding->second.bytes;
  if (image.width == 0 || image.height == 0 || image.step < line ||
      image.data.size() != std::uint64_t{image.step} * image.height) {
    fail("image.data: " + std::to_string(image.data.size()) + " bytes in steps of " +
         std::to_string(image.step) + ", expected a picture of " + std::to_string(image.width) + " x " +
         std::to_string(image.height) + " " + image.encoding);
  }
  vpVlpFrame frame;
  frame.timestamp = image.header.stamp.toSec();
  frame.name = "image " + std::to_string(image.header.seq);
  frame.I.resize(image.height, image.width);
  const int rows = static_cast<int>(image.height), columns = static_cast<int>(image.width);
  cv::Mat grey(rows, columns, CV_8UC1, frame.I.bitmap);
  // OpenCV reads it only.
  const cv::Mat bytes(rows, columns, CV_8UC(static_cast<int>(encoding->second.bytes)),
                      const_cast<unsigned char *>(image.data.data()), image.step);
  if (encoding->second.toGrey < 0) {
    bytes.copyTo(grey);
  } else {
    cv::cvtColor(bytes, grey, encoding->second.toGrey);
  }
  return frame;
}

sensor_msgs::CameraInfo cameraInfo(const vpVlpRig &rig)
{
  const vpCameraParameters &camera = rig.camera;
  sensor_msgs::CameraInfo info;
  info.width = rig.width;
  info.height = rig.height;
  info.distortion_model = "plumb_bob";
  // ViSP's kdu takes a distorted point to the ideal one, ROS' k1 the other way, which is ViSP's kud.
  info.D = {camera.get_kud(), 0, 0, 0, 0};
  info.K = {camera.get_px(), 0, camera.get_u0(), 0, camera.get_py(), camera.get_v0(), 0, 0, 1};
  info.R = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  info.P = {camera.get_px(), 0, camera.get_u0(), 0, 0, camera.get_py(), camera.get_v0(), 0, 0, 0, 1, 0};
  return info;
}

visp_vlp::RollingShutter rollingShutter(const vpRollingShutter &shutter)
{
  static const char *const readouts[] = {"rows", "rows_reversed", "columns", "columns_reversed"};
  visp_vlp::RollingShutter message;
  message.row_time = shutter.rowTime;
  message.row_time_sigma = shutter.rowTimeSigma;
  message.exposure = shutter.exposure;
  message.exposure_sigma = shutter.exposureSigma;
  message.readout = readouts[static_cast<int>(shutter.readout)];
  return message;
}

visp_vlp::LampObservation lamp(const vpLampObservation &seen)
{
  visp_vlp::LampObservation lamp;
  lamp.id = seen.id;
  lamp.confidence = seen.confidence;
  lamp.track = seen.track;
  lamp.u = seen.point.x();
  lamp.v = seen.point.y();
  lamp.time = seen.time;
  lamp.cut = seen.cut;
  lamp.shape = static_cast<std::uint8_t>(seen.outline.shape);
  lamp.centre = {seen.outline.centre.x(), seen.outline.centre.y()};
  lamp.a = seen.outline.a;
  lamp.b = seen.outline.b;
  lamp.angle = seen.outline.angle;
  for (size_t i = 0; i < 4; ++i) {
    lamp.corners[2 * i] = seen.outline.corners[i].x();
    lamp.corners[2 * i + 1] = seen.outline.corners[i].y();
    lamp.covariance[i] = seen.covariance(static_cast<int>(i) / 2, static_cast<int>(i) % 2);
    lamp.centre_covariance[i] =
        seen.outline.centreCovariance(static_cast<int>(i) / 2, static_cast<int>(i) % 2);
  }
  lamp.residual = seen.outline.residual;
  lamp.other_shape = seen.outline.otherShape;
  lamp.frequency = seen.features.frequency;
  lamp.duty = seen.features.duty;
  return lamp;
}

vpLampObservation observation(const visp_vlp::LampObservation &lamp)
{
  if (lamp.shape > visp_vlp::LampObservation::QUADRILATERAL) {
    fail("lamp.shape: " + std::to_string(lamp.shape) + ", expected 0, 1 or 2");
  }
  vpLampObservation seen;
  seen.id = lamp.id;
  seen.confidence = finite(lamp.confidence, "lamp.confidence");
  seen.track = lamp.track;
  seen.point = {finite(lamp.u, "lamp.u"), finite(lamp.v, "lamp.v")};
  seen.time = finite(lamp.time, "lamp.time");
  seen.cut = lamp.cut;
  seen.outline.shape = static_cast<vpLampOutline::Shape>(lamp.shape);
  seen.outline.centre = {finite(lamp.centre[0], "lamp.centre"), finite(lamp.centre[1], "lamp.centre")};
  seen.outline.a = finite(lamp.a, "lamp.a");
  seen.outline.b = finite(lamp.b, "lamp.b");
  seen.outline.angle = finite(lamp.angle, "lamp.angle");
  for (size_t i = 0; i < 4; ++i) {
    const int row = static_cast<int>(i) / 2, column = static_cast<int>(i) % 2;
    seen.outline.corners[i] = {finite(lamp.corners[2 * i], "lamp.corners"),
                               finite(lamp.corners[2 * i + 1], "lamp.corners")};
    seen.covariance(row, column) = finite(lamp.covariance[i], "lamp.covariance");
    seen.outline.centreCovariance(row, column) = finite(lamp.centre_covariance[i], "lamp.centre_covariance");
  }
  if (!(seen.covariance.determinant() > 0 && seen.covariance(0, 0) > 0 &&
        seen.covariance.isApprox(seen.covariance.transpose()))) {
    fail("lamp.covariance: expected a symmetric matrix whose eigenvalues are above 0");
  }
  seen.outline.residual = finite(lamp.residual, "lamp.residual");
  seen.outline.otherShape = finite(lamp.other_shape, "lamp.other_shape");
  seen.features.frequency = lamp.frequency;
  seen.features.duty = lamp.duty;
  return seen;
}

std::vector<vpLampObservation> observations(const visp_vlp::LampObservations &lamps)
{
  std::vector<vpLampObservation> all;
  all.reserve(lamps.lamps.size());
  for (const visp_vlp::LampObservation &each : lamps.lamps) {
    all.push_back(observation(each));
  }
  return all;
}

geometry_msgs::Pose pose(const vpHomogeneousMatrix &M)
{
  Eigen::Matrix3d R;
  for (int i = 0; i < 9; ++i) {
    R(i / 3, i % 3) = M[i / 3][i % 3];
  }
  const Eigen::Quaterniond q(R);
  geometry_msgs::Pose pose;
  pose.position.x = M[0][3];
  pose.position.y = M[1][3];
  pose.position.z = M[2][3];
  pose.orientation.x = q.x();
  pose.orientation.y = q.y();
  pose.orientation.z = q.z();
  pose.orientation.w = q.w();
  return pose;
}

geometry_msgs::Transform transform(const vpHomogeneousMatrix &M)
{
  const geometry_msgs::Pose same = pose(M);
  geometry_msgs::Transform transform;
  transform.translation.x = same.position.x;
  transform.translation.y = same.position.y;
  transform.translation.z = same.position.z;
  transform.rotation = same.orientation;
  return transform;
}

vpHomogeneousMatrix matrix(const geometry_msgs::Pose &pose)
{
  const geometry_msgs::Quaternion &o = pose.orientation;
  Eigen::Quaterniond q(o.w, o.x, o.y, o.z);
  if (!(q.norm() > 0.5)) { // NaN, too
    fail("pose.orientation: expected a quaternion of length 1");
  }
  const Eigen::Matrix3d R = q.normalized().toRotationMatrix();
  vpHomogeneousMatrix M;
  for (int i = 0; i < 9; ++i) {
    M[i / 3][i % 3] = finite(R(i / 3, i % 3), "pose.orientation");
  }
  M[0][3] = finite(pose.position.x, "pose.position.x");
  M[1][3] = finite(pose.position.y, "pose.position.y");
  M[2][3] = finite(pose.position.z, "pose.position.z");
  return M;
}

geometry_msgs::PoseWithCovarianceStamped location(const vpVlpFix &fix, double timestamp,
                                                  const std::string &frameId)
{
  geometry_msgs::PoseWithCovarianceStamped message;
  message.header.stamp = stamp(timestamp);
  message.header.frame_id = frameId;
  message.pose.pose = pose(fix.wMb);
  for (int i = 0; i < 36; ++i) {
    message.pose.covariance[static_cast<size_t>(i)] = fix.covariance(i / 6, i % 6);
  }
  return message;
}

vpOdometry odometry(const nav_msgs::Odometry &odom)
{
  vpOdometry sample;
  sample.timestamp = odom.header.stamp.toSec();
  sample.v = finite(odom.twist.twist.linear.x, "odom.twist.twist.linear.x");
  sample.w = finite(odom.twist.twist.angular.z, "odom.twist.twist.angular.z");
  return sample;
}
} // namespace vpRosMessages
