/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef lampScene_h
#define lampScene_h

/*!
  \file lampScene.h
  Lamps, rigs and robots drawn at random for the tests of the solvers, seen through ViSP's own frame maths.
*/

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <visp3/core/vpPoint.h>
#include <visp3/core/vpRotationMatrix.h>
#include <visp3/core/vpRzyxVector.h>
#include <visp3/core/vpThetaUVector.h>
#include <visp3/vlp_localization/vpVlpFix.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace lampScene
{
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

const double degree = M_PI / 180;

//! Fixed seed: the same numbers in every run.
class Random
{
public:
  explicit Random(unsigned int seed) : m_generator(seed) {}
  double uniform(double from, double to)
  {
    return std::uniform_real_distribution<double>(from, to)(m_generator);
  }
  double normal(double sigma) { return sigma * std::normal_distribution<double>()(m_generator); }
  Eigen::Vector3d normal3(const Eigen::Vector3d &sigma)
  {
    return {normal(sigma.x()), normal(sigma.y()), normal(sigma.z())};
  }

private:
  std::mt19937 m_generator;
};

//! Translation in m; roll, pitch, yaw about fixed x, y, z in rad.
inline vpHomogeneousMatrix frame(double x, double y, double z, double roll, double pitch, double yaw)
{
  return {vpTranslationVector(x, y, z), vpRotationMatrix(vpRzyxVector(yaw, pitch, roll))};
}

//! A small rotation, theta u in rad.
inline vpHomogeneousMatrix rotation(const Eigen::Vector3d &turn)
{
  return {vpTranslationVector(), vpThetaUVector(turn.x(), turn.y(), turn.z())};
}

inline vpVlpRig rigWith(const vpHomogeneousMatrix &bMc)
{
  vpVlpRig rig;
  rig.bMc = bMc;
  return rig;
}

//! A camera that looks up, leaning up to \e tilt, anywhere on the robot, turned any way.
inline vpVlpRig randomRig(Random &random, double tilt)
{
  const vpHomogeneousMatrix yaw = frame(0, 0, 0, 0, 0, random.uniform(-M_PI, M_PI));
  const double azimuth = random.uniform(-M_PI, M_PI), lean = random.uniform(0, tilt);
  vpHomogeneousMatrix bMc = rotation({lean * std::cos(azimuth), lean * std::sin(azimuth), 0}) * yaw;
  bMc.insert(
      vpTranslationVector(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), random.uniform(0.05, 0.4)));
  return rigWith(bMc);
}

//! A level base on a floor near z = 0.
inline vpHomogeneousMatrix randomBase(Random &random)
{
  return frame(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-0.05, 0.05), 0, 0,
               random.uniform(-M_PI, M_PI));
}

//! What the camera at \e wMc sees of a lamp at \e place: vpPoint's projection, without noise.
inline vpLampSight sightOf(const std::string &id, const Eigen::Vector3d &place,
                           const vpHomogeneousMatrix &wMc, double raySigma = 1e-4)
{
  vpPoint point(place.x(), place.y(), place.z());
  point.track(wMc.inverse());
  vpLampSight sight;
  sight.id = id;
  sight.position = place;
  sight.ray = {point.get_x(), point.get_y()};
  sight.covariance = raySigma * raySigma * Eigen::Matrix2d::Identity();
  return sight;
}

inline bool inFront(const Eigen::Vector3d &place, const vpHomogeneousMatrix &wMc)
{
  vpPoint point(place.x(), place.y(), place.z());
  point.changeFrame(wMc.inverse());
  return point.get_Z() > 0.1;
}

//! A lamp up to \e reach beside the robot, between 1.2 and 3 m high; with \e height, at that one.
inline Eigen::Vector3d randomLamp(Random &random, const vpHomogeneousMatrix &wMb, double reach,
                                  double height = 0)
{
  return {wMb[0][3] + random.uniform(-reach, reach), wMb[1][3] + random.uniform(-reach, reach),
          height > 0 ? height : random.uniform(1.2, 3)};
}

//! Translation (m) and rotation about the fixed axes of w (rad) that lead from \e estimate to \e truth.
inline Vector6d poseError(const vpHomogeneousMatrix &truth, const vpHomogeneousMatrix &estimate)
{
  const vpThetaUVector turn(truth.getRotationMatrix() * estimate.getRotationMatrix().t());
  Vector6d error;
  for (unsigned int i = 0; i < 3; ++i) {
    error(i) = truth[i][3] - estimate[i][3];
    error(i + 3) = turn[i];
  }
  return error;
}

//! Roll and pitch with the fewest numbers: the rotation about a horizontal axis that levels the base.
inline double tiltOf(const vpHomogeneousMatrix &wMb)
{
  return std::atan2(std::hypot(wMb[2][0], wMb[2][1]), wMb[2][2]);
}

