/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpCeilingTags_h
#define vpCeilingTags_h

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>
#include <visp3/core/vpPixelMeterConversion.h>
#include <visp3/detection/vpDetectorAprilTag.h>
#include <visp3/vision/vpPose.h>

#include "vpSpeedScene.h"

/*!
  AprilTags (36h11) on the ceiling where a scene has its lamps, tag k for lamp k of the map, as large as
  these: the side of the black square is the lamp's diameter. The ceiling is lit, and the lamps are off.
*/
class vpCeilingTags
{
public:
  double paper = 200, ink = 20, ceiling = 110; // grey values

  explicit vpCeilingTags(vpSpeedScene &scene) : m_scene(scene)
  {
    const cv::Ptr<cv::aruco::Dictionary> dictionary =
        cv::aruco::getPredefinedDictionary(cv::aruco::DICT_APRILTAG_36h11);
    for (size_t i = 0; i < scene.map().lamps.size(); ++i) {
      cv::Mat_<unsigned char> marker;
      dictionary->drawMarker(static_cast<int>(i), cells, marker, 1); // a pixel for each cell
      cv::copyMakeBorder(marker, marker, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar::all(255));
      m_markers.push_back(marker);
    }
  }

  //! What the camera of the scene's stills sees of them: same places, blur, noise and clutter.
  std::vector<vpVlpFrame> stills()
  {
    vpSimulatedScene others = m_scene.scene();
    others.ambient = ceiling;
    others.ceilingShare = 0;
    others.lamps.erase(others.lamps.begin(), others.lamps.begin() + static_cast<long>(m_markers.size()));
    const vpRollingShutterRenderer renderer(m_scene.camera());
    std::vector<vpVlpFrame> frames;
    for (const vpVlpFrame &lamps : m_scene.stills()) {
      const vpHomogeneousMatrix wMc = m_scene.wMc(lamps.timestamp);
      cv::Mat_<float> light = renderer.exact(
          others, [&wMc](double) { return wMc; }, lamps.timestamp);
      for (size_t i = 0; i < m_markers.size(); ++i) {
        draw(i, wMc, light);
      }
      vpVlpFrame frame;
      frame.timestamp = lamps.timestamp;
      expose(light, frames.size(), frame.I);
      frames.push_back(std::move(frame));
    }
    return frames;
  }

private:
  static constexpr int cells = 8; // of a marker's side, black border included

  //! Paints one tag: points of each pixel counted, then blurred as the lens does.
  void draw(size_t tag, const vpHomogeneousMatrix &wMc, cv::Mat_<float> &light) const
  {
    const vpLamp &lamp = m_scene.map().lamps[tag];
    const vpCameraParameters &camera = m_scene.rig().camera;
    const double height = lamp.position.z() - wMc[2][3]; // the camera is level
    const Eigen::Vector2d middle = m_scene.pixelOf(lamp.position, wMc);
    const int reach = static_cast<int>(std::ceil(m_scene.diameterOf(lamp))), margin = 6;
    cv::Rect box(cvRound(middle.x()) - reach - margin, cvRound(middle.y()) - reach - margin,
                 2 * (reach + margin) + 1, 2 * (reach + margin) + 1);
    box &= cv::Rect(0, 0, light.cols, light.rows);
    cv::Mat_<float> part = light(box).clone();
    static const int points = 5; // of a pixel, along each side
    for (int y = 0; y < part.rows; ++y) {
      for (int x = 0; x < part.cols; ++x) {
        double sum = 0;
        int in = 0;
        for (int k = 0; k < points * points; ++k) {
          const double u = box.x + x + (k % points + 0.5) / points - 0.5,
                       v = box.y + y + (k / points + 0.5) / points - 0.5;
          const double cx = height * (u - camera.get_u0()) / camera.get_px(),
                       cy = height * (v - camera.get_v0()) / camera.get_py();
          // Seen from below: the tag's rows run along y of the map, its columns along x.
          const double column = cells * (wMc[0][0] * cx + wMc[0][1] * cy + wMc[0][3] - lamp.position.x()) /
                                    lamp.size +
                                0.5 * cells + 1,
                       row = cells * (wMc[1][0] * cx + wMc[1][1] * cy + wMc[1][3] - lamp.position.y()) /
                                 lamp.size +
                             0.5 * cells + 1;
          if (row >= 0 && column >= 0 && row < cells + 2 && column < cells + 2) {
            ++in;
            sum += m_markers[tag](static_cast<int>(row), static_cast<int>(column)) > 0 ? paper : ink;
          }
        }
        part(y, x) = static_cast<float>((sum + (points * points - in) * part(y, x)) / (points * points));
      }
    }
    cv::GaussianBlur(part, part, cv::Size(), m_scene.camera().blur);
    part.copyTo(light(box));
  }

