/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpVlpServo.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>

#include <unistd.h>

#include <spdlog/spdlog.h>
#include <visp3/core/vpException.h>
#include <visp3/io/vpKeyboard.h>
#include <visp3/vlp_core/vpNewFolder.h>
#include <visp3/vlp_core/vpPrintable.h>
#include <visp3/vlp_robot/vpOpenTurtleBot3.h>
#include <visp3/vlp_servo/vpServoLog.h>

#include "common/vpInterrupt.h"
#include "common/vpProgressBar.h"
#include "vpServoDisplay.h"
#include "vpServoSummary.h"
#include "vpServoWorld.h"

BEGIN_VISP_NAMESPACE

namespace
{
//! A line of standard output for each, its remark below it.
vpExitCode listRobots()
{
  const std::vector<vpAttachedBoard> boards = vpAttachedBoards();
  for (const vpAttachedBoard &board : boards) {
    std::cout << vpPrintable(board.uri) << "\n  " << vpPrintable(board.remark) << "\n";
  }
  if (boards.empty()) {
    spdlog::warn("no board found on USB; one on a serial device is not looked for");
  }
  return boards.empty() ? vpExitCode::nothingFound : vpExitCode::done;
}

//! Around the path and the start.
Eigen::AlignedBox2d fenceAround(const vpPath &path, const vpServoStart &start)
{
  constexpr double step = 0.01, margin = 0.3; // m
  Eigen::AlignedBox2d box(Eigen::Vector2d(start.x, start.y));
  for (double s = 0; s <= path.length(); s += step) {
    box.extend(path.at(s).place);
  }
  box.extend(path.at(path.length()).place);
  const Eigen::Vector2d around(margin, margin);
  return {box.min() - around, box.max() + around};
}

std::unique_ptr<vpPoseSource> posesOf(const vpVlpServoOptions &options, const vpPath &path,
                                      vpServoWorld &world)
{
  const vpServoStart start = options.startOn(path);
  const vpHomogeneousMatrix wMb(start.x, start.y, 0, 0, 0, start.yaw);
  switch (options.pose) {
  case vpVlpServoOptions::Pose::odometry:
    return std::make_unique<vpOdometryPose>(wMb, world.clock().now());
  case vpVlpServoOptions::Pose::commands:
    return std::make_unique<vpCommandedPose>(wMb, world.clock().now());
  case vpVlpServoOptions::Pose::lamps:
    break;
  }
  return world.poses();
}

//! Whether somebody has pressed a key in the terminal that the program runs in.
class AnyKey
{
public:
  AnyKey() : m_keyboard(isatty(STDIN_FILENO) == 1 ? std::make_unique<vpKeyboard>() : nullptr) {}
  bool pressed() { return m_keyboard && m_keyboard->kbhit() > 0; }

private:
  std::unique_ptr<vpKeyboard> m_keyboard;
};

//! The program's state, from the start to its exit code.
class Servo
{
public:
  explicit Servo(const vpVlpServoOptions &options)
      : m_options(options), m_log{vpPath::load(options.pathFile), {}, {}, {}}
  {
    if (!m_options.loop.safety.fence) {
      m_options.loop.safety.fence = fenceAround(m_log.path, m_options.startOn(m_log.path));
    }
  }

  vpExitCode run()
  {
    vpInterrupt::install();
    const std::unique_ptr<vpNewFolder> folder =
        m_options.log.empty() ? nullptr : std::make_unique<vpNewFolder>(m_options.log);
    const std::unique_ptr<vpServoWorld> world = vpOpenServoWorld(m_options, m_log.path);
    drive(*world);
    for (const vpServoStep &step : m_log.run.steps) {
      if (world->truth()) {
        m_log.truth.add(step.time, world->truth()(step.time));
      }
    }
    vpPrintServoSummary(m_log, world->clock().period());
    if (folder) {
      m_log.save(folder->file(""));
      vpDrawServoTracks(m_log, folder->file(""));
      folder->commit();
    }
    switch (m_log.run.end) {
    case vpServoRun::End::arrived:
      return vpExitCode::done;
    case vpServoRun::End::stopped:
      spdlog::warn("stopped on the way; what was driven so far is kept");
      return vpExitCode::done;
    case vpServoRun::End::failed:
      break;
    }
    spdlog::error("the robot stands: {}", m_log.run.reason);
    return vpExitCode::nothingFound;
  }

private:
  void drive(vpServoWorld &world)
  {
    const std::unique_ptr<vpPoseSource> poses = posesOf(m_options, m_log.path, world);
    vpServoLoop loop(world.base(), *poses, world.clock(), m_log.path, m_options.loop);
    AnyKey key;
    vpServoDisplay display(m_options.display, m_log.path, world);
    constexpr size_t marks = 1000;
    const double end =
        m_log.path.length() * (m_log.path.closed() ? m_options.loop.follower.reference.laps : 1);
    vpProgressBar progress(marks);
    loop.battery = world.battery();
    loop.watch = [&](const vpServoStep &step, const std::vector<vpLocatedPicture> &pictures) {
      for (const vpLocatedPicture &picture : pictures) {
        if (picture.location.fix.valid) {
          m_log.poses.add(picture.timestamp, picture.location.fix.wMb);
        }
      }
      if ((step.share > 0) != m_moving) {
        progress.clear();
        tellMotion(step);
      }
      progress.show(static_cast<size_t>(std::min(1.0, step.reference.s / end) * marks));
      return !vpInterrupt::requested() && !key.pressed() && display.show(step, pictures);
    };
    m_log.run = loop.run();
  }

  //! Where it may not move any more, and where it may again.
  void tellMotion(const vpServoStep &step)
  {
    m_moving = step.share > 0;
    if (!m_moving) {
      spdlog::warn("{:.2f} s: the robot stands: {}", step.time, step.waiting);
    } else if (m_hasMoved) {
      spdlog::info("{:.2f} s: it goes on", step.time);
    }
    m_hasMoved = true;
  }

  vpVlpServoOptions m_options;
  vpServoLog m_log;
  bool m_moving = false, m_hasMoved = false;
};
} // namespace

vpExitCode vpVlpServo(const vpVlpServoOptions &options)
{
  if (options.listRobots) {
    return listRobots();
  }
  return Servo(options).run();
}

END_VISP_NAMESPACE
