/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_localization/vpVlpFilter.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "vpLampGeometry.h"

BEGIN_VISP_NAMESPACE

namespace
{
double square(double x)
{
  return x * x;
}

//! A B for few columns, each by itself.
template <int Columns>
Eigen::Matrix<double, Eigen::Dynamic, Columns>
timesColumns(const Eigen::MatrixXd &A, const Eigen::Matrix<double, Eigen::Dynamic, Columns> &B)
{
  Eigen::Matrix<double, Eigen::Dynamic, Columns> product(A.rows(), Columns);
  for (int k = 0; k < Columns; ++k) {
    product.col(k).noalias() = A * B.col(k);
  }
  return product;
}

//! Where the base stands that leans by roll and pitch and heads along yaw: R = Rz(yaw) Ry(pitch) Rx(roll).
vpBasePose poseOf(const Eigen::VectorXd &state)
{
  vpBasePose pose;
  pose.wtb = state.head<3>();
  pose.wRb = (Eigen::AngleAxisd(state(3), Eigen::Vector3d::UnitZ()) *
              Eigen::AngleAxisd(state(5), Eigen::Vector3d::UnitY()) *
              Eigen::AngleAxisd(state(4), Eigen::Vector3d::UnitX()))
                 .toRotationMatrix();
  return pose;
}

//! From a base that stands level to the camera, in w, m.
Eigen::Vector3d levelArm(const Eigen::VectorXd &state, const Eigen::Vector3d &btc)
{
  return Eigen::AngleAxisd(state(3), Eigen::Vector3d::UnitZ()) * btc;
}

//! Rotations about the fixed axes of w by changes of yaw, roll and pitch, in the state's order.
Eigen::Matrix3d rotationByAngles(const Eigen::VectorXd &state)
{
  const Eigen::AngleAxisd heading(state(3), Eigen::Vector3d::UnitZ()),
      leaning(state(5), Eigen::Vector3d::UnitY());
  Eigen::Matrix3d axes;
  axes.col(0) = Eigen::Vector3d::UnitZ();
  axes.col(1) = heading * (leaning * Eigen::Vector3d::UnitX());
  axes.col(2) = heading * Eigen::Vector3d::UnitY();
  return axes;
}
} // namespace

//! A lamp's ray and its derivative by the state.
struct vpVlpFilter::Predicted {
  bool inFront = false;
  double depth = 0;
  Eigen::Vector2d ray = Eigen::Vector2d::Zero();
  Eigen::Matrix<double, Eigen::Dynamic, 2> Ht;        // transposed
  Eigen::Matrix2d ownDoubt = Eigen::Matrix2d::Zero(); // of a lamp whose error is no state yet
};

double vpVlpFilter::Innovation::distance(double tolerance) const
{
  const Eigen::Matrix2d S = covariance + square(tolerance / depth) * Eigen::Matrix2d::Identity();
  return ray.dot(S.inverse() * ray);
}

vpVlpFilter::vpVlpFilter(const vpVlpRig &rig) : m_rig(rig) {}

void vpVlpFilter::start(const vpHomogeneousMatrix &wMb, double time)
{
  // Wide, yet linear: the lamps of the pose follow.
  static const double place = 0.3, turn = 0.3; // m, rad
  const vpBasePose pose = vpBasePose::of(wMb);
  m_started = true;
  m_time = time;
  m_lamps.clear();
  m_x = Vector::Zero(lamps);
  m_x.head<3>() = pose.wtb;
  m_x(yaw) = std::atan2(pose.wRb(1, 0), pose.wRb(0, 0));
  m_x(roll) = freeAttitude ? std::atan2(pose.wRb(2, 1), pose.wRb(2, 2)) : 0;
  m_x(pitch) = freeAttitude ? -std::asin(std::clamp(pose.wRb(2, 0), -1.0, 1.0)) : 0;
  Vector sigma = Vector::Zero(lamps);
  sigma.head<3>().setConstant(place);
  sigma(yaw) = turn;
  sigma.segment<2>(roll) =
      freeAttitude ? Eigen::Vector2d(turn, turn)
                   : Eigen::Vector2d(m_rig.rotationSigma.head<2>().array().square() + square(m_tiltDoubt))
                         .cwiseSqrt()
                         .eval();
  sigma(speedScale) = odometryScale;
  sigma(turnScale) = odometryTurnScale;
  sigma(turnBias) = odometryTurnBias;
  sigma.segment<3>(mount) = m_rig.translationSigma;
  sigma(mount + 3) = m_rig.rotationSigma.z();
  const bool exact = m_tiltDoubt == 0 && m_rig.rotationSigma.isZero(0) && m_rig.translationSigma.isZero(0);
  const double point = m_rig.principalPointSigma ? *m_rig.principalPointSigma / m_rig.camera.get_px()
                                                 : (exact ? 0 : principalPoint);
  sigma.segment<3>(lens) << point, point, m_rig.focalLengthSigma.value_or(exact ? 0 : focalLength);
  m_P = sigma.cwiseAbs2().asDiagonal();
  static const double steady =
      0.1; // its first two frames tell whether camera and map are as good as they say
  m_unrest = steady;
  forgetVelocity();
  m_startP = m_P;
}

