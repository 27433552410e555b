/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <cmath>

#include <gtest/gtest.h>
#include <visp3/core/vpXmlParserCamera.h>
#include <visp3/vlp_core/vpCameraXml.h>
#include <visp3/vlp_core/vpVlpRig.h>

#include "common/vpExpectError.h"
#include "common/vpTemporaryFolder.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
const std::string model = "<model><type>perspectiveProjWithoutDistortion</type>\n"
                          "<px>906.25</px><py>906.25</py><u0>417</u0><v0>341</v0></model>";
const std::string camera = "<camera><name>UB300</name>\n"
                           "<image_width>800</image_width><image_height>600</image_height>\n" +
                           model + "</camera>\n";
const std::string xml = "<?xml version=\"1.0\"?>\n<root>\n<!-- mine -->\n" + camera + "</root>\n";

const std::string shutterLine = "shutter: {row_time_s: 43.1e-6, exposure_s: 50e-6, readout: rows}\n";
const std::string minimal = "camera: {file: camera.xml, name: UB300}\n" + shutterLine;

//! Replaces \e what, which must be there, in \e text.
std::string with(std::string text, const std::string &what, const std::string &by)
{
  EXPECT_NE(text.find(what), std::string::npos) << what;
  return text.replace(text.find(what), what.size(), by);
}

void expectSame(const vpCameraParameters &one, const vpCameraParameters &other)
{
  EXPECT_EQ(one.get_projModel(), other.get_projModel());
  EXPECT_EQ(one.get_px(), other.get_px());
  EXPECT_EQ(one.get_py(), other.get_py());
  EXPECT_EQ(one.get_u0(), other.get_u0());
  EXPECT_EQ(one.get_v0(), other.get_v0());
  EXPECT_EQ(one.get_kud(), other.get_kud());
  EXPECT_EQ(one.get_kdu(), other.get_kdu());
  if (one.get_projModel() == vpCameraParameters::ProjWithKannalaBrandtDistortion) {
    EXPECT_EQ(one.getKannalaBrandtDistortionCoefficients(), other.getKannalaBrandtDistortionCoefficients());
  }
}

std::vector<vpCameraParameters> cameras()
{
  const std::vector<double> kb = {0.01, -0.002, 1.0 / 3, 0.0001, -1e-7};
  return {vpCameraParameters(906.25, 900 + 1 / 3.0, 417, 341.1),
          vpCameraParameters(906.25, 900, 417, 341, -0.1, 0.11),
          vpCameraParameters(906.25, 900, 417, 341, kb)};
}
} // namespace

TEST(VlpRig, ReadsTheLeastThatARigHas)
{
  const vpTemporaryFolder folder;
  folder.write("camera.xml", xml);
  const vpVlpRig rig = vpVlpRig::load(folder.write("rig.yaml", minimal));
  EXPECT_EQ(rig.cameraFile, "camera.xml");
  EXPECT_EQ(rig.cameraName, "UB300");
  EXPECT_EQ(rig.width, 800u);
  EXPECT_EQ(rig.height, 600u);
  expectSame(rig.camera, vpCameraParameters(906.25, 906.25, 417, 341));
  EXPECT_EQ(rig.shutter.rowTime, 43.1e-6);
  EXPECT_DOUBLE_EQ(rig.shutter.rowTimeSigma, vpVlpRig::uncalibratedRowTime * 43.1e-6);
  EXPECT_EQ(rig.shutter.exposure, 50e-6);
  EXPECT_EQ(rig.shutter.readout, vpRollingShutter::Readout::rows);
  EXPECT_EQ(rig.resize.method, vpPictureResize::Method::none);
  EXPECT_TRUE(rig.bMc.isAnHomogeneousMatrix());
  for (unsigned int i = 0; i < 4; ++i) {
    for (unsigned int j = 0; j < 4; ++j) {
      EXPECT_EQ(rig.bMc[i][j], i == j ? 1 : 0);
    }
  }
  EXPECT_EQ(rig.rotationSigma.norm(), 0);
  EXPECT_FALSE(rig.principalPointSigma);
  EXPECT_FALSE(rig.focalLengthSigma);
  EXPECT_EQ(rig.lineTiming().lines(), 600u);
}

