/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpRosNode_h
#define vpRosNode_h

#include <functional>
#include <string>

#include <ros/ros.h>
#include <visp3/vlp_core/vpVlpRig.h>

/*!
  What main() of a node returns: \e run with ROS initialised. An exception is one fatal line of the log, and
  exit code 2.
*/
int vpRunNode(int argc, char **argv, const std::string &name, const std::function<void()> &run);

//! Handles a message. What is wrong with it is an error line of the log, once a second at most; it is
//! dropped.
void vpHandle(const std::function<void()> &handle);

//! A private parameter that has to be there. \throw vpException (badValue) that names it.
std::string vpRequiredParameter(const ros::NodeHandle &own, const std::string &name,
                                const std::string &expected);

//! The file of the private parameter `rig`. \throw vpException as vpVlpRig::load().
vpVlpRig vpRigParameter(const ros::NodeHandle &own);

#endif
