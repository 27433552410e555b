/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Stands in for MindVision's SDK: one grey camera of 64 x 48 pixels that notes in which order it is called.

#include <chrono>
#include <cstdio>
#include <cstring>
#include <thread>

#include "vpMindVisionSdk.h"

using Sdk = vpMindVisionSdk;

namespace
{
double exposure = 1000; // us
int gain = 1, state = 0;
unsigned int frames = 0;
unsigned char raw = 0;
Sdk::Resolution resolution = {0, "", 0, 0, 0, 0, 0, 0, 64, 48, 64, 48, 0, 0, 0, 0};
std::string calls;

int note(const char *name)
{
  calls += (calls.empty() ? "" : " ") + std::string(name);
  return 0;
}
} // namespace

extern "C" {
const char *FakeSdkCalls()
{
  return calls.c_str();
}
void FakeSdkUnplug()
{
  state = -4;
}
int CameraSdkInit(int)
{
  return note("SdkInit");
}
int CameraEnumerateDevice(Sdk::Device *devices, int *count)
{
  *count = 1;
  std::strcpy(devices[0].product, "UB-300");
  std::strcpy(devices[0].serial, "0123");
  return 0;
}
int CameraInit(Sdk::Device *, int, int, int *camera)
{
  *camera = 7;
  return note("Init");
}
int CameraUnInit(int)
{
  return note("UnInit");
}
int CameraPlay(int)
{
  return note("Play");
}
int CameraSetAeState(int, int on)
{
  return note(on != 0 ? "AeOn" : "AeOff");
}
int CameraSetAnalogGain(int, int value)
{
  gain = value;
  return note("AnalogGain");
}
int CameraGetAnalogGain(int, int *value)
{
  *value = gain;
  return 0;
}
int CameraSetExposureTime(int, double value)
{
  exposure = 50 * static_cast<int>(value / 50); // whole lines
  return note("ExposureTime");
}
int CameraGetExposureTime(int, double *value)
{
  *value = exposure;
  return 0;
}
int CameraSetMonochrome(int, int)
{
  return note("Monochrome");
}
int CameraSetFrameSpeed(int, int)
{
  return note("FrameSpeed");
}
int CameraSetImageResolution(int, Sdk::Resolution *value)
{
  resolution = *value;
  return note("ImageResolution");
}
int CameraGetImageResolution(int, Sdk::Resolution *value)
{
  *value = resolution;
  return 0;
}
int CameraSetIspOutFormat(int, unsigned int format)
{
  return note(format == Sdk::mono8 ? "Mono8" : "?");
}
int CameraGetImageBuffer(int, Sdk::FrameHead *head, unsigned char **data, unsigned int milliseconds)
{
  if (state != 0 || milliseconds == 0) {
    return state != 0 ? state : Sdk::timeOut;
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(10));
  head->width = resolution.width;
  head->height = resolution.height;
  head->time = 100 * ++frames; // 10 ms
  *data = &raw;
  return 0;
}
int CameraImageProcess(int, unsigned char *, unsigned char *out, Sdk::FrameHead *head)
{
  std::memset(out, static_cast<int>(exposure / 10), static_cast<size_t>(head->width * head->height));
  return 0;
}
int CameraReleaseImageBuffer(int, unsigned char *)
{
  return 0;
}
}
