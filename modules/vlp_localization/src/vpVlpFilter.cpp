/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_localization/vpVlpFilter.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <visp3/core/vpMath.h>

#include "vpCovarianceColumns.h"
#include "vpVlpFilterParts.h"

BEGIN_VISP_NAMESPACE

namespace
{
using Vector6d = Eigen::Matrix<double, 6, 1>;

//! A base that leans by roll and pitch and heads along yaw: R = Rz(yaw) Ry(pitch) Rx(roll).
struct Base {
  explicit Base(const Vector6d &state)
  {
    const double cy = std::cos(state(3)), sy = std::sin(state(3)), cr = std::cos(state(4)),
                 sr = std::sin(state(4)), cp = std::cos(state(5)), sp = std::sin(state(5));
    heading << cy, -sy, 0, sy, cy, 0, 0, 0, 1;
    pose.wtb = state.head<3>();
    pose.wRb << cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr, //
        sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,         //
        -sp, cp * sr, cp * cr;
    byAngles << 0, cy * cp, -sy, 0, sy * cp, cy, 1, -sp, 0;
  }

  vpBasePose pose;
  Eigen::Matrix3d heading;  // were it level
  Eigen::Matrix3d byAngles; // rotations about the fixed axes of w by changes of yaw, roll and pitch
};
} // namespace

double vpVlpFilter::Innovation::distance(double tolerance) const
{
  const Eigen::Matrix2d S = covariance + vpMath::sqr(tolerance / depth) * Eigen::Matrix2d::Identity();
  return ray.dot(S.inverse() * ray);
}

vpVlpFilter::vpVlpFilter(const vpVlpRig &rig) : m_given(std::make_shared<Given>(rig)) {}

void vpVlpFilter::mark(double time)
{
  if (!m_started) {
    return;
  }
  m_information.setZero();
  m_sights = 0;
  m_imageSpeed = 0;
  m_leastOdometry = std::numeric_limits<double>::max();
  advance(time);
  m_markTime = m_time;
  m_x.segment<6>(mark0) = m_x.head<6>();
  m_P.middleRows<6>(mark0) = m_P.middleRows<6>(x);
  m_P.middleCols<6>(mark0) = m_P.middleCols<6>(x);
  if (m_aside) {
    m_offset.segment<6>(mark0) = m_offset.head<6>();
  }
}

//! Of the lamp's error in the state, -1 where it has none.
Eigen::Index vpVlpFilter::lampIndex(const vpLampSight &lamp) const
{
  const auto found = std::find(m_lamps.begin(), m_lamps.end(), lamp.id);
  return found == m_lamps.end() ? -1 : lamps + 3 * (found - m_lamps.begin());
}

void vpVlpFilter::expect(const vpLampSight &lamp)
{
  if (!m_started || !(placeSigma(lamp) > 0) || lampIndex(lamp) >= 0) {
    return;
  }
  const Eigen::Index n = m_x.size();
  m_x.conservativeResizeLike(Vector::Zero(n + 3));
  m_P.conservativeResizeLike(Matrix::Zero(n + 3, n + 3));
  m_P.bottomRightCorner<3, 3>().diagonal().setConstant(vpMath::sqr(placeSigma(lamp)));
  if (m_aside) {
    m_offset.conservativeResizeLike(Vector::Zero(n + 3));
  }
  m_lamps.push_back(lamp.id);
}

