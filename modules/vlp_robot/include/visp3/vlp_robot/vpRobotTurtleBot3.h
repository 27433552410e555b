/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpRobotTurtleBot3_h
#define vpRobotTurtleBot3_h

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <visp3/vlp_robot/vpBoardClock.h>
#include <visp3/vlp_robot/vpDynamixelBus.h>
#include <visp3/vlp_robot/vpOpenCrTable.h>
#include <visp3/vlp_robot/vpTurtleBot3.h>

BEGIN_VISP_NAMESPACE

struct VISP_EXPORT vpRobotTurtleBot3Settings {
  enum class TurnSource { wheels, gyro };

  bool dither = true;      // carries what rounding left out over to the next command
  double acceleration = 0; // m/s^2 at each wheel's rim, from standstill to the goal; 0: as the board has it
  bool allowDebugMode = false;              // drive a board whose watchdog is switched off
  TurnSource turnSource = TurnSource::gyro; // of vpOdometry::w

  //! Clock of the frames' time stamps, s. Empty: the transport's own, vpByteTransport::now().
  std::function<double()> clock;

  double commandDeadline = 0.2;  // s, for all transactions of one command together
  double stopDeadline = 0.3;     // s, for a stop, also for the one after a failure
  double odometryDeadline = 0.1; // s, for a new sample
  double odometryPeriod = 0.01;  // s after a reading, in which the board is not asked again
  double odometryAge = 0.25;     // s: where no new sample comes, the last one is given until it is this old

  //! \throw vpException (badValue) with one line: the field, what came and what was expected.
  void check() const;
};

//! Status reported by the board.
struct VISP_EXPORT vpTurtleBot3Status {
  double batteryVoltage = 0; // V; a TurtleBot3's three cells are empty at 11 V
  double batteryCharge = 0;  // share, 0 to 1
  bool motorsAnswer = false;
  bool torque = false;                  // of the motors
  std::array<bool, 2> buttons{};        // pressed
  std::array<bool, 2> bumpers{};        // pressed
  vpWheels wheelSpeeds;                 // rad/s
  std::array<double, 3> gyro{};         // rad/s, in b
  std::array<double, 3> acceleration{}; // m/s^2, in b
};

/*!
  A TurtleBot3 over its OpenCR board with ROBOTIS' firmware for ROS 2 (DYNAMIXEL protocol 2.0, id 200).

  Commands. setVelocity() writes a new heartbeat value and then the command, each confirmed by the board, and
  returns or throws within commandDeadline + stopDeadline. Where a confirmation may belong to an
  earlier request (vpDynamixelBus::answerMayBeStale()), both are read back. The heartbeat's value differs in
  each call, and so identifies this command.

  Watchdog. The board stands 0.5 s after the last change of the heartbeat. Only setVelocity() changes it, no
  thread does: a loop that hangs, a process killed and a cable pulled all stop the base. The first value
  written differs from the one that the board holds, for the board takes only a change as a sign of life.

  Odometry. v is from the wheels' encoders; w from the gyro (the mean of its readings at both ends of the
  interval, where that is 0.1 s or less) or from the wheels. Time stamps are the board's, put on the host's
  clock. A reading counts only if its CRC is right, the board in it holds the command that was confirmed, and
  the wheels in it have turned no further than five times their top speed allows. The board measures every
  20 ms; who asks more often gets the same sample again.

  Errors. On an ioError a stop is sent to the base, as far as the line allows. It takes no command until
  reconnect() has worked; stop() always tries. The heartbeat is not changed meanwhile. Where a bus is so bad
  that a deadline passes, that is an ioError.

  One thread at a time. The destructor stops the base.

  \code
  const auto base = vpOpenTurtleBot3("opencr:usb");
  base->setVelocity(0.1, 0); // and again within half a second, else it stands
  \endcode
*/
class VISP_EXPORT vpRobotTurtleBot3 : public vpMobileBase
{
public:
  /*!
    Asks the board what it is, has it stand, switches the motors' torque on and reads the first odometry.
    \throw vpException (ioError) where the board does not answer, is no TurtleBot3's, has no motors, or has
    its watchdog switched off; (badValue) for the settings.
  */
  explicit vpRobotTurtleBot3(std::unique_ptr<vpByteTransport> transport,
                             const vpRobotTurtleBot3Settings &settings = vpRobotTurtleBot3Settings());
  ~vpRobotTurtleBot3() override;

  vpBaseVelocity setVelocity(double v, double w) override;
  //! Within stopDeadline. Tries also where the connection was given up.
  void stop() override;
  //! Within odometryDeadline, and stopDeadline where it throws.
  vpOdometry odometry() override;
  vpBaseLimits limits() const override { return m_geometry.limits(); }

  vpTurtleBot3::Model model() const { return m_model; }
  int firmwareVersion() const { return m_firmware; }
  //! Read from the board, within odometryDeadline. \throw vpException (ioError).
  vpTurtleBot3Status status();

  /*!
    Has the board find its gyro's bias anew. It does nothing else for up to 5 s meanwhile, its watchdog
    included, so the base must stand. \throw vpException (badValue) where it moves; (ioError).
  */
  void recalibrateImu();

  //! Opens the line anew and begins as the constructor does. \throw vpException (ioError) as the constructor.
  void reconnect();
  bool connected() const { return m_connected; }

  vpDynamixelStatistics statistics() const { return m_bus.statistics(); }

private:
  //! The wheels' position and the gyro at one time.
  struct Reading {
    std::uint32_t millis = 0;         // of the board
    double time = 0;                  // s, on the clock of the transport
    std::int32_t left = 0, right = 0; // ticks, wrap
    double gyro = 0;                  // rad/s about z
  };

  void begin();
  void identify();
  void dateBoard();
  void prepareMotors();
  void requireConnection() const;
  void guarded(const std::function<void()> &act);

  void tell(const vpBaseVelocity &velocity, bool heartbeat, double deadline);
  bool holdsCommand(const vpControlBlock &table) const;
  vpControlBlock readTable(double deadline);
  vpControlBlock readCurrentTable(double deadline);
  Reading readingOf(const vpControlBlock &table);
  bool plausible(const vpControlBlock &table) const;
  void sample(double deadline);
  vpBaseVelocity meanVelocity(const Reading &from, const Reading &to) const;

  template <class T>
  void write(const vpControlItem<T> &item, std::common_type_t<T> value, double deadline);
  double now() const { return m_bus.now(); }

  vpRobotTurtleBot3Settings m_settings;
  vpDynamixelBus m_bus;
  vpTurtleBot3::Model m_model = vpTurtleBot3::Model::burger;
  vpTurtleBot3 m_geometry;
  vpVelocityRounding m_rounding;
  int m_firmware = 0;
  bool m_connected = false;
  double m_clockOffset = 0; // s, from the clock of the transport to that of the time stamps

  // What the board was told, and holds where it confirmed.
  bool m_heartbeatKnown = false; // false: it may be the one before
  std::uint8_t m_heartbeat = 0;
  std::int32_t m_commandV = 0, m_commandW = 0; // hundredths

  vpBoardClock m_clock;
  Reading m_last;
  double m_sampled = 0; // s, when the board was asked for odometry
  vpOdometry m_odometry;
};

END_VISP_NAMESPACE

#endif
