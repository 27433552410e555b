/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_simulation/vpSimulation.h>

#include <cmath>
#include <vector>

#include <gtest/gtest.h>
#include <visp3/core/vpRotationMatrix.h>

#include "simulatedDrive.h"
#include "simulatedRoom.h"

namespace
{
using simulatedRoom::frames;
using simulatedRoom::head;
using simulatedRoom::still;

const std::string drive = "motion: {type: commands, start_m: [0.1, -0.1], commands: [{v_m_s: 0.1, w_rad_s: "
                          "0.3, duration_s: 0.5}]}\n";

std::vector<vpVlpFrame> all(vpSimulation &simulation)
{
  std::vector<vpVlpFrame> frames;
  for (vpVlpFrame frame; simulation.next(frame);) {
    frames.push_back(frame);
  }
  return frames;
}

//! Of the camera in the base, rad about x and y of b; of small angles.
Eigen::Vector2d tiltOf(const vpVlpRig &rig, const vpVlpRig &stated)
{
  vpRotationMatrix bRc, claimed;
  rig.bMc.extract(bRc);
  stated.bMc.extract(claimed);
  const vpRotationMatrix turn = bRc * claimed.t();
  return {0.5 * (turn[2][1] - turn[1][2]), 0.5 * (turn[0][2] - turn[2][0])};
}

//! Numbers that should be independent normal ones of mean 0 and a known standard deviation.
struct Sample {
  double sigma;
  std::vector<double> values = {};

  void expectNormal(const char *what) const
  {
    // With n draws the mean has sigma / sqrt(n), the mean square a share of sqrt(2 / n): 4.5 of these are
    // passed by chance once in 150 000 times.
    static const double confidence = 4.5;
    const double n = static_cast<double>(values.size());
    double sum = 0, squares = 0;
    for (const double value : values) {
      sum += value / sigma;
      squares += value * value / (sigma * sigma);
    }
    EXPECT_LT(std::abs(sum / n), confidence / std::sqrt(n)) << what;
    EXPECT_LT(std::abs(squares / n - 1), confidence * std::sqrt(2 / n)) << what;
  }
};
} // namespace

TEST(Simulation, SameSeedSameBytes)
{
  const simulatedRoom::Folder folder;
  const vpScenario scenario =
      folder.load(head + frames + drive +
                  "robot: {slip_sigma: 0.02, encoder_sigma_rad: 0.001}\ndraw: {lamp_shift_m: 0.01}\n");
  vpSimulation one(scenario, 7), same(scenario, 7), other(scenario, 8);
  auto a = all(one), b = all(same), c = all(other); // vpImage compares what is not const only
  ASSERT_EQ(a.size(), 7u);                          // 0.5 s at 12 Hz, and the frame at the start
  ASSERT_EQ(b.size(), a.size());
  for (size_t k = 0; k < a.size(); ++k) {
    EXPECT_TRUE(a[k].I == b[k].I) << k;
    EXPECT_FALSE(a[k].I == c[k].I) << k;
  }
  ASSERT_EQ(one.odometry().size(), same.odometry().size());
  for (size_t k = 0; k < one.odometry().size(); ++k) {
    EXPECT_EQ(one.odometry()[k].v, same.odometry()[k].v);
    EXPECT_EQ(one.odometry()[k].w, same.odometry()[k].w);
  }
  EXPECT_NE(one.odometry().back().v, other.odometry().back().v);
}

TEST(Simulation, SeedsThatDifferInTheirHighestBitsDiffer)
{
  const simulatedRoom::Folder folder;
  folder.write("lamps.yaml",
               "lamps: [{id: A, position_m: [0, 0, 1.5], diameter_m: 0.3, unmodulated: true}]\n");
  const vpScenario scenario = folder.load(head + frames + still); // nothing but noise is left to chance
  vpVlpFrame one, other;
  vpSimulation(scenario, 1).next(one);
  vpSimulation(scenario, 1 + (std::uint64_t(1) << 50)).next(other);
  EXPECT_FALSE(one.I == other.I);
}