TEST(VlpRig, ReadsAllThatARigMayHave)
{
  const vpTemporaryFolder folder;
  folder.write("camera.xml", xml);
  const vpVlpRig rig = vpVlpRig::load(folder.write(
      "rig.yaml",
      "camera: {file: camera.xml, name: UB300, principal_point_sigma_px: 0.4, focal_length_sigma: 0.003}\n"
      "shutter: {row_time_s: 43.1e-6, row_time_sigma_s: 2e-9, exposure_s: 1e-4, readout: columns_reversed}\n"
      "resize: {method: nearest, source_size: [2048, 1536]}\n"
      "mount: {translation_m: [0.01, -0.02, 0.19], rotation_rpy_deg: [90, 0, 180],\n"
      "        translation_sigma_m: [0.001, 0.002, 0.003], rotation_sigma_deg: [0.1, 0.2, 0.3]}\n"));
  EXPECT_EQ(rig.shutter.rowTimeSigma, 2e-9);
  EXPECT_EQ(rig.shutter.readout, vpRollingShutter::Readout::columnsReversed);
  EXPECT_EQ(rig.resize.method, vpPictureResize::Method::nearest);
  EXPECT_EQ(rig.resize.sourceWidth, 2048u);
  EXPECT_EQ(rig.resize.sourceHeight, 1536u);
  EXPECT_EQ(rig.lineTiming().lines(), 800u);
  EXPECT_EQ(rig.principalPointSigma, 0.4);
  EXPECT_EQ(rig.focalLengthSigma, 0.003);
  EXPECT_EQ(rig.translationSigma, Eigen::Vector3d(0.001, 0.002, 0.003));
  EXPECT_TRUE(rig.rotationSigma.isApprox(Eigen::Vector3d(0.1, 0.2, 0.3) * M_PI / 180));
  // roll 90 takes y to z and z to -y, then yaw 180 turns x and y round
  const double expected[3][4] = {{-1, 0, 0, 0.01}, {0, 0, 1, -0.02}, {0, 1, 0, 0.19}};
  for (unsigned int i = 0; i < 3; ++i) {
    for (unsigned int j = 0; j < 4; ++j) {
      EXPECT_NEAR(rig.bMc[i][j], expected[i][j], 1e-12);
    }
  }
}

TEST(VlpRig, SavedAndLoadedItIsTheSame)
{
  for (const vpCameraParameters &parameters : cameras()) {
    for (const std::string rotation : {"0, 0, 180", "1.5, -2.25, 91", "10, 90, 20", "180, 0, 0"}) {
      const vpTemporaryFolder folder;
      folder.write("camera.xml", xml);
      vpVlpRig rig = vpVlpRig::load(
          folder.write("rig.yaml", minimal + "mount: {translation_m: [0.1, 0, 0.19], rotation_rpy_deg: [" +
                                       rotation + "]}\n"));
      rig.camera = parameters;
      rig.cameraFile = "my camera.xml";
      rig.cameraName = "A & <B>: \"C\"";
      rig.width = 1280;
      rig.shutter.readout = vpRollingShutter::Readout::rowsReversed;
      rig.shutter.rowTime = 1e-5 / 3;
      rig.resize = {vpPictureResize::Method::area, 2560, 1200};
      rig.rotationSigma = Eigen::Vector3d(0.1, 0.2, 0.3) * M_PI / 180;
      rig.focalLengthSigma = 0.001 / 3;
      rig.save(folder / "saved.yaml");
      EXPECT_EQ(folder.count(), 4u); // camera.xml, rig.yaml and the two new ones

      const vpVlpRig back = vpVlpRig::load(folder / "saved.yaml");
      expectSame(back.camera, rig.camera);
      EXPECT_EQ(back.cameraFile, rig.cameraFile);
      EXPECT_EQ(back.cameraName, rig.cameraName);
      EXPECT_EQ(back.width, 1280u);
      EXPECT_EQ(back.height, 600u);
      EXPECT_EQ(back.shutter.rowTime, rig.shutter.rowTime);
      EXPECT_EQ(back.shutter.rowTimeSigma, rig.shutter.rowTimeSigma);
      EXPECT_EQ(back.shutter.exposure, rig.shutter.exposure);
      EXPECT_EQ(back.shutter.readout, rig.shutter.readout);
      EXPECT_EQ(back.resize.method, rig.resize.method);
      EXPECT_EQ(back.resize.sourceWidth, 2560u);
      EXPECT_EQ(back.resize.sourceHeight, 1200u);
      EXPECT_EQ(back.rotationSigma, rig.rotationSigma);
      EXPECT_FALSE(back.principalPointSigma);
      EXPECT_EQ(back.focalLengthSigma, rig.focalLengthSigma);
      for (unsigned int i = 0; i < 4; ++i) {
        for (unsigned int j = 0; j < 4; ++j) {
          EXPECT_NEAR(back.bMc[i][j], rig.bMc[i][j], 1e-14) << rotation;
        }
      }
    }
  }
}