//! The errors of mount, lens and lamps are 0, as they are considered, not estimated.
vpVlpFilter::Predicted vpVlpFilter::predict(const vpLampSight &lamp) const
{
  const Base base(m_x.head<6>());
  const vpMountFrame &frame = m_given->mount;
  vpBasePose pose = base.pose;
  const Eigen::Vector3d rigidArm = pose.wRb * frame.btc,
                        arm = freeAttitude ? rigidArm : base.heading * frame.btc;
  pose.wtb += arm - rigidArm;
  const vpPredictedRay ray = predictRay(lamp.position, pose, frame);
  Predicted predicted;
  predicted.inFront = ray.inFront;
  if (!ray.inFront) {
    return predicted;
  }
  const Eigen::Index own = lampIndex(lamp);
  predicted.depth = (pose.wRb * frame.bRc.col(2)).dot(lamp.position - pose.wtb - rigidArm);
  predicted.ray = ray.ray;
  const Eigen::Matrix<double, 2, 3> byPlace = ray.derivative.leftCols<3>(),
                                    byTurn = ray.derivative.rightCols<3>();
  predicted.byPlace = -byPlace.leftCols<2>();
  Eigen::Matrix<double, 2, 3> byAngle = byTurn * base.byAngles;
  if (!freeAttitude) { // yaw carries the camera along on its level arm, roll and pitch leave it where it is
    const Eigen::Vector3d arms[] = {arm - rigidArm, -rigidArm, -rigidArm};
    for (int k = 0; k < 3; ++k) {
      byAngle.col(k) += byPlace * base.byAngles.col(k).cross(arms[k]);
    }
  }
  const Eigen::Matrix<double, 2, 3> byMount = byPlace * pose.wRb;
  // The camera turns about z of b and stays where it is.
  const Eigen::Vector3d axis = pose.wRb.col(2);
  Derivative<2> &H = predicted.H;
  const auto add = [this, &H](Eigen::Index index, const Eigen::RowVector2d &row) {
    if (m_P(index, index) > 0) { // what is certain has no part in it
      H.add(index, row);
    }
  };
  for (int k = 0; k < 3; ++k) {
    add(x + k, byPlace.col(k).transpose());
    add(yaw + k, byAngle.col(k).transpose());
    add(mount + k, byMount.col(k).transpose());
  }
  add(mount + 3, (byTurn * axis - byPlace * axis.cross(rigidArm)).transpose());
  add(lens, Eigen::RowVector2d::UnitX());
  add(lens + 1, Eigen::RowVector2d::UnitY());
  add(lens + 2, ray.ray.transpose());
  if (own >= 0) {
    for (int k = 0; k < 3; ++k) {
      H.add(own + k, -byPlace.col(k).transpose());
    }
  } else {
    predicted.ownCovariance = vpMath::sqr(placeSigma(lamp)) * byPlace * byPlace.transpose();
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
    innovation.ray = lamp.ray - predicted.ray - aside(predicted.H);
    innovation.covariance = predicted.ownCovariance + m_noise * lamp.covariance;
    const Derivative<2> &H = predicted.H;
    for (int k = 0; k < H.count; ++k) {
      const auto column = m_P.col(H.at[static_cast<size_t>(k)]);
      double byFirst = 0, bySecond = 0; // H P there
      for (int l = 0; l < H.count; ++l) {
        const double covariance = column(H.at[static_cast<size_t>(l)]);
        byFirst += covariance * H.rows(l, 0);
        bySecond += covariance * H.rows(l, 1);
      }
      innovation.covariance += Eigen::Vector2d(byFirst, bySecond) * H.rows.row(k);
    }
    innovation.depth = predicted.depth;
    innovation.byPlace = predicted.byPlace;
  }
  return innovation;
}

/*!
  What lamps' points scatter by, as a share of what they say: by the innovations of a calm robot, whose pose
  rests on such points and is as good as they were (covariance matching, Mehra 1972).
*/
void vpVlpFilter::weighNoise(const Innovation &seen, const Eigen::Matrix2d &stated)
{
  static const double calm = 0.03, noisy = 0.3; // share of the accelerations; of an innovation's variance
  static const double priorPoints = 10;         // that the stated variance weighs as much as
  static const double slowest = 0.02, least = 0.25, most = 9; // the latter of a point's innovation, too
  if (manoeuvreShare > calm || m_noise * stated.trace() < noisy * seen.covariance.trace()) {
    return;
  }
  const double excess = 0.5 * std::min(seen.distance(0), most) - 1;
  const double gain = std::max(slowest, 1 / (priorPoints + ++m_weighed));
  m_noise = std::clamp(m_noise * std::exp(gain * excess), least, most);
}