TEST(Simulation, EachSeedDrawsItsOwnPhases)
{
  const simulatedRoom::Folder folder;
  const vpScenario scenario = folder.load(head + frames + still + "draw: {clocks: false}\n");
  std::vector<double> phases; // even from 0 to 1, less their mean
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const vpSimulation simulation(scenario, seed);
    for (const vpSimulatedLamp &lamp : simulation.scene().lamps) {
      // From when it turns from dark to light: a period begins.
      const double frequency = lamp.lamp.modulation.frequency, step = 1 / frequency / 500;
      double t = 0;
      while (lamp.light.over(t, t + step).share > 0) {
        t += step;
      }
      while (lamp.light.over(t, t + step).share <= 0) {
        t += step;
      }
      const double left = std::fmod(t * frequency, 1.0);
      phases.push_back((left > 0 ? 1 - left : 0) - 0.5);
    }
  }
  const double n = static_cast<double>(phases.size());
  double sum = 0, squares = 0;
  for (const double value : phases) {
    sum += value;
    squares += value * value;
  }
  // 4.5 standard deviations; the mean square of an even number has the variance 1 / 180.
  EXPECT_LT(std::abs(sum / n), 4.5 / std::sqrt(12 * n));
  EXPECT_LT(std::abs(squares / n - 1 / 12.), 4.5 / std::sqrt(180 * n));
}

TEST(Simulation, ClaimsStayWhatTheFilesSay)
{
  const simulatedRoom::Folder folder;
  const vpScenario plain = folder.load(head + frames + still);
  const vpScenario scenario = folder.load(
      head + frames + still +
      "truth: {tilt_deg: [0.3, -0.2], principal_point_px: [2, -3], focal_length: 1.02, row_time: 0.99, "
      "lamps: [{id: A, shift_m: [0.01, 0.02, -0.03]}], more_lamps: [{id: C, position_m: [0, 0, 2], "
      "diameter_m: 0.1, unmodulated: true}]}\n");
  const vpSimulation simulation(scenario, 3);
  const vpVlpRig &rig = simulation.rig(), &truth = simulation.camera().rig;
  EXPECT_EQ(rig.camera.get_px(), plain.rig.camera.get_px());
  EXPECT_EQ(rig.camera.get_u0(), plain.rig.camera.get_u0());
  EXPECT_EQ(rig.shutter.rowTime, plain.rig.shutter.rowTime);
  EXPECT_EQ(tiltOf(rig, plain.rig).norm(), 0);
  ASSERT_EQ(simulation.map().lamps.size(), 2u);
  for (size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(simulation.map().lamps[k].position, plain.map.lamps[k].position);
  }

  const Eigen::Vector2d tilt = tiltOf(truth, rig) * 180 / M_PI;
  EXPECT_NEAR(tilt.x(), 0.3, 1e-4);
  EXPECT_NEAR(tilt.y(), -0.2, 1e-4);
  EXPECT_EQ(truth.bMc[0][3], rig.bMc[0][3]);
  EXPECT_NEAR(truth.camera.get_u0(), 49, 1e-12);
  EXPECT_NEAR(truth.camera.get_v0(), 33, 1e-12);
  EXPECT_NEAR(truth.camera.get_px(), 1.02 * 80, 1e-12);
  EXPECT_NEAR(truth.shutter.rowTime, 0.99 * 50e-6, 1e-18);
  EXPECT_NEAR(truth.shutter.exposure, 0.99 * 50e-6, 1e-18); // one line still, by the camera's own clock
  const std::vector<vpSimulatedLamp> &lamps = simulation.scene().lamps;
  ASSERT_EQ(lamps.size(), 3u);
  EXPECT_LT((lamps[0].lamp.position - Eigen::Vector3d(-0.29, -0.18, 1.47)).norm(), 1e-12);
  EXPECT_EQ(lamps[1].lamp.position, plain.map.lamps[1].position);
  EXPECT_EQ(lamps[2].lamp.id, "C");
}