TEST(VlpRig, DoesNotOverwriteOtherCameras)
{
  const vpTemporaryFolder folder;
  const std::string two = with(xml, "<root>", "<root>" + with(camera, "UB300", "other"));
  folder.write("camera.xml", two);
  vpVlpRig rig = vpVlpRig::load(folder.write("rig.yaml", minimal));
  vpExpectError([&] { rig.save(folder / "rig.yaml"); }, {folder / "camera.xml: holds other cameras"});
  EXPECT_EQ(folder.read("camera.xml"), two);
  EXPECT_EQ(folder.read("rig.yaml"), minimal);
  EXPECT_EQ(folder.count(), 2u);

  folder.write("camera.xml", xml); // holds just this camera: stays as it is, comments and all
  rig.save(folder / "rig.yaml");
  EXPECT_EQ(folder.read("camera.xml"), xml);
  rig.camera = vpCameraParameters(1, 2, 3, 4);
  rig.save(folder / "rig.yaml");
  expectSame(vpVlpRig::load(folder / "rig.yaml").camera, rig.camera);
}

TEST(VlpRig, BadFilesAreRefusedWithFileLineAndField)
{
  struct Bad {
    std::string text;
    std::vector<std::string> parts;
  };
  const std::string mount = minimal + "mount: {translation_m: [0, 0, 0.19], rotation_rpy_deg: [0, 0, 180]}\n";
  const std::string resize = minimal + "resize: {method: nearest, source_size: [2048, 1536]}\n";
  const std::vector<Bad> all = {
      {shutterLine, {":1: camera: missing, expected a mapping"}},
      {with(minimal, "{file: camera.xml, name: UB300}", "camera.xml"),
       {":1: camera: camera.xml, expected a mapping"}},
      {with(minimal, ", name: UB300", ""), {":1: camera.name: missing, expected text"}},
      {with(minimal, "UB300", "UB301"), {"camera.xml: no camera 'UB301'", "those there: 'UB300'"}},
      {with(minimal, "camera.xml", "none.xml"),
       {":1: camera.file: ", "none.xml: cannot be opened: No such file or directory"}},
      {with(minimal, "UB300", "UB300, size: 3"),
       {":1: camera.size: unknown key, expected one of file, name"}},
      {"camera: {file: camera.xml, name: UB300}\n", {":1: shutter: missing, expected a mapping"}},
      {with(minimal, "row_time_s: 43.1e-6, ", ""),
       {":2: shutter.row_time_s: missing, expected a number above 0"}},
      {with(minimal, "43.1e-6", "0"), {":2: shutter.row_time_s: 0, expected a number above 0"}},
      {with(minimal, "43.1e-6", "43.1"), {":2: shutter.row_time_s: 43.1, expected seconds, up to 0.01"}},
      {with(minimal, "43.1e-6", "43.1 us"), {":2: shutter.row_time_s: 43.1 us, expected a number above 0"}},
      {with(minimal, "exposure_s: 50e-6, ", ""), {":2: shutter.exposure_s: missing"}},
      {with(minimal, "50e-6", "-50e-6"), {":2: shutter.exposure_s: -50e-6, expected a number above 0"}},
      {with(minimal, ", readout: rows", ""),
       {":2: shutter.readout: missing, expected one of rows, rows_reversed, "}},
      {with(minimal, "readout: rows", "readout: up"),
       {":2: shutter.readout: up, expected one of rows, rows_reversed, "}},
      {with(minimal, "UB300}", "UB300, focal_length_sigma: -1}"),
       {":1: camera.focal_length_sigma: -1, expected"}},
      {with(minimal, "UB300}", "UB300, principal_point_sigma_px: wide}"),
       {":1: camera.principal_point_sigma_px: wide, expected"}},
      {with(minimal, "rows}", "rows, row_time_sigma_s: -1}"), {":2: shutter.row_time_sigma_s: -1, expected"}},
      {with(resize, "nearest", "cubic"), {":3: resize.method: cubic, expected one of nearest, area"}},
      {with(resize, "2048, 1536", "2048"), {":3: resize.source_size: a list of 1, expected 2 numbers"}},
      {with(resize, "2048", "2048.5"),
       {":3: resize.source_size: [2048.5, 1536], expected two whole numbers"}},
      {with(resize, "2048", "1e9"), {":3: resize.source_size: [1e+09, 1536], expected two whole numbers"}},
      {with(resize, "1536", "599"), {":3: resize.source_size: [2048, 599]", "at least", "[800, 600]"}},
      {with(resize, ", source_size: [2048, 1536]", ""), {":3: resize.source_size: missing"}},
      {with(mount, "translation_m: [0, 0, 0.19], ", ""),
       {":3: mount.translation_m: missing, expected 3 numbers"}},
      {with(mount, "0, 0, 180", "0, up, 0"), {":3: mount.rotation_rpy_deg[1]: up, expected a finite number"}},
      {with(mount, "180]", "180], rotation_sigma_deg: [1, 1, -1]"),
       {":3: mount.rotation_sigma_deg[2]: -1, expected"}},
      {with(mount, "180]", "180], translation_sigma_m: 0.1"),
       {":3: mount.translation_sigma_m: 0.1, expected 3 numbers"}},
      {mount + "lens: f2.8\n", {":4: lens: unknown key, expected one of camera, shutter, resize, mount"}},
      {"rig", {":1: rig, expected a mapping"}},
  };
  for (const Bad &bad : all) {
    SCOPED_TRACE(bad.text);
    const vpTemporaryFolder folder;
    folder.write("camera.xml", xml);
    const std::string file = folder.write("rig.yaml", bad.text);
    vpExpectError([&] { vpVlpRig::load(file); }, bad.parts);
  }
}