void vpVlpFilter::update(const vpLampSight &lamp)
{
  if (!m_started) {
    return;
  }
  expect(lamp);
  update(lamp, predict(lamp));
}

void vpVlpFilter::update(const vpLampSight &lamp, const Predicted &predicted)
{
  if (predicted.inFront) {
    const Innovation seen = innovation(lamp, predicted);
    weighNoise(seen, lamp.covariance);
    Eigen::Matrix<double, 4, 2> byPose = Eigen::Matrix<double, 4, 2>::Zero();
    for (int k = 0; k < predicted.H.count; ++k) {
      const Eigen::Index index = predicted.H.at[static_cast<size_t>(k)];
      if (index <= yaw) {
        byPose.row(index) = predicted.H.rows.row(k);
      }
    }
    m_information += byPose * lamp.covariance.inverse() * byPose.transpose();
    ++m_sights;
    m_imageSpeed =
        std::max(m_imageSpeed, m_given->rig.camera.get_px() * (m_x.segment<2>(vx).norm() / predicted.depth +
                                                               std::abs(m_x(w)) * predicted.ray.norm()));
    measure<2>(predicted.H, seen.ray, m_noise * lamp.covariance);
  }
}

template <int Values>
Eigen::Matrix<double, Values, Values> vpVlpFilter::measure(const Derivative<Values> &H,
                                                           const Eigen::Matrix<double, Values, 1> &innovation,
                                                           const Eigen::Matrix<double, Values, Values> &R)
{
  const Eigen::Index n = m_x.size();
  m_PH.resize(n, 3);
  m_K.resize(n, 3);
  auto PH = m_PH.leftCols<Values>(), K = m_K.leftCols<Values>();
  vpCovarianceColumns::sum(m_P.data(), n, H.at.data(), H.count, H.rows.data(),
                           static_cast<int>(H.rows.rows()), Values, m_PH.data());
  Eigen::Matrix<double, Values, Values> S = R;
  for (int k = 0; k < H.count; ++k) {
    S += H.rows.row(k).transpose() * PH.row(H.at[static_cast<size_t>(k)]);
  }
  const Eigen::Matrix<double, Values, Values> inverse = S.inverse();
  K = PH.lazyProduct(inverse);
  // Errors of mount, lens and map are considered, not estimated: a hundredth of a pixel, seen again and again
  // about ever other linearisations, would seem to tell them.
  K.middleRows(mount, mark0 - mount).setZero();
  K.bottomRows(n - lamps).setZero();
  (m_aside ? m_offset : m_x) += K.lazyProduct(innovation);
  m_x(yaw) = std::remainder(m_x(yaw), 2 * M_PI);
  // Joseph's form, which holds for any gain, multiplied out: P - K W' - W K' with W = P H' - K S / 2.
  const Eigen::Matrix<double, Values, Values> half = 0.5 * S;
  PH -= K.lazyProduct(half);
  // What is considered keeps its own covariance, so that the columns of the rest are all that changes.
  for (const auto &[from, until] : estimated) {
    vpCovarianceColumns::subtract(m_P.data(), n, from, until, m_K.data(), m_PH.data(), Values);
  }
  for (const Index first : {x, mark0}) {
    if (!m_aside) {
      carryAlong(first, {K.row(first).dot(innovation), K.row(first + 1).dot(innovation)});
    }
  }
  mirror();
  return S;
}

//! Makes the covariance symmetric, after what changed the columns of what is estimated.
void vpVlpFilter::mirror()
{
  const Eigen::Index n = m_P.rows();
  for (Eigen::Index column = 0; column < n; ++column) {
    const bool considered = (column >= mount && column < mark0) || column >= lamps;
    double *out = m_P.data() + column * n;
    for (const auto &[from, until] : estimated) {
      const Eigen::Index last = until, end = considered ? last : std::min(last, column);
      const double *in = m_P.data() + from * n + column;
      for (Eigen::Index row = from; row < end; ++row, in += n) {
        out[row] = *in;
      }
    }
  }
}

