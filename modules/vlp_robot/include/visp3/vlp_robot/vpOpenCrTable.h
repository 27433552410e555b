/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpOpenCrTable_h
#define vpOpenCrTable_h

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! An item of a control table: where it is, and as what type it is stored, little-endian.
template <class T>
struct vpControlItem {
  using Type = T;
  static constexpr std::uint16_t length = sizeof(T);
  std::uint16_t address;
};

/*!
  The control table of the OpenCR board with ROBOTIS' TurtleBot3 firmware for ROS 2 (turtlebot3 and OpenCR
  sources). Left and right are the driven wheels, counted positive where the base rolls forward.
*/
struct VISP_EXPORT vpOpenCrTable {
  static constexpr std::uint8_t id = 200;                // on the bus
  static constexpr std::uint16_t openCrModel = 0x5000;   // modelNumber
  static constexpr std::uint32_t burger = 1, waffle = 2; // modelInfo

  static constexpr vpControlItem<std::uint16_t> modelNumber{0};
  static constexpr vpControlItem<std::uint32_t> modelInfo{2};
  static constexpr vpControlItem<std::uint8_t> firmwareVersion{6};
  static constexpr vpControlItem<std::uint32_t> millis{10};     // since the board's start
  static constexpr vpControlItem<std::uint8_t> debugMode{14};   // 1: the watchdog is off
  static constexpr vpControlItem<std::int8_t> deviceStatus{18}; // 0: running, -1: no motors
  static constexpr vpControlItem<std::uint8_t> heartbeat{19};   // RW
  static constexpr vpControlItem<std::uint8_t> button1{26}, button2{27};
  static constexpr vpControlItem<std::uint8_t> bumper1{28}, bumper2{29};
  static constexpr vpControlItem<std::int32_t> batteryVoltage{42}; // 0.01 V
  static constexpr vpControlItem<std::int32_t> batteryCharge{46};  // 0.01 %
  static constexpr vpControlItem<std::uint8_t> imuRecalibrate{
      59}; // RW; the board does nothing else meanwhile
  static constexpr vpControlItem<float> gyroX{60}, gyroY{64}, gyroZ{68};    // rad/s
  static constexpr vpControlItem<float> accelX{72}, accelY{76}, accelZ{80}; // m/s^2
  static constexpr vpControlItem<std::int32_t> currentLeft{120}, currentRight{124};
  static constexpr vpControlItem<std::int32_t> velocityLeft{128}, velocityRight{132}; // 0.229 rpm
  static constexpr vpControlItem<std::int32_t> positionLeft{136}, positionRight{140}; // 4096 per turn, wraps
  static constexpr vpControlItem<std::uint8_t> torqueEnable{149};                     // RW
  static constexpr vpControlItem<std::int32_t> commandV{150};                         // RW, 0.01 m/s along x
  static constexpr vpControlItem<std::int32_t> commandW{170};                        // RW, 0.01 rad/s about z
  static constexpr vpControlItem<std::uint32_t> profileLeft{174}, profileRight{178}; // RW, 214.577 rev/min^2

  static constexpr std::uint16_t size = 182;
  //! All that changes, which the host reads in one transaction: millis to the profile of the right wheel.
  static constexpr std::uint16_t snapshotAddress = 10, snapshotLength = size - snapshotAddress;
  //! The command's six numbers, linear x y z and angular x y z; the base takes the first and the last.
  static constexpr std::uint16_t commandAddress = 150, commandLength = 24;
  static constexpr double profileUnit = 214.577; // rev/min^2
};

//! A stretch of a control table, as read from the board or as to be written there.
class VISP_EXPORT vpControlBlock
{
public:
  vpControlBlock() = default;
  vpControlBlock(std::uint16_t address, size_t length) : m_address(address), m_bytes(length, 0) {}
  vpControlBlock(std::uint16_t address, std::vector<std::uint8_t> bytes)
      : m_address(address), m_bytes(std::move(bytes))
  {
  }

  std::uint16_t address() const { return m_address; }
  const std::vector<std::uint8_t> &bytes() const { return m_bytes; }
  std::vector<std::uint8_t> &bytes() { return m_bytes; }

  //! \throw vpException (dimensionError) where the item is not inside the block.
  template <class T>
  T get(const vpControlItem<T> &item) const
  {
    std::array<std::uint8_t, sizeof(T)> raw;
    copy(item.address, raw.data(), sizeof(T));
    return fromLittleEndian<T>(raw);
  }

  //! \throw vpException (dimensionError) where the item is not inside the block.
  template <class T>
  void set(const vpControlItem<T> &item, std::common_type_t<T> value)
  {
    Bits<T> bits = 0;
    std::memcpy(&bits, &value, sizeof(T));
    const size_t first = offset(item.address, sizeof(T));
    for (size_t i = 0; i < sizeof(T); ++i) {
      m_bytes[first + i] = static_cast<std::uint8_t>(bits >> (8 * i));
    }
  }

private:
  template <class T>
  using Bits = std::conditional_t<sizeof(T) == 1, std::uint8_t,
                                  std::conditional_t<sizeof(T) == 2, std::uint16_t, std::uint32_t>>;

  template <class T>
  static T fromLittleEndian(const std::array<std::uint8_t, sizeof(T)> &raw)
  {
    Bits<T> bits = 0;
    for (size_t i = 0; i < sizeof(T); ++i) {
      bits = static_cast<Bits<T>>(bits | static_cast<std::uint32_t>(raw[i]) << (8 * i));
    }
    T value;
    std::memcpy(&value, &bits, sizeof(T));
    return value;
  }

  size_t offset(std::uint16_t address, size_t length) const;
  void copy(std::uint16_t address, std::uint8_t *out, size_t length) const;

  std::uint16_t m_address = 0;
  std::vector<std::uint8_t> m_bytes;
};

END_VISP_NAMESPACE

#endif