  //! Noise as of the lamps' frames, then 8 bits.
  void expose(const cv::Mat_<float> &light, size_t seed, vpImage<unsigned char> &I) const
  {
    const vpSimulatedCamera &camera = m_scene.camera();
    cv::RNG generator(seed + 1);
    cv::Mat_<float> noise(light.size());
    generator.fill(noise, cv::RNG::NORMAL, 0, 1);
    const double photons = camera.photonsPerLevel > 0 ? 1 / camera.photonsPerLevel : 0;
    I.resize(static_cast<unsigned int>(light.rows), static_cast<unsigned int>(light.cols));
    for (int y = 0; y < light.rows; ++y) {
      for (int x = 0; x < light.cols; ++x) {
        const double sigma = std::sqrt(camera.readNoise * camera.readNoise + photons * light(y, x));
        I[static_cast<unsigned int>(y)][static_cast<unsigned int>(x)] =
            cv::saturate_cast<unsigned char>(light(y, x) + sigma * noise(y, x));
      }
    }
  }

  vpSpeedScene &m_scene;
  std::vector<cv::Mat_<unsigned char>> m_markers;
};

//! ViSP's detector on one thread, and the pose of the robot from the corners of all tags.
class vpTagLocalizer
{
public:
  //! \param decimate, blur Of the picture in which quadrilaterals are looked for: resized by, px of Gaussian.
  vpTagLocalizer(const vpVlpRig &rig, const vpLampMap &map, float decimate, float blur)
      : m_rig(rig), m_map(map), m_detector(vpDetectorAprilTag::TAG_36h11)
  {
    m_detector.setAprilTagNbThreads(1);
    m_detector.setAprilTagQuadDecimate(decimate);
    m_detector.setAprilTagQuadSigma(blur);
  }

  vpSpeedResult process(const vpImage<unsigned char> &I)
  {
    vpSpeedResult result;
    if (!m_detector.detect(I)) {
      return result;
    }
    const std::vector<int> ids = m_detector.getTagsId();
    const std::vector<std::vector<vpImagePoint>> corners = m_detector.getTagsCorners();
    // The map, from the first tag: vpPose takes points about the origin better.
    vpPose pose;
    const vpLamp *origin = nullptr;
    for (size_t i = 0; i < ids.size(); ++i) {
      if (ids[i] < 0 || static_cast<size_t>(ids[i]) >= m_map.lamps.size()) {
        continue;
      }
      const vpLamp &lamp = m_map.lamps[static_cast<size_t>(ids[i])];
      origin = origin ? origin : &lamp;
      Eigen::Vector2d middle(0, 0);
      for (size_t k = 0; k < 4; ++k) {
        const Eigen::Vector2d pixel = pixelOf(corners[i][k]);
        middle += 0.25 * pixel;
        addCorner(lamp, k, lamp.position - origin->position, pixel, pose);
      }
      result.seen.push_back({lamp.id, middle});
    }
    vpHomogeneousMatrix cMo;
    if (origin && pose.computePose(vpPose::DEMENTHON_VIRTUAL_VS, cMo)) {
      const vpHomogeneousMatrix wMo(origin->position.x(), origin->position.y(), origin->position.z(), 0, 0,
                                    0);
      result.wMb = wMo * cMo.inverse() * m_rig.bMc.inverse();
    }
    return result;
  }

private:
  //! AprilTag has pixel centres at halves, ViSP at integers; vpDetectorAprilTag of ViSP 3.5 hands its corners
  //! on as they are.
  static Eigen::Vector2d pixelOf(const vpImagePoint &corner)
  {
    return {corner.get_u() - 0.5, corner.get_v() - 0.5};
  }

  void addCorner(const vpLamp &tag, size_t corner, const Eigen::Vector3d &middle,
                 const Eigen::Vector2d &pixel, vpPose &pose) const
  {
    static const int xs[] = {1, -1, -1, 1}, ys[] = {-1, -1, 1, 1}; // as OpenCV draws and ViSP numbers them
    vpPoint point(middle.x() + 0.5 * tag.size * xs[corner], middle.y() + 0.5 * tag.size * ys[corner],
                  middle.z());
    double x = 0, y = 0;
    vpPixelMeterConversion::convertPoint(m_rig.camera, pixel.x(), pixel.y(), x, y);
    point.set_x(x);
    point.set_y(y);
    pose.addPoint(point);
  }

  vpVlpRig m_rig;
  vpLampMap m_map;
  vpDetectorAprilTag m_detector;
};

#endif