void vpVlpFilter::startAgain()
{
  const Eigen::Vector3d velocity = m_x.segment<3>(vx);
  const Eigen::Index start = lamps;
  Vector state = Vector::Zero(start);
  state.head<6>() = m_x.segment<6>(mark0);
  state.segment<3>(vx) = velocity;
  m_x = state;
  m_P = m_startP;
  m_lamps.clear();
  m_time = m_markTime;
}

void vpVlpFilter::comeFrom(const vpVlpFix &before, double since)
{
  const vpBasePose pose = vpBasePose::of(before.wMb);
  const double heading = std::atan2(pose.wRb(1, 0), pose.wRb(0, 0));
  const double turned = std::remainder(m_x(yaw) - heading, 2 * M_PI);
  const Eigen::Vector2d way = m_x.head<2>() - pose.wtb.head<2>();
  m_x.segment<2>(vx) = Eigen::Rotation2Dd(-heading - turned / 2) * way / since;
  m_x(w) = turned / since;
  // A single frame's pose is as good as its map, and its motion in between need not have been constant.
  static const double placeSigma = 0.003, turnSigma = 0.005; // m, rad
  const double place = std::sqrt(std::max(before.covariance(0, 0), before.covariance(1, 1))) + placeSigma,
               turn = std::sqrt(before.covariance(5, 5)) + turnSigma;
  for (int i : {vx, vy, w}) {
    m_P.row(i).setZero();
    m_P.col(i).setZero();
    m_P(i, i) = i == w ? square(turn / since) + square(m_unrest * turnAcceleration) * since
                       : square(place / since) + square(m_unrest * acceleration) * since;
  }
  m_startP = m_P;
}

void vpVlpFilter::doubtClaims()
{
  m_tiltDoubt = std::max(claimedTilt, 2 * m_tiltDoubt);
  m_placeDoubt = std::max(claimedPlace, 2 * m_placeDoubt);
}

void vpVlpFilter::forgetVelocity()
{
  for (int i : {vx, vy, w}) {
    m_P(i, i) += square(i == w ? startTurnRate : startVelocity);
  }
}

void vpVlpFilter::mark(double time)
{
  if (!m_started) {
    return;
  }
  m_moved = m_movable = 0;
  advance(time);
  m_markTime = m_time;
  m_x.segment<6>(mark0) = m_x.head<6>();
  m_P.middleRows<6>(mark0) = m_P.middleRows<6>(x).eval();
  m_P.middleCols<6>(mark0) = m_P.middleCols<6>(x).eval();
}

//! Of the lamp's error in the state, -1 where it has none.
Eigen::Index vpVlpFilter::lampIndex(const vpLampSight &lamp) const
{
  const auto found = std::find(m_lamps.begin(), m_lamps.end(), lamp.id);
  return found == m_lamps.end() ? -1 : lamps + 3 * (found - m_lamps.begin());
}

void vpVlpFilter::addLamp(const vpLampSight &lamp)
{
  const Eigen::Index n = m_x.size();
  m_x.conservativeResizeLike(Vector::Zero(n + 3));
  m_P.conservativeResizeLike(Matrix::Zero(n + 3, n + 3));
  m_P.bottomRightCorner<3, 3>().diagonal().setConstant(square(placeSigma(lamp)));
  m_lamps.push_back(lamp.id);
}

