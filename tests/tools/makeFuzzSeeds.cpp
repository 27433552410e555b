/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Writes what fuzzing begins with, a folder for each target of tests/fuzz: files of data/, and small
// pictures. makeFuzzSeeds FOLDER, from the top of the repository.

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <visp3/core/vpException.h>
#include <visp3/vlp_robot/vpDynamixelPacket.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
namespace fs = std::filesystem;

//! Each file of data/ with that ending, below \e from, for \e target.
void copy(const fs::path &from, const std::string &ending, const fs::path &target)
{
  fs::create_directories(target);
  for (const fs::directory_entry &entry : fs::recursive_directory_iterator(from)) {
    const std::string name = entry.path().filename().string();
    if (name.size() >= ending.size() && name.substr(name.size() - ending.size()) == ending) {
      const std::string folder = entry.path().parent_path().filename().string();
      fs::copy_file(entry.path(), target / (folder + "-" + name), fs::copy_options::overwrite_existing);
    }
  }
}

void write(const fs::path &target, const std::string &name, const std::vector<std::uint8_t> &bytes)
{
  fs::create_directories(target);
  std::ofstream(target / name, std::ios::binary)
      .write(reinterpret_cast<const char *>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

void write(const fs::path &target, const std::string &name, const std::string &text)
{
  write(target, name, std::vector<std::uint8_t>(text.begin(), text.end()));
}

//! A corner of a picture of data/, in each format.
void pictures(const fs::path &target)
{
  const cv::Mat grey = cv::imread("data/paper-room/frame0.png", cv::IMREAD_GRAYSCALE)(cv::Rect(0, 0, 24, 16));
  cv::Mat colour, wide;
  cv::cvtColor(grey, colour, cv::COLOR_GRAY2BGRA);
  grey.convertTo(wide, CV_16U, 256);
  for (const std::string format : {"png", "jpg", "bmp", "pgm", "tiff", "webp"}) {
    std::vector<std::uint8_t> bytes;
    if (cv::imencode("." + format, grey, bytes)) {
      write(target, "grey." + format, bytes);
    }
  }
  for (const auto &[name, picture] :
       {std::make_pair("colour.png", colour), std::make_pair("wide.png", wide)}) {
    std::vector<std::uint8_t> bytes;
    cv::imencode(".png", picture, bytes);
    write(target, name, bytes);
  }
}

void packets(const fs::path &target)
{
  vpDynamixelPacket packet;
  packet.id = 200;
  packet.instruction = vpDynamixelPacket::status;
  packet.parameters = {0, 0x50, 5, 0xFF, 0xFF, 0xFD};
  std::vector<std::uint8_t> bytes = packet.encoded();
  bytes.insert(bytes.begin(), 3); // the pieces' length
  write(target, "status", bytes);
  packet.parameters.assign(172, 7);
  const std::vector<std::uint8_t> longer = packet.encoded();
  bytes.insert(bytes.end(), longer.begin(), longer.end());
  write(target, "two", bytes);
}

//! Targets whose input is a row of decisions begin with random ones.
void decisions(const fs::path &target)
{
  std::mt19937 random(1);
  for (int i = 0; i < 20; ++i) {
    std::vector<std::uint8_t> bytes(static_cast<size_t>(20 * (i + 1)));
    for (std::uint8_t &byte : bytes) {
      byte = static_cast<std::uint8_t>(random());
    }
    write(target, "random" + std::to_string(i), bytes);
  }
}

//! Eight pictures of all lamps in their places.
void drive(const fs::path &target)
{
  std::vector<std::uint8_t> bytes;
  for (int picture = 0; picture < 8; ++picture) {
    bytes.insert(bytes.end(), {132, 10}); // four lamps, the level around them
    for (std::uint8_t lamp = 0; lamp < 4; ++lamp) {
      bytes.insert(bytes.end(),
                   {static_cast<std::uint8_t>(32 + lamp), 8}); // as it is, lit for half of the time
    }
  }
  write(target, "drive", bytes);
}

void run(const fs::path &out)
{
  copy("data/lamps", ".yaml", out / "lamps");
  copy("data/lamps", ".yaml", out / "places");
  write(out / "places", "table.csv", "id,x_m,y_m,z_m\nA,0,0,2\nB,1,0,2\n");
  copy("data/paths", ".yaml", out / "path");
  copy("data/rigs", ".yaml", out / "rig");
  copy("data", ".xml", out / "cameraXml");
  copy("data/scenarios", ".yaml", out / "scenario");
  copy("data", ".tum", out / "trajectory");
  copy("data", "frames.csv", out / "frames");
  write(out / "odometry", "drive.csv", "timestamp_s,v_m_s,w_rad_s\n0,0,0\n0.02,0.1,-0.5\n");
  write(out / "commands", "drive.csv",
        "timestamp_s,v_m_s,w_rad_s,law_v_m_s,law_w_rad_s,share,reference_s_m,reference_v_m_s,reference_"
        "heading_rad,"
        "turning,x_m,y_m,yaw_rad,sigma_m,waiting\n0.02,0.1,0,0.1,0,1,0,0.1,0,0,0,0,0,0.001,\n"
        "0.04,0,0,0,0,0,0,0,0,0,,,,,\"no, pose\"\n");
  write(out / "fixes", "run.csv",
        "timestamp_s,x,y,z,roll,pitch,yaw,sigma_x,sigma_y,sigma_z,sigma_yaw,cov_xy,lamps,state,compute_s\n"
        "0,1,2,0,0,0,0.5,0.001,0.001,0.001,0.002,0,A B,tracking,0.001\n");
  write(out / "cameraInfo", "plumb_bob.yaml",
        "image_width: 800\nimage_height: 600\ncamera_name: UB300\ncamera_matrix:\n  rows: 3\n  cols: 3\n"
        "  data: [416, 0, 399.5, 0, 417, 299.5, 0, 0, 1]\ndistortion_model: plumb_bob\n"
        "distortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [-0.1, 0, 0, 0, 0]\n");
  pictures(out / "picture");
  packets(out / "packets");
  for (const char *const target : {"bus", "observations", "pictures"}) {
    decisions(out / target);
  }
  drive(out / "pictures");
}
} // namespace

int main(int argc, char **argv)
{
  if (argc != 2) {
    std::fprintf(stderr, "makeFuzzSeeds FOLDER\n");
    return 2;
  }
  try {
    run(argv[1]);
    return 0;
  } catch (const vpException &error) {
    std::fprintf(stderr, "makeFuzzSeeds: %s\n", error.getStringMessage().c_str());
    return 2;
  }
}
