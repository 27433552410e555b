/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// What rosbag recorded, as the folder of a run: for vlp-locate, vlp-calibrate and mvcam.

#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpAtomicFile.h>
#include <visp3/vlp_core/vpNewFolder.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_sensor/vpWritePicture.h>

#include "vpPictures.h"
#include "vpRosMessages.h"

namespace
{
struct Options {
  std::string bag, out, image, odom, rig, lamps;
};

//! A picture, raw or compressed; nothing where the message is another.
std::optional<vpVlpFrame> frameOf(const rosbag::MessageInstance &message)
{
  if (const auto image = message.instantiate<sensor_msgs::Image>()) {
    return vpRosMessages::frame(*image);
  }
  if (const auto image = message.instantiate<sensor_msgs::CompressedImage>()) {
    return vpDecoded(*image);
  }
  return std::nullopt;
}

void convert(const Options &options)
{
  rosbag::Bag bag(options.bag);
  vpNewFolder folder(options.out);
  vpAtomicFile list(folder.file("frames.csv"));
  list.stream() << "timestamp_s,file\n";
  std::vector<vpOdometry> odometry;
  size_t frames = 0;
  for (const rosbag::MessageInstance &message :
       rosbag::View(bag, rosbag::TopicQuery(std::vector<std::string>{options.image, options.odom}))) {
    if (const auto odom = message.instantiate<nav_msgs::Odometry>()) {
      const vpOdometry sample = vpRosMessages::odometry(*odom);
      if (odometry.empty() || sample.timestamp > odometry.back().timestamp) {
        odometry.push_back(sample);
      }
    } else if (const std::optional<vpVlpFrame> frame = frameOf(message)) {
      std::string name = std::to_string(frames++);
      name = std::string(6 - std::min<size_t>(6, name.size()), '0') + name + ".png";
      const cv::Mat grey(static_cast<int>(frame->I.getHeight()), static_cast<int>(frame->I.getWidth()),
                         CV_8UC1,
                         const_cast<unsigned char *>(frame->I.bitmap)); // which is only read
      vpWritePicture(folder.file(name), grey);
      list.stream() << vpNumberText(frame->timestamp) << "," << name << "\n";
    }
  }
  if (frames == 0) {
    throw vpException(vpException::badValue,
                      options.bag + ": no picture on " + options.image + " (--image names the topic)");
  }
  list.commit();
  if (!odometry.empty()) {
    vpWriteOdometry(folder.file("odometry.csv"), odometry);
  }
  if (!options.rig.empty()) {
    vpVlpRig::load(options.rig).save(folder.file("rig.yaml"));
  }
  if (!options.lamps.empty()) {
    vpLampMap::load(options.lamps).save(folder.file("lamps.yaml"));
  }
  folder.commit();
  std::cout << options.out << ": " << frames << " frames, " << odometry.size() << " samples of odometry\n";
}
} // namespace

int main(int argc, char **argv)
{
  Options options;
  CLI::App app("What rosbag recorded, as the folder of a run.\n", "bag_to_run");
  app.footer(
      "\nExample:\n  bag_to_run drive.bag --image /robot1/camera/image --odom /robot1/odom --rig rig.yaml"
      " --lamps lamps.yaml --out drive\n  vlp-locate --run drive --overlay look\n\n"
      "Exit code: 0 done; 2 bad usage or bad input.\n");
  app.add_option("bag", options.bag, "the recording")->required();
  app.add_option("--out", options.out, "the folder, which must not be there")->required();
  app.add_option("--image", options.image,
                 "topic of the pictures, raw or compressed (default /camera/image)");
  app.add_option("--odom", options.odom, "topic of the odometry (default /odom)");
  app.add_option("--rig", options.rig, "a rig.yaml that goes along");
  app.add_option("--lamps", options.lamps, "a lamps.yaml that goes along");
  options.image = "/camera/image";
  options.odom = "/odom";
  try {
    app.parse(argc, argv);
    convert(options);
    return 0;
  } catch (const CLI::Success &help) {
    return app.exit(help);
  } catch (const std::exception &error) { // vpException and rosbag's, too
    std::cerr << "bag_to_run: error: " << error.what() << "\n";
    return 2;
  }
}
