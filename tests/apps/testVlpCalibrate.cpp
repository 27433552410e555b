/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// vlp-calibrate, run as a user runs it.

#include <filesystem>
#include <random>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <visp3/vlp_core/vpCameraXml.h>
#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_core/vpVlpRig.h>

#include "apps/vpExpectRefused.h"
#include "common/vpProcess.h"
#include "vlp_calibration/boardPictures.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
using namespace vpStatus;

//! A short run: half a turn on the spot and a little way, under lamps of two heights, the camera leaning.
const char *const scenario = R"(rig: %/rigs/ub300-800x600.yaml
lamps: %/lamps/two-heights.yaml
frames: {rate_hz: 6}
motion:
  type: commands
  start_m: [-0.15, 0]
  commands: [{w_rad_s: 1, duration_s: 6.2832}, {v_m_s: 0.1, duration_s: 3}, {w_rad_s: 1, duration_s: 1.5708}, {v_m_s: 0.1, duration_s: 3}]
robot: {left_radius_error: 0.004, right_radius_error: -0.004, encoder_ticks: true}
truth: {tilt_deg: [0.3, -0.2], principal_point_px: [3, -2]}
)";

class VlpCalibrate : public testing::Test
{
protected:
  //! Simulates a run once for all tests. \return Its folder.
  static std::string run()
  {
    static const vpTemporaryFolder folder;
    if (!std::filesystem::exists(folder / "run")) {
      std::string text = scenario;
      for (size_t at = text.find('%'); at != std::string::npos; at = text.find('%')) {
        text.replace(at, 1, VLP_DATA_DIR);
      }
      vpProcess simulate("vlp-simulate", {"--scenario", folder.write("scenario.yaml", text), "--seed", "2",
                                          "--out", folder / "run"});
      EXPECT_EQ(simulate.wait(), done) << simulate.err();
    }
    return folder / "run";
  }

  static void expectRefused(const std::vector<std::string> &words, int code,
                            const std::vector<std::string> &parts)
  {
    EXPECT_EQ(vpExpectRefused("vlp-calibrate", words, code, parts), "");
  }

  vpTemporaryFolder folder;
};

TEST_F(VlpCalibrate, HelpNamesTheCommandsAndEachHasExamples)
{
  vpProcess help("vlp-calibrate", {"--help"});
  EXPECT_EQ(help.wait(), done);
  for (const char *command : {"camera", "shutter", "mount", "lamps"}) {
    EXPECT_NE(help.out().find(command), std::string::npos);
    vpProcess own("vlp-calibrate", {command, "--help"});
    EXPECT_EQ(own.wait(), done);
    EXPECT_NE(own.out().find("Examples:\n  vlp-calibrate " + std::string(command)), std::string::npos)
        << own.out();
    EXPECT_NE(own.out().find("Exit code: 0 done; 2 bad usage"), std::string::npos);
  }
}

TEST_F(VlpCalibrate, RefusesBadUsageInOneLine)
{
  expectRefused({}, badInput, {"command", "camera, shutter, mount or lamps"});
  expectRefused({"moont"}, badInput, {"moont"});
  expectRefused({"shutter", "--image", "a.png"}, badInput, {"--frequency"});
  expectRefused({"shutter", "--image", "a.png", "--frequency", "fast"}, badInput,
                {"--frequency", "fast", "above 0"});
  expectRefused({"camera", "--size", "9"}, badInput, {"--size", "9x6"});
  expectRefused({"mount", "--images", "a%d.png"}, badInput, {"--rig"});
  expectRefused({"mount", "--run", folder / "none"}, badInput, {"rig.yaml"});
  expectRefused({"mount", "--run", run(), "--fix", "u7"}, badInput, {"--fix", "u7", "u0"});
  expectRefused({"mount", "--run", run(), "--prior", "u0"}, badInput, {"--prior", "NAME=SIGMA"});
  expectRefused({"mount", "--run", run(), "--fix", "z", "--prior", "z=1"}, badInput,
                {"--prior z: beside --fix of the same"});
  expectRefused({"mount", "--run", run(), "--motion", "places"}, badInput, {"--places"});
  expectRefused({"lamps", "--run", run()}, badInput, {"--measured", "two or more"});
  expectRefused({"lamps", "--run", run(), "--measured", "LED1,LED9"}, badInput,
                {"--measured", "LED9", "LED1, LED2"});
  expectRefused({"lamps", "--run", run(), "--distance", "LED1,LED2"}, badInput, {"--distance"});
  expectRefused({"mount", "--run", run(), "--out", run()}, badInput, {"--out", "rig.yaml is an input"});
  expectRefused({"shutter", "--run", run(), "--out", run()}, badInput, {"--out", "rig.yaml is an input"});
}

