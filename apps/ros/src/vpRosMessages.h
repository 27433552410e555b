/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpRosMessages_h
#define vpRosMessages_h

/*!
  \file vpRosMessages.h
  Between the structs of the modules and the messages of ROS. Whatever comes from the network is checked here:
  each function that reads a message throws vpException with one line that names the field.
*/

#include <vector>

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/Transform.h>
#include <nav_msgs/Odometry.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <visp3/vlp_core/vpLampObservation.h>
#include <visp3/vlp_core/vpVlpFrame.h>
#include <visp3/vlp_core/vpVlpRig.h>
#include <visp3/vlp_localization/vpVlpFix.h>
#include <visp3/vlp_robot/vpOdometry.h>
#include <visp_vlp/LampObservations.h>
#include <visp_vlp/RollingShutter.h>

namespace vpRosMessages
{
//! A mono8 picture, its stamp the start of exposure of its first line.
sensor_msgs::Image image(const vpVlpFrame &frame, const std::string &frameId);
//! Of encodings mono8, bgr8, rgb8, bgra8 and rgba8. \throw vpException (badValue) for any other, and where
//! the data are not as long as size and step say.
vpVlpFrame frame(const sensor_msgs::Image &image);

//! Distortion as plumb_bob; of the picture as delivered.
sensor_msgs::CameraInfo cameraInfo(const vpVlpRig &rig);
visp_vlp::RollingShutter rollingShutter(const vpRollingShutter &shutter);

visp_vlp::LampObservation lamp(const vpLampObservation &seen);
//! \throw vpException (badValue) where a number that the pose rests on is not finite.
vpLampObservation observation(const visp_vlp::LampObservation &lamp);
std::vector<vpLampObservation> observations(const visp_vlp::LampObservations &lamps);

geometry_msgs::Transform transform(const vpHomogeneousMatrix &M);
geometry_msgs::Pose pose(const vpHomogeneousMatrix &M);
//! \throw vpException (badValue) where it is not finite, or its quaternion has no length.
vpHomogeneousMatrix matrix(const geometry_msgs::Pose &pose);
//! wMb in \e frameId with the fix's covariance: x, y, z and rotations about the fixed axes, as ROS has it.
geometry_msgs::PoseWithCovarianceStamped location(const vpVlpFix &fix, double timestamp,
                                                  const std::string &frameId);

//! \throw vpException (badValue) where time or velocity is not finite.
vpOdometry odometry(const nav_msgs::Odometry &odom);
} // namespace vpRosMessages

#endif