vpVlpFilter::Predicted vpVlpFilter::predict(const vpLampSight &lamp) const
{
  vpBasePose pose = poseOf(m_x);
  vpMountFrame frame(m_rig);
  frame.btc += m_x.segment<3>(mount);
  frame.bRc = Eigen::AngleAxisd(m_x(mount + 3), Eigen::Vector3d::UnitZ()) * frame.bRc;
  const Eigen::Index own = lampIndex(lamp);
  const Eigen::Vector3d place = own < 0 ? lamp.position : lamp.position + m_x.segment<3>(own);
  const Eigen::Vector3d rigidArm = pose.wRb * frame.btc,
                        arm = freeAttitude ? rigidArm : levelArm(m_x, frame.btc);
  pose.wtb += arm - rigidArm;
  const vpPredictedRay ray = predictRay(place, pose, frame);
  Predicted predicted;
  predicted.inFront = ray.inFront;
  if (!ray.inFront) {
    return predicted;
  }
  const Eigen::Vector3d camera = pose.wtb + rigidArm;
  predicted.depth = (pose.wRb * frame.bRc).col(2).dot(place - camera);
  predicted.ray = (1 + m_x(lens + 2)) * ray.ray + m_x.segment<2>(lens);
  predicted.Ht.setZero(m_x.size(), 2);
  const Eigen::Matrix<double, 2, 3> byPlace = ray.derivative.leftCols<3>(),
                                    byTurn = ray.derivative.rightCols<3>();
  predicted.Ht.middleRows<3>(x) = byPlace.transpose();
  const Eigen::Matrix3d byAngles = rotationByAngles(m_x);
  predicted.Ht.middleRows<3>(yaw) = (byTurn * byAngles).transpose();
  if (!freeAttitude) { // yaw carries the camera along on its level arm, roll and pitch leave it where it is
    const Eigen::Vector3d arms[] = {arm - rigidArm, -rigidArm, -rigidArm};
    for (int k = 0; k < 3; ++k) {
      predicted.Ht.row(yaw + k) += (byPlace * byAngles.col(k).cross(arms[k])).transpose();
    }
  }
  predicted.Ht.middleRows<3>(mount) = (byPlace * pose.wRb).transpose();
  predicted.Ht.middleRows<2>(lens).setIdentity();
  predicted.Ht.row(lens + 2) = ray.ray.transpose();
  // The camera turns about z of b and stays where it is.
  const Eigen::Vector3d axis = pose.wRb.col(2);
  predicted.Ht.row(mount + 3) = (byTurn * axis - byPlace * axis.cross(rigidArm)).transpose();
  if (own >= 0) {
    predicted.Ht.middleRows<3>(own) = -byPlace.transpose();
  } else {
    predicted.ownDoubt = square(placeSigma(lamp)) * byPlace * byPlace.transpose();
  }
  return predicted;
}

vpVlpFilter::Innovation vpVlpFilter::innovation(const vpLampSight &lamp) const
{
  return m_started ? innovation(lamp, predict(lamp)) : Innovation();
}

vpVlpFilter::Innovation vpVlpFilter::innovation(const vpLampSight &lamp, const Predicted &predicted) const
{
  Innovation innovation;
  innovation.inFront = predicted.inFront;
  if (predicted.inFront) {
    innovation.ray = lamp.ray - predicted.ray;
    innovation.covariance = predicted.Ht.transpose() * timesColumns(m_P, predicted.Ht) + predicted.ownDoubt +
                            m_noise * lamp.covariance;
    innovation.depth = predicted.depth;
  }
  return innovation;
}

void vpVlpFilter::update(const vpLampSight &lamp)
{
  if (!m_started) {
    return;
  }
  if (placeSigma(lamp) > 0 && lampIndex(lamp) < 0) {
    addLamp(lamp);
  }
  const Predicted predicted = predict(lamp);
  if (predicted.inFront) {
    const Innovation seen = innovation(lamp, predicted);
    weighMotion(seen, lamp.covariance);
    weighNoise(seen, lamp.covariance);
    measure<2>(predicted.Ht, lamp.ray - predicted.ray, m_noise * lamp.covariance);
  }
}