TEST_F(VlpCalibrate, ShutterWritesTheRig)
{
  vpProcess calibrate("vlp-calibrate",
                      {"shutter", "--image", run() + "/frame000000.png", run() + "/frame000001.png", "--rig",
                       run() + "/rig.yaml", "--lamps", run() + "/lamps.yaml", "--out", folder / "out"});
  EXPECT_EQ(calibrate.wait(), done) << calibrate.err();
  EXPECT_NE(calibrate.out().find("row time, us"), std::string::npos);
  const vpVlpRig rig = vpVlpRig::load(folder / "out/rig.yaml");
  EXPECT_NEAR(rig.shutter.rowTime, 43.1e-6, 43.1e-6 * 1e-3);
  EXPECT_GT(rig.shutter.rowTimeSigma, 0);
}

TEST_F(VlpCalibrate, MountAndLampsWriteWhatTheyFound)
{
  vpProcess mount("vlp-calibrate", {"mount", "--run", run(), "--out", folder / "mount"});
  ASSERT_EQ(mount.wait(), done) << mount.err();
  const vpVlpRig rig = vpVlpRig::load(folder / "mount/rig.yaml");
  EXPECT_NEAR(rig.camera.get_u0(), vpVlpRig::load(run() + "/rig.yaml").camera.get_u0() + 3 / 2.56, 0.3);
  EXPECT_GT(rig.rotationSigma.x(), 0);
  EXPECT_GT(rig.principalPointSigma.value_or(0), 0);
  for (const char *name : {"residuals.png", "report.txt", "covariance.csv", "camera.xml"}) {
    EXPECT_TRUE(std::filesystem::exists(folder / ("mount/" + std::string(name)))) << name;
  }
  EXPECT_EQ(cv::imread(folder / "mount/residuals.png").cols, 800);

  vpLampMap map = vpLampMap::load(run() + "/lamps.yaml"); // one of them is wrong
  const Eigen::Vector3d truth = map.lamps[2].position;
  map.lamps[2].position += Eigen::Vector3d(0.06, 0, 0);
  map.save(folder / "lamps.yaml");
  vpProcess lamps("vlp-calibrate",
                  {"lamps", "--run", run(), "--rig", folder / "mount/rig.yaml", "--lamps",
                   folder / "lamps.yaml", "--measured", "LED1,LED4", "--out", folder / "lamps"});
  ASSERT_EQ(lamps.wait(), done) << lamps.err();
  EXPECT_NE(lamps.err().find("lamp LED3 is 60 mm from where the map has it"), std::string::npos)
      << lamps.err();
  const vpLampMap found = vpLampMap::load(folder / "lamps/lamps.yaml");
  EXPECT_LT((found.lamps[2].position - truth).norm(), 0.004);
}

TEST_F(VlpCalibrate, SaysWhatThePicturesDoNotTell)
{
  expectRefused({"mount", "--image", run() + "/frame000000.png", "--rig", run() + "/rig.yaml", "--lamps",
                 run() + "/lamps.yaml", "--out", folder / "out"},
                nothingFound, {"too few pictures: 1 of 1"});
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST_F(VlpCalibrate, CameraFromPicturesAndTheWrongSize)
{
  using namespace boardPictures;
  const vpBoard board;
  std::mt19937_64 random(4);
  std::vector<std::string> words = {"camera", "--out", folder / "out", "--image"};
  for (int i = 0; i < 7; ++i) {
    const std::string name = folder / ("board" + std::to_string(i) + ".png");
    vpHomogeneousMatrix cMo = held(board, i, random, 0.6);
    cMo[0][3] *= 0.5; // whole in the picture
    cMo[1][3] *= 0.5;
    cMo[2][3] += 0.06;
    cv::imwrite(name, picture(board, camera(-0.08), cMo, random));
    words.push_back(name);
  }
  vpProcess calibrate("vlp-calibrate", words);
  ASSERT_EQ(calibrate.wait(), done) << calibrate.err();
  const vpCameraXml found = vpCameraXml::load(folder / "out/camera.xml", "camera");
  EXPECT_NEAR(found.camera.get_px(), 488, 2.5);
  EXPECT_NEAR(found.camera.get_u0(), 395, 2.5);
  EXPECT_NE(folder.read("out/camera_info.yaml").find("distortion_model: plumb_bob"), std::string::npos);

  // ROS's file and back.
  vpProcess back("vlp-calibrate",
                 {"camera", "--camera-info", folder / "out/camera_info.yaml", "--out", folder / "back"});
  ASSERT_EQ(back.wait(), done) << back.err();
  const vpCameraParameters same = vpCameraXml::load(folder / "back/camera.xml", "camera").camera;
  EXPECT_NEAR(same.get_py(), found.camera.get_py(), 1e-9);
  EXPECT_NEAR(same.get_v0(), found.camera.get_v0(), 1e-9);
  EXPECT_NEAR(same.get_kud(), found.camera.get_kud(), 1e-12);
  EXPECT_NEAR(same.get_kdu(), found.camera.get_kdu(), 1e-12);

  words.insert(words.begin() + 1, {"--size", "8x5"});
  expectRefused(words, nothingFound, {"8x5 inner corners", "one of 9x6 is there"});
  vpProcess print("vlp-calibrate", {"camera", "--print", folder / "board.pdf"});
  EXPECT_EQ(print.wait(), done);
  EXPECT_EQ(folder.read("board.pdf").substr(0, 5), "%PDF-");
}
} // namespace
