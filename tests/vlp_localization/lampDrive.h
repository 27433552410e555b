/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef lampDrive_h
#define lampDrive_h

/*!
  \file lampDrive.h
  A robot that drives under lamps and sees each at a line time of its own, for the tests of the filter.
*/

#include <functional>
#include <string>
#include <vector>

#include <visp3/vlp_localization/vpVlpFilter.h>

#include "lampScene.h"

namespace lampDrive
{
using lampScene::Random;
using lampScene::Sigmas;

//! At constant velocity along x and y of b (m/s) and turn rate (rad/s): an arc.
struct Arc {
  double x = 0, y = 0, yaw = 0; // m, rad; at time 0
  double vx = 0.2, vy = 0, w = 1;

  vpHomogeneousMatrix at(double t) const
  {
    // Integral of the turning velocity.
    const double turned = w * t, s = std::abs(w) > 1e-9 ? std::sin(turned) / w : t,
                 c = std::abs(w) > 1e-9 ? (1 - std::cos(turned)) / w : 0;
    const Eigen::Vector2d way(s * vx - c * vy, c * vx + s * vy);
    const Eigen::Vector2d place = Eigen::Rotation2Dd(yaw) * way + Eigen::Vector2d(x, y);
    return lampScene::frame(place.x(), place.y(), 0, 0, 0, yaw + turned);
  }
};

//! The base at a time, were it level.
using Path = std::function<vpHomogeneousMatrix(double)>;

//! Four lamps and a camera that looks up from a level base, and how far both are off what is claimed of them.
//! Roll and pitch of a true pose are those of the camera.
class Drive
{
public:
  double readout = 0.025; // s, from the first lamp's line to the last one's
  std::vector<Eigen::Vector3d> places = {
      {0.9, 0.1, 2.3}, {-0.2, 0.8, 2.5}, {-0.8, -0.3, 2.2}, {0.3, -0.9, 2.6}};

  Drive(unsigned int seed, const Path &path, const Sigmas &sigmas = Sigmas())
      : m_random(seed), m_path(path), m_sigmas(sigmas),
        m_rig(
            lampScene::withSigmas(lampScene::rigWith(lampScene::frame(0.06, 0.02, 0.2, 0, 0, 0.4)), sigmas)),
        m_lens(m_random, sigmas)
  {
    const Eigen::Vector3d turn = m_random.normal3(sigmas.rotationSigma),
                          shift = m_random.normal3(sigmas.translationSigma);
    m_lean = lampScene::rotation({turn.x(), turn.y(), 0});
    m_bMc = m_lean * lampScene::rotation({0, 0, turn.z()}) * m_rig.bMc;
    m_bMc.insert(vpTranslationVector(0.06 + shift.x(), 0.02 + shift.y(), 0.2 + shift.z()));
    for (size_t k = 0; k < places.size(); ++k) {
      m_hung.push_back(places[k] + m_random.normal3(Eigen::Vector3d::Constant(sigmas.positionSigma)));
    }
  }

  Random &random() { return m_random; }
  const vpVlpRig &rig() const { return m_rig; }
  vpHomogeneousMatrix truth(double t) const { return m_path(t) * m_lean; }

  double lineTime(size_t lamp) const { return readout * static_cast<double>(lamp) / (places.size() - 1.0); }
  double lastLine() const { return readout; }

  vpLampSight sight(size_t lamp, double t)
  {
    vpLampSight seen = lampScene::sightOf(std::string(1, static_cast<char>('A' + lamp)), m_hung[lamp],
                                          m_path(t) * m_bMc, m_sigmas.raySigma);
    seen.position = places[lamp];
    seen.positionSigma = m_sigmas.positionSigma;
    seen.ray = m_lens.seen(seen.ray) +
               Eigen::Vector2d(m_random.normal(m_sigmas.raySigma), m_random.normal(m_sigmas.raySigma));
    return seen;
  }

  //! Near enough to the truth to linearise about.
  void start(vpVlpFilter &filter, double t = 0)
  {
    const vpHomogeneousMatrix off =
        lampScene::frame(m_random.normal(0.003), m_random.normal(0.003), m_random.normal(0.003), 0, 0, 0);
    filter.start(off * m_path(t) * lampScene::rotation({0, 0, m_random.normal(0.003)}), t);
    filter.manoeuvreShare = 0.1;
  }

  //! A frame whose first line is at \e t.
  void frame(vpVlpFilter &filter, double t)
  {
    filter.mark(t);
    for (size_t lamp = 0; lamp < places.size(); ++lamp) {
      filter.advance(t + lineTime(lamp));
      filter.update(sight(lamp, t + lineTime(lamp)));
    }
  }

private:
  Random m_random;
  Path m_path;
  Sigmas m_sigmas;
  vpVlpRig m_rig;
  lampScene::LensError m_lens;
  vpHomogeneousMatrix m_lean, m_bMc;   // as they are
  std::vector<Eigen::Vector3d> m_hung; // m, likewise
};

const double frameTime = 1.0 / 30; // s

inline double distance(const vpHomogeneousMatrix &a, const vpHomogeneousMatrix &b)
{
  return std::hypot(a[0][3] - b[0][3], a[1][3] - b[1][3]);
}

inline double yawOf(const vpHomogeneousMatrix &wMb)
{
  return std::atan2(wMb[1][0], wMb[0][0]);
}

//! x, y and yaw off by no more than so many of their standard deviations each.
inline bool within(double sigmas, const vpVlpFix &fix, const vpHomogeneousMatrix &truth)
{
  const lampScene::Vector6d error = lampScene::poseError(truth, fix.wMb);
  for (int i : {0, 1, 5}) {
    if (!(std::abs(error(i)) <= sigmas * std::sqrt(fix.covariance(i, i)))) {
      return false;
    }
  }
  return true;
}
} // namespace lampDrive

#endif