TEST(CameraXml, BadFilesAreRefusedWithFileLineAndField)
{
  struct Bad {
    std::string text;
    std::vector<std::string> parts;
  };
  const std::vector<Bad> all = {
      {"", {"camera.xml:1: not XML: "}},
      {"camera: UB300\n", {"camera.xml:1: not XML: "}},
      {"<root>\n<camera>\n", {"camera.xml:", "not XML: "}},
      {xml.substr(0, xml.size() / 2), {"camera.xml:", "not XML: "}},
      {"<root></root>\n", {"camera.xml: no camera 'UB300', expected one of those there: none"}},
      {with(xml, "UB300", "ub300"), {"camera.xml: no camera 'UB300'", "'ub300'"}},
      {with(xml, "</camera>\n", "</camera>\n" + camera), {"camera.xml:8: camera: 'UB300' a second time"}},
      {with(xml, model, model + model),
       {"camera.xml:7: camera 'UB300'.model: a second projection model, expected one"}},
      {with(xml, model, ""), {"camera.xml:4: camera 'UB300'.model: missing"}},
      {with(xml, "<image_width>800</image_width>", ""),
       {"camera.xml:4: camera 'UB300'.image_width: missing"}},
      {with(xml, "800", "-1"), {"camera.xml:5: camera 'UB300'.image_width: -1, expected a number above 0"}},
      {with(xml, "800", "80.5"), {"camera.xml:5: camera 'UB300'.image_width: 80.5, expected a whole number"}},
      {with(xml, "800", "4000000000"),
       {"camera.xml:5: camera 'UB300'.image_width: 4000000000, expected a whole number"}},
      {with(xml, "<px>906.25", "<px>f"),
       {"camera.xml:7: camera 'UB300'.model.px: f, expected a number above 0"}},
      {with(xml, "<py>906.25", "<py>0"),
       {"camera.xml:7: camera 'UB300'.model.py: 0, expected a number above 0"}},
      {with(xml, "<u0>417", "<u0>nan"),
       {"camera.xml:7: camera 'UB300'.model.u0: nan, expected a finite number"}},
      {with(xml, "<v0>341", "<v0>-100341"),
       {"camera.xml:7: camera 'UB300'.model.v0: -100341, expected pixels, from -100000 to 100000"}},
      {with(xml, "<v0>341</v0>", ""), {"camera.xml:6: camera 'UB300'.model.v0: missing"}},
      {with(xml, "<v0>341</v0>", "<v0>1</v0><v0>1</v0>"), {"camera.xml:7: camera 'UB300'.model.v0: twice"}},
      {with(xml, "<v0>341</v0>", "<v0>341</v0><k1>0</k1>"),
       {"camera.xml:7: camera 'UB300'.model.k1: unknown element"}},
      {with(xml, "<image_width>", "<width>1</width><image_width>"),
       {"camera 'UB300'.width: unknown element"}},
      {with(xml, "perspectiveProjWithoutDistortion", "pinhole"),
       {"camera.xml:6: camera 'UB300'.model.type: pinhole, expected one of "
        "perspectiveProjWithoutDistortion, "}},
      {with(xml, "WithoutDistortion", "WithDistortion"), {"camera.xml:6: camera 'UB300'.model.kud: missing"}},
  };
  for (const Bad &bad : all) {
    SCOPED_TRACE(bad.text);
    const vpTemporaryFolder folder;
    const std::string file = folder.write("camera.xml", bad.text);
    vpExpectError([&] { vpCameraXml::load(file, "UB300"); }, bad.parts);
  }
}