template <int Rows>
void vpVlpFilter::measure(const Eigen::Matrix<double, Eigen::Dynamic, Rows> &Ht,
                          const Eigen::Matrix<double, Rows, 1> &innovation,
                          const Eigen::Matrix<double, Rows, Rows> &R)
{
  using Columns = Eigen::Matrix<double, Eigen::Dynamic, Rows>;
  const Columns PH = timesColumns(m_P, Ht);
  const Eigen::Matrix<double, Rows, Rows> S = Ht.transpose() * PH + R;
  const Eigen::Matrix<double, Rows, Rows> inverse = S.inverse();
  Columns K = PH.lazyProduct(inverse);
  // Errors of mount, lens and map are considered, not estimated: a hundredth of a pixel, seen again and again
  // about ever other linearisations, would seem to tell them.
  K.middleRows(mount, mark0 - mount).setZero();
  K.bottomRows(m_x.size() - lamps).setZero();
  const Vector correction = K * innovation;
  m_x += correction;
  m_x(yaw) = std::remainder(m_x(yaw), 2 * M_PI);
  // Joseph's form, which holds for any gain, multiplied out: H has few rows.
  const Columns KS = K.lazyProduct(S);
  m_P += (KS - PH).lazyProduct(K.transpose());
  m_P -= K.lazyProduct(PH.transpose());
  // A turn about the lamp, which its ray does not tell, is to stay untold once the place was corrected, else
  // corrections alone would tell the heading. So the covariance is that of the right-invariant error (Barrau
  // and Bonnabel 2017), in which an error of the heading turns the place about the origin of w.
  for (const int first : {x, mark0}) {
    const Eigen::Vector2d turned(-correction(first + 1), correction(first));
    for (int k = 0; k < 2; ++k) {
      m_P.row(first + k) += turned(k) * m_P.row(first + yaw);
    }
    for (int k = 0; k < 2; ++k) {
      m_P.col(first + k) += turned(k) * m_P.col(first + yaw);
    }
  }
  for (Eigen::Index k = 0; k < m_P.cols(); ++k) {
    for (Eigen::Index l = 0; l < k; ++l) {
      m_P(l, k) = m_P(k, l) = 0.5 * (m_P(l, k) + m_P(k, l));
    }
  }
}

template void vpVlpFilter::measure<2>(const Eigen::Matrix<double, Eigen::Dynamic, 2> &,
                                      const Eigen::Vector2d &, const Eigen::Matrix2d &);
template void vpVlpFilter::measure<3>(const Eigen::Matrix<double, Eigen::Dynamic, 3> &,
                                      const Eigen::Vector3d &, const Eigen::Matrix3d &);

//! Of the pose in the state from there on.
vpVlpFix vpVlpFilter::fixOf(Index first) const
{
  vpVlpFix fix;
  fix.valid = m_started;
  if (!m_started) {
    fix.refusal = "no pose yet";
    return fix;
  }
  const Vector state = m_x.segment<6>(first);
  fix.wMb = poseOf(state).wMb();
  fix.wMc = fix.wMb * m_rig.bMc;
  if (!freeAttitude) {
    const Eigen::Vector3d camera = state.head<3>() + levelArm(state, vpMountFrame(m_rig).btc);
    fix.wMc.insert(vpTranslationVector(camera.x(), camera.y(), camera.z()));
  }
  const Eigen::Matrix3d byAngles = rotationByAngles(state);
  const auto P = m_P.block<6, 6>(first, first);
  fix.covariance.topLeftCorner<3, 3>() = P.topLeftCorner<3, 3>();
  fix.covariance.topRightCorner<3, 3>() = P.topRightCorner<3, 3>() * byAngles.transpose();
  fix.covariance.bottomLeftCorner<3, 3>() = byAngles * P.bottomLeftCorner<3, 3>();
  fix.covariance.bottomRightCorner<3, 3>() = byAngles * P.bottomRightCorner<3, 3>() * byAngles.transpose();
  return fix;
}

vpVlpFix vpVlpFilter::marked() const
{
  return fixOf(mark0);
}

vpVlpFix vpVlpFilter::fixAt(double time) const
{
  vpVlpFilter there = *this;
  there.rouse();
  there.advance(time);
  return there.fixOf(x);
}

vpVlpFilter::State vpVlpFilter::state(const vpVlpFix &fix) const
{
  if (!fix.valid) {
    return State::starting;
  }
  const double place = std::sqrt(std::max(fix.covariance(0, 0), fix.covariance(1, 1))),
               turn = std::sqrt(fix.covariance(5, 5));
  if (!(fix.covariance.allFinite() && place < lostSigma && turn < lostYaw)) {
    return State::lost;
  }
  return place < trackingSigma && turn < trackingYaw ? State::tracking : State::coasting;
}

END_VISP_NAMESPACE
