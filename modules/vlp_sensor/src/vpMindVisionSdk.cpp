/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpMindVisionSdk.h"

#include <cstdlib>

#include <dlfcn.h>

#include <visp3/core/vpException.h>

BEGIN_VISP_NAMESPACE

template <class Function>
void vpMindVisionSdk::find(Function *&function, const char *name)
{
  function = reinterpret_cast<Function *>(dlsym(m_library, name));
  if (function == nullptr) {
    dlclose(m_library);
    throw vpException(vpException::ioError,
                      std::string("MindVision's SDK has no ") + name + ", expected one of 2.1 or later");
  }
}

vpMindVisionSdk::vpMindVisionSdk()
{
  const char *const own = std::getenv("VLP_MVSDK_LIBRARY");
  const std::string name = own != nullptr ? own : "libMVSDK.so";
  m_library = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (m_library == nullptr) {
    throw vpException(vpException::ioError,
                      name + ": cannot be loaded, expected MindVision's SDK for Linux, which its maker "
                             "gives away (VLP_MVSDK_LIBRARY names another file)");
  }
  find(SdkInit, "CameraSdkInit");
  find(EnumerateDevice, "CameraEnumerateDevice");
  find(Init, "CameraInit");
  find(UnInit, "CameraUnInit");
  find(Play, "CameraPlay");
  find(SetAeState, "CameraSetAeState");
  find(SetAnalogGain, "CameraSetAnalogGain");
  find(GetAnalogGain, "CameraGetAnalogGain");
  find(SetExposureTime, "CameraSetExposureTime");
  find(GetExposureTime, "CameraGetExposureTime");
  find(SetMonochrome, "CameraSetMonochrome");
  find(SetFrameSpeed, "CameraSetFrameSpeed");
  find(SetImageResolution, "CameraSetImageResolution");
  find(GetImageResolution, "CameraGetImageResolution");
  find(SetIspOutFormat, "CameraSetIspOutFormat");
  find(GetImageBuffer, "CameraGetImageBuffer");
  find(ImageProcess, "CameraImageProcess");
  find(ReleaseImageBuffer, "CameraReleaseImageBuffer");
}

vpMindVisionSdk::~vpMindVisionSdk()
{
  dlclose(m_library);
}

END_VISP_NAMESPACE
