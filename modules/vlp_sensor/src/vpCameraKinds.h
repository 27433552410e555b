/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpCameraKinds_h
#define vpCameraKinds_h

#include <memory>
#include <string>
#include <vector>

#include <visp3/vlp_sensor/vpCameraSource.h>

BEGIN_VISP_NAMESPACE

/*!
  A kind of camera. Each is a file of its own; where its library is missing, CMake leaves that file out and
  takes the one beside it that says so.
*/
struct vpCameraKind {
  std::string scheme;  // of its URI, as "aravis"
  std::string library; // what this build would need; empty: the kind is built
  //! \e address: what follows "scheme://".
  std::unique_ptr<vpCameraDriver> (*open)(const std::string &address, const vpCameraSettings &) = nullptr;
  //! \throw vpException with one line where the machine lacks what it takes to look.
  std::vector<vpCameraDescription> (*list)() = nullptr;
};

vpCameraKind vpAravisKind();
vpCameraKind vpV4l2Kind();
vpCameraKind vpUvcKind();
vpCameraKind vpMindVisionKind();

END_VISP_NAMESPACE

#endif
