/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef reuseScene_h
#define reuseScene_h

/*!
  \file reuseScene.h
  Ceilings whose lamps share identifiers, and what a robot under them sees, for tests and benchmarks of
  vpLampMatcher.
*/

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <visp3/core/vpMeterPixelConversion.h>
#include <visp3/vlp_identification/vpIdentifierLayout.h>
#include <visp3/vlp_localization/vpLampMatcher.h>

#include "common/vpLampGrid.h"
#include "vlp_localization/lampScene.h"

namespace reuseScene
{
using lampScene::Random;

const size_t reflection = vpLampMatch::noLamp;

//! The camera of data/rigs/ub300-800x600.yaml: 4.6 x 3.4 m of a ceiling 3 m high.
inline vpVlpRig rig()
{
  vpVlpRig rig;
  rig.width = 800;
  rig.height = 600;
  rig.camera.initPersProjWithoutDistortion(488.28125, 488.28125, 399.9921875, 299.9921875);
  rig.bMc = lampScene::frame(0, 0, 0.19, 0, 0, M_PI);
  return rig;
}

//! Half the diagonal of what the camera sees of the ceiling, m.
const double viewRadius = 0.5 * 1000 / 488.28125 * (3 - 0.19);

inline vpLampMap mapOf(const std::vector<Eigen::Vector3d> &positions, const std::vector<size_t> &identifiers)
{
  vpLampMap map;
  for (size_t k = 0; k < positions.size(); ++k) {
    vpLamp lamp;
    lamp.id = "L" + std::to_string(k);
    lamp.position = positions[k];
    lamp.modulation.kind = vpModulation::Kind::pwm;
    lamp.modulation.frequency = 500 + 50 * static_cast<double>(identifiers[k]);
    map.lamps.push_back(lamp);
  }
  return map;
}

//! How a picture errs.
struct Errors {
  double leastNoise = 0.03; // px, of image points: from this
  double mostNoise = 0.1;   // to this
  double survey = 0.01;     // m, of each lamp's coordinates
  double tilt = 0.1 * lampScene::degree;
  double missing = 0;     // share of the lamps in the picture that is not seen
  double reflections = 0; // for each lamp seen
};

//! What a robot sees and what is true of it.
struct View {
  vpHomogeneousMatrix wMb;
  std::vector<vpLampObservation> observations;
  std::vector<size_t> truth; // lamp of each, or reflection
  size_t inView = 0;         // lamps in the picture, seen or not

  std::vector<size_t> all() const
  {
    std::vector<size_t> which(observations.size());
    for (size_t k = 0; k < which.size(); ++k) {
      which[k] = k;
    }
    return which;
  }
};

//! A map, and the world that it describes with errors of its own.
class Ceiling
{
public:
  Ceiling(const vpLampMap &map, const Errors &errors, unsigned int seed)
      : errors(errors), map(map), m_random(seed), m_identifierOf(map.lamps.size())
  {
    const std::vector<vpIdentifier> identifiers = map.identifiers();
    for (size_t k = 0; k < identifiers.size(); ++k) {
      for (size_t lamp : identifiers[k].lamps) {
        m_identifierOf[lamp] = k;
        m_shared.resize(map.lamps.size(), false);
        m_shared[lamp] = identifiers[k].lamps.size() > 1;
      }
    }
    for (const vpLamp &lamp : map.lamps) {
      m_places.push_back(lamp.position + m_random.normal3(Eigen::Vector3d::Constant(errors.survey)));
      m_least = m_least.cwiseMin(lamp.position);
      m_greatest = m_greatest.cwiseMax(lamp.position);
    }
  }

  vpHomogeneousMatrix randomBase()
  {
    return lampScene::frame(m_random.uniform(m_least.x(), m_greatest.x()),
                            m_random.uniform(m_least.y(), m_greatest.y()), 0, 0, 0,
                            m_random.uniform(-M_PI, M_PI));
  }

  //! From there, with reflections as the errors say, each at a random place of the picture or in a random
  //! wall.
  View look(const vpHomogeneousMatrix &wMb)
  {
    View view;
    view.wMb = wMb;
    const vpHomogeneousMatrix wMc = leaning(wMb);
    std::vector<size_t> seen;
    for (size_t k = 0; k < m_places.size(); ++k) {
      Eigen::Vector2d pixel;
      const bool near = std::hypot(m_places[k].x() - wMb[0][3], m_places[k].y() - wMb[1][3]) < 5;
      if (near && project(m_places[k], wMc, pixel)) {
        ++view.inView;
        if (m_random.uniform(0, 1) >= errors.missing) {
          add(view, k, k, pixel);
          seen.push_back(k);
        }
      }
    }
    for (size_t lamp : seen) {
      if (m_random.uniform(0, 1) < errors.reflections) {
        addReflection(view, lamp, m_random.uniform(0, 1) < 0.5);
      }
    }
    return view;
  }