TEST(Simulation, PrincipalPointIsShiftedInPixelsOfTheSensor)
{
  const simulatedRoom::Folder folder;
  folder.write("rig.yaml", folder.read("rig.yaml") + "resize: {method: nearest, source_size: [192, 144]}\n");
  const vpSimulation simulation(folder.load(head + frames + still + "truth: {principal_point_px: [2, -3]}\n"),
                                1);
  EXPECT_NEAR(simulation.camera().rig.camera.get_u0() - simulation.rig().camera.get_u0(), 1, 1e-12);
  EXPECT_NEAR(simulation.camera().rig.camera.get_v0() - simulation.rig().camera.get_v0(), -1.5, 1e-12);
}

TEST(Simulation, DrawsHaveTheirStandardDeviations)
{
  const simulatedRoom::Folder folder;
  const vpScenario scenario =
      folder.load(head + frames + still +
                  "draw: {tilt_deg: 0.15, principal_point_px: 1, focal_length: 0.003, row_time: 0.0005, "
                  "lamp_shift_m: 0.002}\n");
  const double tiltSigma = 0.15 * M_PI / 180;
  Sample tiltX{tiltSigma}, tiltY{tiltSigma}, u{1}, v{1}, focal{0.003}, row{0.0005}, shift{0.002}, together{1};
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    const vpSimulation simulation(scenario, seed);
    const vpVlpRig &rig = simulation.rig(), &truth = simulation.camera().rig;
    const Eigen::Vector2d tilt = tiltOf(truth, rig);
    tiltX.values.push_back(tilt.x());
    tiltY.values.push_back(tilt.y());
    u.values.push_back(truth.camera.get_u0() - rig.camera.get_u0());
    v.values.push_back(truth.camera.get_v0() - rig.camera.get_v0());
    focal.values.push_back(truth.camera.get_px() / rig.camera.get_px() - 1);
    EXPECT_NEAR(truth.camera.get_py() / rig.camera.get_py() - 1, focal.values.back(), 1e-12);
    row.values.push_back(truth.shutter.rowTime / rig.shutter.rowTime - 1);
    for (size_t k = 0; k < 2; ++k) {
      const Eigen::Vector3d off =
          simulation.scene().lamps[k].lamp.position - simulation.map().lamps[k].position;
      shift.values.insert(shift.values.end(), {off.x(), off.y(), off.z()});
    }
    // The product of two independent ones has a standard deviation of 1, too.
    together.values.push_back(u.values.back() * tilt.x() / tiltSigma);
  }
  tiltX.expectNormal("tilt about x");
  tiltY.expectNormal("tilt about y");
  u.expectNormal("principal point u");
  v.expectNormal("principal point v");
  focal.expectNormal("focal length");
  row.expectNormal("row time");
  shift.expectNormal("lamp shift");
  double sum = 0;
  for (const double product : together.values) {
    sum += product;
  }
  EXPECT_LT(std::abs(sum / 1000), 4.5 / std::sqrt(1000.)) << "tilt and principal point go together";
}

TEST(Simulation, ClocksAreOffAsMuchAsTheirOscillators)
{
  const simulatedRoom::Folder folder;
  folder.write("lamps.yaml",
               "lamps: [{id: A, position_m: [0, 0, 1.5], diameter_m: 0.3, frequency_hz: 1000, duty: 0.5, "
               "oscillator_ppm: 10000}]\n");
  // What passes of a period in 20 ms, from the light of two windows that far apart: 20 periods and 20 times
  // the error.
  const auto errorOf = [](const vpLampLight &light) {
    const auto turn = [&light](double t) {
      const double low = light.over(t, t + 1e-4).share;
      double edge = t; // of the next step from dark to light
      double before = low;
      for (; edge < t + 3e-3; edge += 1e-6) {
        const double now = light.over(edge, edge + 1e-6).share;
        if (before <= 0 && now > 0) {
          return edge + 1e-6 * (1 - now);
        }
        before = now;
      }
      return edge;
    };
    const double first = turn(0), second = turn(first + 19.5e-3);
    return 20e-3 / (second - first) - 1;
  };
  Sample clock{0.01};
  const vpScenario scenario = folder.load(head + frames + still);
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    clock.values.push_back(errorOf(vpSimulation(scenario, seed).scene().lamps[0].light));
  }
  clock.expectNormal("clock");
  const std::string exact = head + frames + still + "draw: {clocks: false}\n";
  EXPECT_NEAR(errorOf(vpSimulation(folder.load(exact), 5).scene().lamps[0].light), 0, 1e-6);
  const std::string fast = exact + "truth: {lamps: [{id: A, clock_ppm: 3000}]}\n";
  EXPECT_NEAR(errorOf(vpSimulation(folder.load(fast), 5).scene().lamps[0].light), 3e-3, 1e-6);
}

