/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpAlteration_h
#define vpAlteration_h

#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <visp3/vlp_core/vpVlpRig.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

/*!
  A picture as another camera would have taken it, in this order: resampled, mirrored, 255 gain (grey /
  255)^gamma, noise, rounding to 8 bits, JPEG.
*/
struct vpAlteration {
  std::string name = "as they are";
  double scale = 1, gain = 1, gamma = 1;
  double noise = 0; // grey levels, standard deviation; black and white clip it
  int jpeg = 0;     // quality; 0: none
  bool flipColumns = false, flipRows = false;

  vpImage<unsigned char> applied(const vpImage<unsigned char> &I) const
  {
    const cv::Mat_<unsigned char> grey(static_cast<int>(I.getHeight()), static_cast<int>(I.getWidth()),
                                       I.bitmap);
    cv::Mat light, altered;
    grey.convertTo(light, CV_32F, 1. / 255);
    if (scale != 1) {
      cv::resize(light, light, cv::Size(), scale, scale, scale < 1 ? cv::INTER_AREA : cv::INTER_LINEAR);
    }
    if (flipColumns || flipRows) {
      cv::flip(light, light, flipColumns && flipRows ? -1 : flipColumns ? 1 : 0);
    }
    cv::pow(light, gamma, light);
    light *= 255 * gain;
    if (noise > 0) {
      cv::RNG generator(7);
      cv::Mat random(light.size(), CV_32F);
      generator.fill(random, cv::RNG::NORMAL, 0, noise);
      light += random;
    }
    light.convertTo(altered, CV_8U);
    if (jpeg > 0) {
      std::vector<unsigned char> bytes;
      cv::imencode(".jpg", altered, bytes, {cv::IMWRITE_JPEG_QUALITY, jpeg});
      altered = cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
    }
    return vpImage<unsigned char>(altered.data, static_cast<unsigned int>(altered.rows),
                                  static_cast<unsigned int>(altered.cols), true);
  }

  //! Where a point of the picture lies then, px. \param I The altered picture.
  Eigen::Vector2d applied(const Eigen::Vector2d &point, const vpImage<unsigned char> &I) const
  {
    const Eigen::Vector2d at =
        scale * (point + Eigen::Vector2d::Constant(0.5)) - Eigen::Vector2d::Constant(0.5);
    return {flipColumns ? I.getWidth() - 1 - at.x() : at.x(), flipRows ? I.getHeight() - 1 - at.y() : at.y()};
  }

  //! As a user would state it for the altered picture's camera.
  vpVlpRig applied(vpVlpRig rig, const vpImage<unsigned char> &I) const
  {
    rig.width = I.getWidth();
    rig.height = I.getHeight();
    const Eigen::Vector2d middle = applied(Eigen::Vector2d(rig.camera.get_u0(), rig.camera.get_v0()), I);
    rig.camera.initPersProjWithoutDistortion(scale * rig.camera.get_px(), scale * rig.camera.get_py(),
                                             middle.x(), middle.y());
    rig.shutter.rowTime /= scale;
    rig.shutter.rowTimeSigma /= scale;
    return rig;
  }
};

//! Those under which every lamp of the sets has its id.
inline std::vector<vpAlteration> vpAlterations()
{
  std::vector<vpAlteration> all;
  auto add = [&all](const std::string &name) -> vpAlteration & {
    all.emplace_back();
    all.back().name = name;
    return all.back();
  };
  add("mirrored across columns").flipColumns = true;
  add("mirrored across rows").flipRows = true;
  add("0.8 times as large").scale = 0.8;
  add("1.25 times as large").scale = 1.25;
  add("0.7 times as bright").gain = 0.7;
  add("1.4 times as bright").gain = 1.4;
  add("gamma 0.7").gamma = 0.7;
  add("gamma 1.4").gamma = 1.4;
  add("noise of 4 grey levels").noise = 4;
  return all;
}

#endif