  /*!
    Adds a reflection of \e lamp: in an upright wall 0.3 to 3 m from the robot that shows it inside the
    picture, or anywhere in the picture. False where no such wall was found.
  */
  bool addReflection(View &view, size_t lamp, bool inWall)
  {
    Eigen::Vector2d pixel(m_random.uniform(0, 799), m_random.uniform(0, 599));
    if (inWall) {
      bool visible = false;
      for (int attempt = 0; attempt < 200 && !visible; ++attempt) {
        const double azimuth = m_random.uniform(-M_PI, M_PI), off = m_random.uniform(0.3, 3);
        const Eigen::Vector2d normal(std::cos(azimuth), std::sin(azimuth));
        const Eigen::Vector2d robot(view.wMb[0][3], view.wMb[1][3]);
        const double behind = off - normal.dot(m_places[lamp].head<2>() - robot);
        Eigen::Vector3d image = m_places[lamp];
        image.head<2>() += 2 * behind * normal;
        visible = behind > 0.1 && project(image, view.wMb * rig().bMc, pixel); // the lamp is before the wall
      }
      if (!visible) {
        return false;
      }
    }
    add(view, reflection, lamp, pixel);
    return true;
  }

  Errors errors;
  vpLampMap map;

  Random &random() { return m_random; }

private:
  vpHomogeneousMatrix leaning(const vpHomogeneousMatrix &wMb)
  {
    return wMb * lampScene::rotation({m_random.normal(errors.tilt), m_random.normal(errors.tilt), 0}) *
           rig().bMc;
  }

  static bool project(const Eigen::Vector3d &place, const vpHomogeneousMatrix &wMc, Eigen::Vector2d &pixel)
  {
    if (!lampScene::inFront(place, wMc)) {
      return false;
    }
    const vpLampSight sight = lampScene::sightOf("", place, wMc);
    vpMeterPixelConversion::convertPoint(rig().camera, sight.ray.x(), sight.ray.y(), pixel.x(), pixel.y());
    const double margin = 10; // px: lamps that the border cuts do not count
    return pixel.x() > margin && pixel.x() < 799 - margin && pixel.y() > margin && pixel.y() < 599 - margin;
  }

  //! \param is What it is, \param shows whose stripes it has.
  void add(View &view, size_t is, size_t shows, const Eigen::Vector2d &pixel)
  {
    const double sigma = m_random.uniform(errors.leastNoise, errors.mostNoise);
    vpLampObservation lamp;
    lamp.point = pixel + Eigen::Vector2d(m_random.normal(sigma), m_random.normal(sigma));
    lamp.covariance = sigma * sigma * Eigen::Matrix2d::Identity();
    lamp.candidates = {{m_identifierOf[shows], 0.999}};
    if (!m_shared[shows]) {
      lamp.id = map.lamps[shows].id;
    }
    view.observations.push_back(lamp);
    view.truth.push_back(is);
  }

  Random m_random;
  std::vector<size_t> m_identifierOf;
  std::vector<bool> m_shared;            // with another lamp
  std::vector<Eigen::Vector3d> m_places; // where the lamps really hang
  Eigen::Vector3d m_least = Eigen::Vector3d::Constant(1e9);
  Eigen::Vector3d m_greatest = -m_least;
};

//! Whether a unique match says anything that is not so: a lamp that is another one, a place elsewhere.
inline bool wrong(const vpLampMatch &match, const View &view)
{
  if (match.outcome != vpLampMatch::Outcome::unique) {
    return false;
  }
  bool wrong = std::hypot(match.wMb[0][3] - view.wMb[0][3], match.wMb[1][3] - view.wMb[1][3]) > 0.2;
  for (size_t k = 0; k < view.truth.size(); ++k) {
    wrong = wrong || (match.lamps[k] != vpLampMatch::noLamp && match.lamps[k] != view.truth[k]);
  }
  return wrong;
}
} // namespace reuseScene

#endif