TEST(Simulation, TimesPosesAndOdometryBelongTogether)
{
  const simulatedRoom::Folder folder;
  const vpScenario scenario = folder.load(head + "frames: {rate_hz: 8, count: 5}\n" + drive);
  vpSimulation simulation(scenario, 1);
  EXPECT_EQ(simulation.size(), 5u);
  const double yaw = 0.3 * 0.375, radius = 0.1 / 0.3;
  vpVlpFrame frame;
  for (int k = 0; k < 5; ++k) {
    ASSERT_TRUE(simulation.next(frame));
    EXPECT_EQ(frame.timestamp, k / 8.0);
    const vpHomogeneousMatrix wMb = simulation.wMb(frame.timestamp);
    if (k == 3) {
      EXPECT_NEAR(wMb[0][3], 0.1 + radius * std::sin(yaw), 1e-9);
      EXPECT_NEAR(wMb[1][3], -0.1 + radius * (1 - std::cos(yaw)), 1e-9);
      EXPECT_NEAR(yawOf(wMb), yaw, 1e-9);
    }
    const std::vector<vpOdometry> odometry = simulation.odometry();
    const double readout = 71 * 50e-6 + 50e-6;
    EXPECT_LE(odometry.back().timestamp, frame.timestamp + readout); // of nothing that is still to come
    EXPECT_GE(odometry.back().timestamp, frame.timestamp - 0.02);
    for (size_t i = 1; i < odometry.size(); ++i) {
      EXPECT_NEAR(odometry[i].v, 0.1, 1e-9);
      EXPECT_NEAR(odometry[i].w, 0.3, 1e-9);
    }
  }
  vpVlpFrame last = frame;
  EXPECT_FALSE(simulation.next(frame));
  EXPECT_TRUE(frame.I == last.I && frame.timestamp == last.timestamp); // left alone
}

TEST(Simulation, StationsShowNoMotionAndHaveNoOdometry)
{
  const simulatedRoom::Folder folder;
  vpSimulation simulation(
      folder.load(head + frames +
                  "motion: {type: stations, frames_each: 2, points: [{at_m: [0, 0]}, {at_m: [0.1, 0]}]}\n"),
      1);
  std::vector<double> x;
  for (const vpVlpFrame &frame : all(simulation)) {
    x.push_back(simulation.wMb(frame.timestamp)[0][3]);
  }
  EXPECT_EQ(x, (std::vector<double>{0, 0, 0.1, 0.1}));
  EXPECT_TRUE(simulation.odometry().empty());
}

TEST(Simulation, LampThatIsReplacedShinesNoMore)
{
  const simulatedRoom::Folder folder;
  folder.write("lamps.yaml",
               "lamps: [{id: A, position_m: [0, 0, 1.5], diameter_m: 0.3, unmodulated: true}]\n");
  vpSimulation simulation(folder.load(head + "frames: {rate_hz: 10, count: 4}\n" + still +
                                      "truth: {lamps: [{id: A, dark: [{from_s: 0.15, until_s: 0.25}]}]}\n"),
                          1);
  std::vector<bool> lit;
  for (const vpVlpFrame &frame : all(simulation)) {
    lit.push_back(frame.I.getMaxValue() > 100);
  }
  EXPECT_EQ(lit, (std::vector<bool>{true, true, false, true}));
}
