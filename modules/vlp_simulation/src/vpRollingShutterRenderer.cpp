/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_simulation/vpRollingShutterRenderer.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <opencv2/imgproc.hpp>
#include <visp3/core/vpException.h>
#include <visp3/core/vpRotationMatrix.h>
#include <visp3/vlp_core/vpNumberText.h>

#include "vpEmitterView.h"
#include "vpNormalNoise.h"
#include "vpPhonePicture.h"
#include "vpScatteredLight.h"
#include "vpSensorGrid.h"
#include "vpSilhouette.h"

BEGIN_VISP_NAMESPACE

namespace
{
void expect(bool good, const char *field, double came, const char *expected)
{
  if (!good) {
    throw vpException(vpException::badValue, std::string("simulated camera: ") + field + ": " +
                                                 vpNumberText(came) + ", expected " + expected);
  }
}

const vpSimulatedCamera &checked(const vpSimulatedCamera &camera)
{
  const char *const notNegative = "a number of 0 or more";
  const char *const positive = "a number above 0";
  expect(camera.rig.width > 0, "picture width", camera.rig.width, positive);
  expect(camera.rig.height > 0, "picture height", camera.rig.height, positive);
  expect(camera.rig.shutter.exposure > 0, "exposure, s", camera.rig.shutter.exposure, positive);
  expect(camera.rig.shutter.rowTime > 0, "row time, s", camera.rig.shutter.rowTime, positive);
  expect(camera.blur >= 0, "blur, px", camera.blur, notNegative);
  expect(camera.haloShare >= 0 && camera.haloShare <= 1, "halo share", camera.haloShare, "0 to 1");
  expect(camera.haloShare == 0 || camera.haloRadius >= 2, "halo radius, px", camera.haloRadius, "2 or more");
  expect(camera.vignetting >= 0, "vignetting", camera.vignetting, notNegative);
  expect(camera.readNoise >= 0, "read noise, grey levels", camera.readNoise, notNegative);
  expect(camera.photonsPerLevel >= 0, "photons per grey level", camera.photonsPerLevel, notNegative);
  expect(camera.handBlur >= 0 && camera.handBlur <= 50, "hand blur, px", camera.handBlur, "0 to 50");
  return camera;
}

cv::Mat_<float> vignette(const vpSensorGrid &grid, double exponent)
{
  cv::Mat_<float> share(grid.lines(), grid.samples(), 1.f);
  for (int line = 0; exponent > 0 && line < share.rows; ++line) {
    for (int sample = 0; sample < share.cols; ++sample) {
      // cos of the angle off the axis is 1 / sqrt(1 + x^2 + y^2)
      share(line, sample) =
          static_cast<float>(std::pow(1 + grid.ray(line, sample).squaredNorm(), -0.5 * exponent));
    }
  }
  return share;
}

//! What the sensor can tell apart. No number beyond, nor one that is none, may become an index or wrap
//! around.
float clipped(float grey)
{
  return grey > 0 ? std::min(grey, 255.f) : 0.f;
}

//! The part of the grid that the emitter may be seen in.
cv::Rect boxOf(const vpEmitter &emitter, const std::vector<vpHomogeneousMatrix> &wMc,
               const vpSensorGrid &grid, double margin)
{
  Eigen::Vector2d least(1e9, 1e9), most(-1e9, -1e9);
  for (const vpHomogeneousMatrix &pose : wMc) {
    const vpEmitterView view(emitter, pose);
    if (!view.visible()) {
      continue;
    }
    static const int corners = 16; // of a polygon about the disc
    const double reach = emitter.reach() / std::cos(M_PI / corners);
    for (int k = 0; k < corners; ++k) {
      const double angle = 2 * M_PI * k / corners;
      const Eigen::Vector3d point = view.inCamera(reach * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
      Eigen::Vector2d pixel;
      if (!grid.project(point, pixel)) {
        return grid.whole(); // a part of it is beside or behind the camera
      }
      least = least.cwiseMin(pixel);
      most = most.cwiseMax(pixel);
    }
  }
  const Eigen::Vector2d wider(margin, margin);
  return grid.within(least - wider, most + wider);
}
} // namespace

struct vpRollingShutterRenderer::Impl {
  explicit Impl(const vpSimulatedCamera &given)
      : camera(given), grid(given.rig), share(grid, given.blur), scattered(grid, given),
        vignetting(vignette(grid, given.vignetting)), noiseOfLevel(256), phone(given)
  {
    for (size_t level = 0; level < noiseOfLevel.size(); ++level) {
      const double photons =
          given.photonsPerLevel > 0 ? static_cast<double>(level) / given.photonsPerLevel : 0;
      noiseOfLevel[level] = static_cast<float>(std::sqrt(given.readNoise * given.readNoise + photons));
    }
  }

