/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpMindVisionSdk_h
#define vpMindVisionSdk_h

#include <memory>
#include <string>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  What we use of MindVision's SDK, which is neither free nor in Debian: loaded at run time where the user
  installed it (libMVSDK.so, or the file that the environment's VLP_MVSDK_LIBRARY names). Layouts and numbers
  are those of its published interface, CameraApi.h and CameraDefine.h; its functions return 0, or an error.
*/
class vpMindVisionSdk
{
public:
  struct Device { // tSdkCameraDevInfo
    char series[32];
    char product[32];
    char friendlyName[32];
    char link[32];
    char driver[32];
    char sensor[32];
    char port[32];
    char serial[32];
    unsigned int instance;
  };
  struct Resolution { // tSdkImageResolution
    int index;        // custom: a region of the sensor
    char description[32];
    unsigned int binSum, binAverage, skip, resample;
    int left, top, fieldWidth, fieldHeight; // of the sensor, pixels
    int width, height;                      // of the picture, pixels
    int widthZoomHardware, heightZoomHardware, widthZoomSoftware, heightZoomSoftware;
  };
  struct FrameHead { // tSdkFrameHead, its first members; the rest is not ours
    unsigned int mediaType;
    unsigned int bytes;
    int width, height; // pixels
    int widthZoom, heightZoom;
    int triggered;
    unsigned int time;     // 0.1 ms, of the camera's clock
    unsigned int exposure; // us
    unsigned char rest[256];
  };

  static constexpr int custom = 0xff;               // of Resolution::index
  static constexpr unsigned int mono8 = 0x01080001; // CAMERA_MEDIA_TYPE_MONO8
  static constexpr int timeOut = -12;               // CAMERA_STATUS_TIME_OUT

  //! \throw vpException (ioError) where the library or one of its functions is missing.
  vpMindVisionSdk();
  ~vpMindVisionSdk();
  vpMindVisionSdk(const vpMindVisionSdk &) = delete;
  vpMindVisionSdk &operator=(const vpMindVisionSdk &) = delete;

  // Each is CameraX of the SDK.
  int (*SdkInit)(int language) = nullptr;
  int (*EnumerateDevice)(Device *devices, int *count) = nullptr;
  int (*Init)(Device *device, int loadMode, int team, int *camera) = nullptr;
  int (*UnInit)(int camera) = nullptr;
  int (*Play)(int camera) = nullptr;
  int (*SetAeState)(int camera, int on) = nullptr;
  int (*SetAnalogGain)(int camera, int gain) = nullptr;
  int (*GetAnalogGain)(int camera, int *gain) = nullptr;
  int (*SetExposureTime)(int camera, double microseconds) = nullptr;
  int (*GetExposureTime)(int camera, double *microseconds) = nullptr;
  int (*SetMonochrome)(int camera, int on) = nullptr;
  int (*SetFrameSpeed)(int camera, int speed) = nullptr;
  int (*SetImageResolution)(int camera, Resolution *resolution) = nullptr;
  int (*GetImageResolution)(int camera, Resolution *resolution) = nullptr;
  int (*SetIspOutFormat)(int camera, unsigned int format) = nullptr;
  int (*GetImageBuffer)(int camera, FrameHead *head, unsigned char **data,
                        unsigned int milliseconds) = nullptr;
  int (*ImageProcess)(int camera, unsigned char *raw, unsigned char *out, FrameHead *head) = nullptr;
  int (*ReleaseImageBuffer)(int camera, unsigned char *data) = nullptr;

private:
  template <class Function>
  void find(Function *&function, const char *name);

  void *m_library = nullptr;
};

END_VISP_NAMESPACE

#endif
