/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpV4l2Device_h
#define vpV4l2Device_h

#include <cstddef>
#include <string>

#include <visp3/vlp_sensor/vpCameraSettings.h>

BEGIN_VISP_NAMESPACE

/*!
  What the kernel offers of one video device (Linux' Video for Linux 2), so that what is made of it can be
  tested without one.
*/
class VISP_EXPORT vpV4l2Device
{
public:
  virtual ~vpV4l2Device() = default;

  //! ioctl(2), repeated where a signal interrupts it. \return 0, or errno.
  virtual int control(unsigned long request, void *argument) = 0;
};

/*!
  Exposure, gain and frame rate of a V4L2 camera, which `vpV4l2Grabber` of ViSP 3.5 has no setters for.
  Exposure comes in units of 100 us (V4L2_CID_EXPOSURE_ABSOLUTE), gain in the driver's own
  (V4L2_CID_GAIN, else V4L2_CID_ANALOGUE_GAIN), the frame rate as the time per frame (VIDIOC_S_PARM).
*/
struct VISP_EXPORT vpV4l2Controls {
  //! \throw vpException (badValue) where a value is out of the camera's range, which it names, or there is no
  //! such control; (ioError) where the kernel refuses.
  static void set(vpV4l2Device &device, const vpCameraSettings &settings);

  //! What is in force; left out what the camera has no control for.
  static vpCameraSettings get(vpV4l2Device &device);

  //! What can be set, with its range, as text.
  static std::string abilities(vpV4l2Device &device);
};

END_VISP_NAMESPACE

#endif