/*!
  The covariance of a place that was corrected by \e shift. A turn about a lamp, which its ray does not tell,
  is to stay untold then, else corrections alone would tell the heading. So the covariance is that of the
  right-invariant error (Barrau and Bonnabel 2017), in which an error of the heading turns the place about the
  origin of w. Of the columns of what is estimated alone: mirror() is to follow.
*/
void vpVlpFilter::carryAlong(Index first, const Eigen::Vector2d &shift)
{
  const Eigen::Vector2d turned(-shift.y(), shift.x());
  for (int k = 0; k < 2; ++k) {
    m_P.col(first + k) += turned(k) * m_P.col(first + yaw);
  }
  for (const auto &[from, until] : estimated) {
    for (Eigen::Index column = from; column < until; ++column) {
      m_P.col(column).segment<2>(first) += m_P(first + yaw, column) * turned;
    }
  }
}

template Eigen::Matrix2d vpVlpFilter::measure<2>(const Derivative<2> &, const Eigen::Vector2d &,
                                                 const Eigen::Matrix2d &);
template Eigen::Matrix3d vpVlpFilter::measure<3>(const Derivative<3> &, const Eigen::Vector3d &,
                                                 const Eigen::Matrix3d &);

//! The pose in the state from there on.
vpVlpFilter::Pose vpVlpFilter::poseOf(Index first) const
{
  const Base base(m_x.segment<6>(first));
  Pose pose;
  pose.wMb.linear() = base.pose.wRb;
  pose.wMb.translation() = base.pose.wtb;
  pose.wMb.makeAffine();
  pose.wtc = base.pose.wtb + (freeAttitude ? base.pose.wRb : base.heading) * m_given->mount.btc;
  pose.covariance = m_P.block<6, 6>(first, first);
  pose.covariance.topLeftCorner<4, 4>() += m_common;
  pose.covariance.bottomRows<3>() = base.byAngles * pose.covariance.bottomRows<3>();
  pose.covariance.rightCols<3>() *= base.byAngles.transpose();
  return pose;
}

void vpVlpFilter::tell(Index first, vpVlpFix &fix) const
{
  const Pose pose = poseOf(first);
  const Eigen::Matrix3d wRc = pose.wMb.linear() * m_given->mount.bRc;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      fix.wMb[i][k] = pose.wMb(i, k);
      fix.wMc[i][k] = wRc(i, k);
    }
    fix.wMb[i][3] = pose.wMb(i, 3);
    fix.wMc[i][3] = pose.wtc(i);
  }
  fix.covariance = pose.covariance;
}

vpVlpFix vpVlpFilter::fixOf(Index first) const
{
  vpVlpFix fix;
  fix.valid = m_started;
  if (m_started) {
    tell(first, fix);
  } else {
    fix.refusal = "no pose yet";
  }
  return fix;
}

vpVlpFix vpVlpFilter::marked() const
{
  return fixOf(mark0);
}

void vpVlpFilter::tellMarked(vpVlpFix &fix) const
{
  tell(mark0, fix);
}

vpVlpFix vpVlpFilter::fixAt(double time) const
{
  vpVlpFilter there = *this;
  there.manoeuvreShare = 1;
  there.advance(time);
  return there.fixOf(x);
}

vpVlpFilter::State vpVlpFilter::state(const vpVlpFix &fix) const
{
  return fix.valid ? stateOf(fix.covariance) : State::starting;
}

vpVlpFilter::State vpVlpFilter::stateOf(const Eigen::Matrix<double, 6, 6> &covariance) const
{
  const double place = std::sqrt(std::max(covariance(0, 0), covariance(1, 1))),
               turn = std::sqrt(covariance(5, 5));
  if (!(covariance.allFinite() && place < lostSigma && turn < lostYaw)) {
    return State::lost;
  }
  return place < trackingSigma && turn < trackingYaw ? State::tracking : State::coasting;
}

END_VISP_NAMESPACE
