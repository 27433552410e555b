/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <gtest/gtest.h>
#include <visp3/vlp_servo/vpServoSimulation.h>

#include "opencr/vpEmulatedTransport.h"
#include "opencr/vpServedTerminal.h"
#include "opencr/vpServoOverBoard.h"

namespace
{
//! The control loop's time where the base is reached over an emulated line: the robot's.
class LineClock : public vpServoClock
{
public:
  explicit LineClock(vpEmulatedTransport &line) : m_line(line), m_due(line.now()) {}
  double period() const override { return 0.02; }
  double now() override { return m_line.now(); }
  double next() override
  {
    m_due += period();
    m_missed += m_line.now() > m_due + 0.1 * period();
    m_due = std::max(m_due, m_line.now());
    m_line.advance(m_due);
    return m_due;
  }
  size_t missed() const override { return m_missed; }

private:
  vpEmulatedTransport &m_line;
  double m_due; // s
  size_t m_missed = 0;
};

//! The middle of line A at 0.1 m/s in simulated time. \return m, RMS of the true track across the path.
double driveLine(const vpFaultyLine::Faults &faults, vpServoRun &run)
{
  const vpScenario scenario = vpScenario::load(VLP_DATA_DIR "/scenarios/servo.yaml");
  const vpPath path = vpServoOverBoard::path();
  vpServoSimulationSettings settings;
  settings.start = {path.at(0).place.x(), path.at(0).place.y(), path.at(0).heading};
  vpServoSimulation world(scenario, 1, settings);
  vpOpenCrEmulator::Settings boardSettings;
  boardSettings.gyroBias = static_cast<float>(scenario.motion.robot.gyroBias);
  vpOpenCrEmulator board(world.robot(), boardSettings);
  auto owned = std::make_unique<vpEmulatedTransport>(world.robot(), board);
  vpEmulatedTransport &line = *owned;
  vpRobotTurtleBot3 base(std::move(owned));
  line.setFaults(faults);
  LineClock clock(line);
  vpVlpPose poses(world);
  vpServoLoopSettings servo;
  servo.follower.reference.speed = 0.1;
  run = vpServoLoop(base, poses, clock, path, servo).run();
  double sum = 0;
  const auto errors = vpTrackErrorsOf(path, run, [&](double time) { return world.wMb(time); });
  for (const vpTrackError &error : errors) {
    sum += error.across * error.across;
  }
  return std::sqrt(sum / static_cast<double>(errors.size()));
}
} // namespace

TEST(ServoOverOpenCr, FollowsTheLine)
{
  vpServoRun run;
  const double rms = driveLine({}, run);
  RecordProperty("rms_across_m", std::to_string(rms));
  EXPECT_LT(rms, 0.005);
  EXPECT_EQ(run.end, vpServoRun::End::arrived) << run.reason;
  EXPECT_EQ(run.missed, 0u);
}

TEST(ServoOverOpenCr, FollowsTheLineOverABadBus)
{
  vpFaultyLine::Faults faults;
  faults.corrupted = 1e-3;
  faults.lost = 1e-4;
  vpServoRun run;
  const double rms = driveLine(faults, run);
  RecordProperty("rms_across_m", std::to_string(rms));
  EXPECT_LT(rms, 0.008);
  EXPECT_EQ(run.end, vpServoRun::End::arrived) << run.reason;
  EXPECT_GT(run.missed, 0u);
}

TEST(ServoOverOpenCr, StopsWhereTheBusIsTooBad)
{
  vpFaultyLine::Faults faults;
  faults.corrupted = 0.05;
  vpServoRun run;
  driveLine(faults, run);
  EXPECT_EQ(run.end, vpServoRun::End::failed);
  EXPECT_NE(run.reason.find("emulated board: "), std::string::npos) << run.reason;
}

TEST(ServoOverOpenCr, FollowsTheLineOverASerialDeviceInRealTime)
{
  vpServoOverBoard servo;
  vpServedTerminal terminal(servo.board);
  terminal.serve();
  const vpServoRun run = servo.drive("opencr:" + terminal.device());
  EXPECT_EQ(run.end, vpServoRun::End::arrived) << run.reason;
  const double rms = servo.rmsAcross(run);
  RecordProperty("rms_across_m", std::to_string(rms));
  RecordProperty("missed", std::to_string(run.missed));
  EXPECT_LT(rms, 0.01); // pictures may come late on a machine that has other things to do
  EXPECT_EQ(servo.statistics.failures, 0u);
}