/*!
  A world as the rig and the map do not quite claim it: lamps off their places, camera off its mount, its lens
  off its calibration, image points off their places, each by its stated sigma.
*/
struct Sigmas {
  double raySigma = 3e-4;
  double positionSigma = 0;
  Eigen::Vector3d translationSigma = Eigen::Vector3d::Zero();
  Eigen::Vector3d rotationSigma = Eigen::Vector3d::Zero();
  double principalPointSigma = 0; // normalised units
  double focalLengthSigma = 0;    // share
};

//! How far a lens is off.
struct LensError {
  Eigen::Vector2d principalPoint = Eigen::Vector2d::Zero(); // normalised units
  double focalLength = 0;                                   // share

  LensError(Random &random, const Sigmas &sigmas)
  {
    if (sigmas.principalPointSigma > 0) {
      principalPoint = Eigen::Vector2d(random.normal(sigmas.principalPointSigma),
                                       random.normal(sigmas.principalPointSigma));
    }
    if (sigmas.focalLengthSigma > 0) {
      focalLength = random.normal(sigmas.focalLengthSigma);
    }
  }
  //! Where a calibrated camera would have a ray.
  Eigen::Vector2d seen(const Eigen::Vector2d &ray) const { return (1 + focalLength) * ray + principalPoint; }
};

struct Draw {
  vpHomogeneousMatrix wMb; // true, its roll and pitch those of the camera
  std::vector<vpLampSight> lamps;
};

//! \e wMb is where the level base stands; \e rig and \e places are the claims.
inline Draw draw(Random &random, const vpVlpRig &rig, const vpHomogeneousMatrix &wMb,
                 const std::vector<Eigen::Vector3d> &places, const Sigmas &sigmas)
{
  const Eigen::Vector3d turn = random.normal3(sigmas.rotationSigma);
  const Eigen::Vector3d shift = random.normal3(sigmas.translationSigma);
  Draw drawn;
  drawn.wMb = wMb * rotation({turn.x(), turn.y(), 0});
  vpHomogeneousMatrix bMc = rotation({turn.x(), turn.y(), 0}) * rotation({0, 0, turn.z()}) * rig.bMc;
  bMc.insert(
      vpTranslationVector(rig.bMc[0][3] + shift.x(), rig.bMc[1][3] + shift.y(), rig.bMc[2][3] + shift.z()));
  const vpHomogeneousMatrix wMc = wMb * bMc;
  const LensError lens(random, sigmas);
  for (size_t k = 0; k < places.size(); ++k) {
    const Eigen::Vector3d place = places[k] + random.normal3(Eigen::Vector3d::Constant(sigmas.positionSigma));
    vpLampSight sight = sightOf(std::string(1, static_cast<char>('A' + k)), place, wMc, sigmas.raySigma);
    sight.position = places[k];
    sight.positionSigma = sigmas.positionSigma;
    sight.ray = lens.seen(sight.ray) +
                Eigen::Vector2d(random.normal(sigmas.raySigma), random.normal(sigmas.raySigma));
    drawn.lamps.push_back(sight);
  }
  return drawn;
}

inline vpVlpRig withSigmas(vpVlpRig rig, const Sigmas &sigmas)
{
  rig.translationSigma = sigmas.translationSigma;
  rig.rotationSigma = sigmas.rotationSigma;
  rig.principalPointSigma = sigmas.principalPointSigma * rig.camera.get_px();
  rig.focalLengthSigma = sigmas.focalLengthSigma;
  return rig;
}

//! Mean of values that follow a chi-square distribution each, and the interval in which it lies 95 times of
//! 100.
struct ChiSquareMean {
  double sum = 0;
  int count = 0;

  void add(double value)
  {
    sum += value;
    ++count;
  }
  double mean() const { return sum / count; }
  double halfWidth(double degreesOfFreedom) const { return 1.96 * std::sqrt(2 * degreesOfFreedom / count); }
};

//! Normalised estimation error squared over those rows of which \e fix states a sigma.
inline double nees(const vpVlpFix &fix, const vpHomogeneousMatrix &truth, int *degreesOfFreedom = nullptr)
{
  const Vector6d error = poseError(truth, fix.wMb);
  std::vector<int> rows;
  for (int i = 0; i < 6; ++i)
    if (fix.covariance(i, i) > 0)
      rows.push_back(i);
  const int n = static_cast<int>(rows.size());
  Eigen::MatrixXd covariance(n, n);
  Eigen::VectorXd e(n);
  for (int i = 0; i < n; ++i) {
    e(i) = error(rows[i]);
    for (int j = 0; j < n; ++j)
      covariance(i, j) = fix.covariance(rows[i], rows[j]);
  }
  if (degreesOfFreedom)
    *degreesOfFreedom = n;
  return e.dot(covariance.ldlt().solve(e));
}
} // namespace lampScene

#endif
