/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpFakeGvCamera_h
#define vpFakeGvCamera_h

#include <algorithm>
#include <atomic>
#include <cstring>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include <arv.h>

#include <visp3/core/vpImage.h>

/*!
  A GigE Vision camera in software, of Aravis: real packets over loopback, of which the pictures are ours. It
  has Aravis' own description: 2048 x 2048 pixels, ExposureTimeAbs, GainRaw, Mono8.
*/
class vpFakeGvCamera
{
public:
  //! The picture of number \e frame at an exposure (s) and a gain; of any size: what is missing is dark.
  using Picture =
      std::function<const vpImage<unsigned char> &(unsigned int frame, double exposure, double gain)>;

  vpFakeGvCamera(const std::string &serial, Picture picture) : m_picture(std::move(picture))
  {
    m_camera = arv_gv_fake_camera_new_full("127.0.0.1", serial.c_str(), nullptr);
    if (m_camera == nullptr || arv_gv_fake_camera_is_running(m_camera) == FALSE) {
      throw std::runtime_error("the camera in software cannot listen on 127.0.0.1");
    }
    arv_fake_camera_set_fill_pattern(arv_gv_fake_camera_get_fake_camera(m_camera), fill, this);
  }
  ~vpFakeGvCamera() { g_object_unref(m_camera); }
  vpFakeGvCamera(const vpFakeGvCamera &) = delete;
  vpFakeGvCamera &operator=(const vpFakeGvCamera &) = delete;

private:
  static void fill(ArvBuffer *buffer, void *self, guint32 exposure, guint32 gain, ArvPixelFormat)
  {
    auto *const camera = static_cast<vpFakeGvCamera *>(self);
    size_t unset = 0; // as yet
    auto *const data = static_cast<unsigned char *>(const_cast<void *>(arv_buffer_get_data(buffer, &unset)));
    const size_t width = camera->reg(ARV_FAKE_CAMERA_REGISTER_WIDTH),
                 height = camera->reg(ARV_FAKE_CAMERA_REGISTER_HEIGHT);
    const vpImage<unsigned char> &picture = camera->m_picture(camera->m_frame++, 1e-6 * exposure, gain);
    std::memset(data, 0, width * height);
    for (size_t v = 0; v < std::min<size_t>(height, picture.getHeight()); ++v) {
      std::memcpy(data + v * width, picture[static_cast<unsigned int>(v)],
                  std::min<size_t>(width, picture.getWidth()));
    }
  }

  guint32 reg(guint32 address) const
  {
    guint32 value = 0;
    arv_fake_camera_read_register(arv_gv_fake_camera_get_fake_camera(m_camera), address, &value);
    return value;
  }

  Picture m_picture;
  std::atomic<ArvGvFakeCamera *> m_camera{nullptr}; // which has a thread
  unsigned int m_frame = 0;                         // in Aravis' thread
};

#endif