//! Files go both ways between ours and ViSP's own parser.
TEST(CameraXml, AgreesWithViSP)
{
  for (const vpCameraParameters &parameters : cameras()) {
    const vpTemporaryFolder folder;
    vpXmlParserCamera visp;
    ASSERT_EQ(visp.save(parameters, folder / "visp.xml", "one", 640, 480, "<date>today</date>"),
              vpXmlParserCamera::SEQUENCE_OK);
    ASSERT_EQ(visp.save(cameras()[0], folder / "visp.xml", "two", 1280, 960), vpXmlParserCamera::SEQUENCE_OK);
    const vpCameraXml ours = vpCameraXml::load(folder / "visp.xml", "one");
    expectSame(ours.camera, parameters);
    EXPECT_EQ(ours.width, 640u);
    EXPECT_EQ(ours.height, 480u);

    ours.save(folder / "ours.xml");
    vpCameraParameters back;
    vpXmlParserCamera reader;
    ASSERT_EQ(reader.parse(back, folder / "ours.xml", "one", parameters.get_projModel()),
              vpXmlParserCamera::SEQUENCE_OK);
    expectSame(back, parameters);
    EXPECT_EQ(reader.getWidth(), 640u);
    EXPECT_EQ(reader.getHeight(), 480u);
  }
}
