/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpEmulatedUvcCamera_h
#define vpEmulatedUvcCamera_h

#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "usb/vpEmulatedUsbDevice.h"

/*!
  A USB Video Class 1.0 camera: 64 x 48 pixels in GRAY8, over a bulk endpoint. Its pictures tell what they
  were taken with: grey levels are the number of the frame in the first line, the exposure in the second, the
  gain in the third, 100 in all others.
*/
class vpEmulatedUvcCamera : public vpEmulatedUsbDevice
{
public:
  static constexpr unsigned int width = 64, height = 48;
  static constexpr double rate = 50; // Hz

  //! The camera's own state.
  struct State {
    bool claimed = false;       // its streaming interface
    unsigned int aeMode = 8;    // bits of the class: 1 manual, 8 by itself
    unsigned int exposure = 50; // 100 us
    unsigned int gain = 16;
    unsigned int commits = 0;
    bool shortFrame = false; // the next one lacks its second half
    double pause = 0;        // s, before the next one
  };

  explicit vpEmulatedUvcCamera(const std::string &serial);
  ~vpEmulatedUvcCamera() override;

  State state() const;
  void setState(const State &state);

private:
  void plugged() override;
  Result claim(unsigned int interface) override;
  Result release(unsigned int interface) override;
  bool control(const Setup &setup, std::vector<std::uint8_t> &data) override;
  bool mayTransfer() const override { return m_state.claimed; }
  bool receive(const std::vector<std::uint8_t> &) override { return false; }
  std::vector<std::uint8_t> send(size_t room) override;

  State m_state;
  std::array<bool, 2> m_owned{}; // interfaces, by the program
  std::vector<std::uint8_t> m_picture;
  size_t m_sent = 0; // bytes of it
  unsigned int m_number = 0;
  std::chrono::steady_clock::time_point m_due; // of the next frame
};

#endif