  cv::Mat_<float> light(const vpSimulatedScene &scene, const Poses &wMc, double timestamp) const;
  void paint(const vpEmitter &emitter, const vpEmitterShare &share, const cv::Rect &box, const Poses &wMc,
             double timestamp, cv::Mat_<float> &light) const;
  void addScattered(const std::vector<vpScatteredLight::Lamp> &lamps, double timestamp,
                    cv::Mat_<float> &light) const;
  cv::Mat_<float> inHand(const vpSimulatedScene &scene, const Poses &wMc, double timestamp,
                         std::uint64_t seed) const;
  cv::Mat_<float> measured(const cv::Mat_<float> &light, std::uint64_t seed) const;
  cv::Mat resized(const cv::Mat &picture) const;

  double middle(int line, double timestamp) const
  {
    return timestamp + grid.start(line) + 0.5 * grid.exposure();
  }

  vpSimulatedCamera camera;
  vpSensorGrid grid;
  vpEmitterShare share;
  vpScatteredLight scattered;
  cv::Mat_<float> vignetting;
  std::vector<float> noiseOfLevel; // grey levels
  vpPhonePicture phone;
};

//! Adds what comes straight from the emitter.
void vpRollingShutterRenderer::Impl::paint(const vpEmitter &emitter, const vpEmitterShare &share,
                                           const cv::Rect &box, const Poses &wMc, double timestamp,
                                           cv::Mat_<float> &light) const
{
  if (box.empty()) {
    return; // beside the picture, where there are no rays
  }
  for (int line = box.y; line < box.br().y; ++line) {
    const double start = timestamp + grid.start(line);
    const vpLampLight::Exposed exposed = emitter.light->over(start, start + grid.exposure());
    if (exposed.share <= 0) {
      continue;
    }
    const vpEmitterView view(emitter, wMc(exposed.middle));
    if (!view.visible()) {
      continue;
    }
    // m: what is nearer to the outline than this gets its exact share; pixels are no larger anywhere in the
    // lamp.
    Eigen::Vector2d first, last;
    const int edges[2] = {box.x, box.br().x - 1};
    const bool seen = view.at(grid.ray(line, edges[0]), first) && view.at(grid.ray(line, edges[1]), last);
    const double span = (grid.pixel(line, edges[1]) - grid.pixel(line, edges[0])).norm();
    double band = 1e9, spread = 0; // m, m^2
    if (seen && span > 0) {
      const Eigen::Vector2d between = grid.pixel(line, (edges[0] + edges[1]) / 2);
      const double step =
          std::max((last - first).norm() / span, share.longestStep(view, between)); // m per pixel
      band = 1.5 * share.band() * step;
      spread = 2 * share.variance() * step * step;
    }
    float *row = light[line];
    for (int sample = box.x; sample < box.br().x; ++sample) {
      const Eigen::Vector2d ray = grid.ray(line, sample);
      Eigen::Vector2d at;
      if (!view.at(ray, at)) {
        continue;
      }
      const Eigen::Vector2d beyond = at.cwiseAbs() - Eigen::Vector2d(emitter.halfX, emitter.halfY);
      const double outside = emitter.disc ? at.norm() - emitter.halfX : beyond.maxCoeff();
      if (outside > band) {
        continue;
      }
      double covered = 1;
      if (outside > -band) {
        covered = share.at(emitter, view, grid.pixel(line, sample), at);
      } else if (emitter.rim > 0) {
        covered -= emitter.rim * (at.squaredNorm() + spread) / (emitter.halfX * emitter.halfX);
      }
      if (emitter.emission && covered > 0) {
        covered *= share.emission(emitter, view, grid.pixel(line, sample), at);
      }
      if (emitter.exponent != 0) {
        covered *= std::pow(view.cosine(ray), emitter.exponent);
      }
      row[sample] += static_cast<float>(emitter.level * exposed.share * covered);
    }
  }
}

void vpRollingShutterRenderer::Impl::addScattered(const std::vector<vpScatteredLight::Lamp> &lamps,
                                                  double timestamp, cv::Mat_<float> &light) const
{
  if (lamps.empty()) {
    return;
  }
  const vpNodeGrid &nodes = scattered.nodes();
  std::vector<float> sum(nodes.samples.size());
  for (int line = 0; line < light.rows; ++line) {
    float way;
    const int above = nodes.before(line, way);
    const int below = std::min(above + 1, nodes.size().height - 1);
    std::fill(sum.begin(), sum.end(), 0.f);
    const double start = timestamp + grid.start(line);
    for (const vpScatteredLight::Lamp &lamp : lamps) {
      const auto lit = static_cast<float>(lamp.emitter->light->over(start, start + grid.exposure()).share);
      const float *upper = lamp.light[above], *lower = lamp.light[below];
      for (size_t k = 0; k < sum.size(); ++k) {
        sum[k] += lit * (upper[k] + way * (lower[k] - upper[k]));
      }
    }
    float *row = light[line];
    for (size_t k = 0; k + 1 < sum.size(); ++k) {
      const int from = nodes.samples[k], to = nodes.samples[k + 1];
      const float slope = (sum[k + 1] - sum[k]) / static_cast<float>(to - from);
      for (int sample = from; sample < to; ++sample) {
        row[sample] += sum[k] + slope * static_cast<float>(sample - from);
      }
    }
    row[light.cols - 1] += sum.back();
  }
}

//! Grey values before noise, saturation and rounding, lines and samples.
cv::Mat_<float> vpRollingShutterRenderer::Impl::light(const vpSimulatedScene &scene, const Poses &wMc,
                                                      double timestamp) const
{
  std::vector<vpEmitter> emitters(scene.lamps.begin(), scene.lamps.end());
  for (const vpSimulatedLamp &image : scene.images) {
    emitters.emplace_back(image);
  }
  for (const vpSimulatedWindow &window : scene.windows) {
    emitters.emplace_back(window);
  }

  const vpNodeGrid &nodes = scattered.nodes();
  std::vector<vpHomogeneousMatrix> poses; // of the lines of nodes
  std::vector<double> times;
  for (int line : nodes.lines) {
    times.push_back(middle(line, timestamp));
    poses.push_back(wMc(times.back()));
  }
  cv::Mat_<float> light(grid.lines(), grid.samples(), static_cast<float>(scene.ambient));
  addScattered(scattered.of(emitters, scene, poses), timestamp, light);
  for (const vpEmitter &emitter : emitters) {
    if (emitter.blur > 0) {
      const vpEmitterShare softer(grid, std::hypot(camera.blur, emitter.blur));
      paint(emitter, softer, boxOf(emitter, poses, grid, softer.band() + 2), wMc, timestamp, light);
    } else {
      paint(emitter, share, boxOf(emitter, poses, grid, share.band() + 2), wMc, timestamp, light);
    }
  }
  const vpSilhouette silhouette(grid, nodes, camera.blur, scene, poses, times);
  for (int line = 0; !silhouette.empty() && line < light.rows; ++line) {
    const double time = middle(line, timestamp);
    silhouette.hide(line, wMc(time), time, light[line]);
  }
  return light.mul(vignetting);
}

//! The same seen by a hand that turns the camera evenly during each exposure.
cv::Mat_<float> vpRollingShutterRenderer::Impl::inHand(const vpSimulatedScene &scene, const Poses &wMc,
                                                       double timestamp, std::uint64_t seed) const
{
  if (camera.handBlur == 0) {
    return light(scene, wMc, timestamp);
  }
  const vpCameraParameters sensor =
      camera.rig.resize.sensor(camera.rig.camera, camera.rig.width, camera.rig.height);
  const double direction = M_PI * vpNormalNoise(seed, 0).uniform();
  static const double step = 0.5; // px, well within the blur of a pixel's square
  const int steps = std::max(2, static_cast<int>(std::ceil(camera.handBlur / step)));
  cv::Mat_<float> sum(grid.lines(), grid.samples(), 0.f);
  for (int k = 0; k < steps; ++k) {
    const double along = camera.handBlur * ((k + 0.5) / steps - 0.5); // px
    const double du = along * std::cos(direction), dv = along * std::sin(direction);
    vpHomogeneousMatrix turn;
    turn.insert(vpRotationMatrix(dv * sensor.get_py_inverse(), -du * sensor.get_px_inverse(), 0));
    sum += light(
        scene, [&](double time) { return wMc(time) * turn; }, timestamp);
  }
  return sum / steps;
}

//! With the noise of photons and readout.
cv::Mat_<float> vpRollingShutterRenderer::Impl::measured(const cv::Mat_<float> &light,
                                                         std::uint64_t seed) const
{
  cv::RNG random(seed * 0x9e3779b97f4a7c15ULL + 0x632be59bd9b4e019ULL); // neighbouring seeds lead far apart
  cv::Mat_<float> noise(1, light.cols);
  cv::Mat_<float> grey(light.size());
  static constexpr float farBeyond =
      1e6f; // grey levels: fits a whole number, and is black or white all the same
  for (int line = 0; line < light.rows; ++line) {
    random.fill(noise, cv::RNG::NORMAL, 0, 1);
    const float *in = light[line], *normal = noise[0];
    float *out = grey[line];
    for (int sample = 0; sample < light.cols; ++sample) {
      const float value =
          in[sample] + noiseOfLevel[static_cast<size_t>(clipped(in[sample]))] * normal[sample];
      out[sample] = std::min(std::max(-farBeyond, value), farBeyond); // what is none at all becomes dark
    }
  }
  return grey;
}

//! The picture as software hands it on.
cv::Mat vpRollingShutterRenderer::Impl::resized(const cv::Mat &picture) const
{
  if (camera.rig.resize.method != vpPictureResize::Method::area) {
    return picture;
  }
  cv::Mat small;
  const cv::Size size(static_cast<int>(camera.rig.width), static_cast<int>(camera.rig.height));
  cv::resize(picture, small, size, 0, 0, cv::INTER_AREA);
  return small;
}

vpRollingShutterRenderer::vpRollingShutterRenderer(const vpSimulatedCamera &camera)
    : m_impl(std::make_unique<Impl>(checked(camera)))
{
}

vpRollingShutterRenderer::~vpRollingShutterRenderer() = default;

void vpRollingShutterRenderer::render(const vpSimulatedScene &scene, const Poses &wMc, double timestamp,
                                      std::uint64_t seed, vpImage<unsigned char> &I) const
{
  const cv::Mat_<float> measured =
      m_impl->grid.upright(m_impl->measured(m_impl->inHand(scene, wMc, timestamp, seed), seed));
  const cv::Mat_<unsigned char> grey = m_impl->resized(m_impl->phone.of(measured, seed));
  I.resize(static_cast<unsigned int>(grey.rows), static_cast<unsigned int>(grey.cols));
  cv::Mat_<unsigned char> view(grey.rows, grey.cols, I.bitmap);
  grey.copyTo(view);
}

cv::Mat_<float> vpRollingShutterRenderer::exact(const vpSimulatedScene &scene, const Poses &wMc,
                                                double timestamp) const
{
  return m_impl->resized(m_impl->grid.upright(m_impl->light(scene, wMc, timestamp)));
}

END_VISP_NAMESPACE
