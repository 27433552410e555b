/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLampGeometry.h"

#include <array>
#include <cmath>
#include <sstream>

#include <Eigen/Geometry>

BEGIN_VISP_NAMESPACE

namespace
{
const double leastDepth = 1e-6; // m in front of the camera

Eigen::Matrix3d cross(const Eigen::Vector3d &v)
{
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

using vpMatrixOfVisp = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
} // namespace

double vpBasePose::tilt() const
{
  return std::atan2(std::hypot(wRb(2, 0), wRb(2, 1)), wRb(2, 2));
}

vpBasePose vpBasePose::moved(const Eigen::Matrix<double, 6, 1> &step) const
{
  vpBasePose pose = *this;
  pose.wtb += step.head<3>();
  const double angle = step.tail<3>().norm();
  if (angle > 0)
    pose.wRb = Eigen::AngleAxisd(angle, step.tail<3>() / angle) * pose.wRb;
  return pose;
}

Eigen::Matrix<double, 6, 1> vpBasePose::stepTo(const vpBasePose &pose) const
{
  const Eigen::AngleAxisd turn(pose.wRb * wRb.transpose());
  Eigen::Matrix<double, 6, 1> step;
  step << pose.wtb - wtb, turn.angle() * turn.axis();
  return step;
}

vpHomogeneousMatrix vpBasePose::wMb() const
{
  vpHomogeneousMatrix M;
  Eigen::Map<vpMatrixOfVisp>(M.data).topRows<3>() << wRb, wtb;
  return M;
}

vpBasePose vpBasePose::of(const vpHomogeneousMatrix &wMb)
{
  const Eigen::Map<const vpMatrixOfVisp> M(wMb.data);
  return {M.topLeftCorner<3, 3>(), M.topRightCorner<3, 1>()};
}

vpMountFrame::vpMountFrame(const vpVlpRig &rig)
    : bRc(vpBasePose::of(rig.bMc).wRb), btc(vpBasePose::of(rig.bMc).wtb),
      translationSigma(rig.translationSigma), rotationSigma(rig.rotationSigma),
      principalPointSigma(rig.principalPointSigma.value_or(0) / rig.camera.get_px()),
      focalLengthSigma(rig.focalLengthSigma.value_or(0))
{
}

vpPredictedRay predictRay(const Eigen::Vector3d &lamp, const vpBasePose &pose, const vpMountFrame &mount)
{
  const Eigen::Vector3d fromBase = lamp - pose.wtb; // in w
  const Eigen::Matrix3d cRw = (pose.wRb * mount.bRc).transpose();
  const Eigen::Vector3d c = cRw * fromBase - mount.bRc.transpose() * mount.btc;
  vpPredictedRay predicted;
  predicted.inFront = c.z() > leastDepth;
  if (!predicted.inFront)
    return predicted;
  predicted.ray = c.head<2>() / c.z();
  Eigen::Matrix<double, 2, 3> byPoint;
  byPoint << 1, 0, -predicted.ray.x(), 0, 1, -predicted.ray.y();
  byPoint *= cRw / c.z();
  predicted.derivative << -byPoint, byPoint * cross(fromBase);
  return predicted;
}

Eigen::Matrix2d rayCovariance(const vpLampSight &lamp, const vpPredictedRay &predicted)
{
  const Eigen::Matrix<double, 2, 3> byPosition = -predicted.derivative.leftCols<3>();
  return lamp.covariance + lamp.positionSigma * lamp.positionSigma * byPosition * byPosition.transpose();
}

Eigen::Matrix2d tiltCovariance(const vpBasePose &pose, const vpMountFrame &mount)
{
  const Eigen::Matrix2d turn = pose.wRb.topLeftCorner<2, 2>();
  return turn * mount.rotationSigma.head<2>().cwiseAbs2().asDiagonal() * turn.transpose();
}

Eigen::MatrixXd byCameraTilt(const Eigen::Matrix<double, Eigen::Dynamic, 6> &byBase, const vpBasePose &pose,
                             const vpMountFrame &mount)
{
  // The base turns about its origin, which carries the camera along; that way is taken back.
  return byBase.middleCols<2>(3) + byBase.leftCols<3>() * cross(pose.wRb * mount.btc).leftCols<2>();
}

Eigen::MatrixXd lensCovariance(const Eigen::VectorXd &rays, const vpMountFrame &mount)
{
  const Eigen::MatrixXd byPoint = Eigen::Matrix2d::Identity().replicate(rays.size() / 2, 1);
  return mount.principalPointSigma * mount.principalPointSigma * byPoint * byPoint.transpose() +
         mount.focalLengthSigma * mount.focalLengthSigma * rays * rays.transpose();
}

vpMatrix6d mountCovariance(const vpBasePose &pose, const vpMountFrame &mount)
{
  Eigen::Matrix<double, 6, 4> byMount = Eigen::Matrix<double, 6, 4>::Zero(); // translation, yaw
  byMount.topLeftCorner<3, 3>() = -pose.wRb;
  byMount.topRightCorner<3, 1>() = pose.wRb * Eigen::Vector3d::UnitZ().cross(mount.btc);
  byMount.bottomRightCorner<3, 1>() = -pose.wRb.col(2);
  Eigen::Vector4d sigma;
  sigma << mount.translationSigma, mount.rotationSigma.z();
  return byMount * sigma.cwiseAbs2().asDiagonal() * byMount.transpose();
}

vpMatrix6d levelCovariance(const Eigen::MatrixXd &K, const Eigen::MatrixXd &S, const Eigen::MatrixXd &byTilt,
                           const Eigen::Matrix2d &tilt)
{
  const std::array<int, 4> own = {0, 1, 2, 5}; // x, y, z, yaw
  const std::array<int, 2> lean = {3, 4};
  const Eigen::Matrix4d estimated = K * S * K.transpose();
  const Eigen::Matrix<double, 4, 2> withTilt = -K * byTilt * tilt;
  vpMatrix6d covariance;
  covariance(own, own) = (estimated + estimated.transpose()) / 2;
  covariance(own, lean) = withTilt;
  covariance(lean, own) = withTilt.transpose();
  covariance(lean, lean) = tilt;
  return covariance;
}

vpUprightRay::vpUprightRay(const Eigen::Vector2d &ray, const vpMountFrame &mount)
{
  static const double leastRise = 1e-3; // share of a unit ray
  const Eigen::Vector3d up = mount.bRc * ray.homogeneous();
  aboveHorizon = up.allFinite() && up.z() > leastRise * up.norm();
  const Eigen::Vector2d q = up.head<2>() / up.z();
  value = {q.x(), q.y()};
  byRay = (mount.bRc.topLeftCorner<2, 2>() - q * mount.bRc.block<1, 2>(2, 0)) / up.z();
}

std::vector<double> vpLampPair::heights(bool &disagree) const
{
  const std::complex<double> apart = rays[1] - rays[0];
  const double a = std::norm(apart); // a H^2 + 2 b H + c = 0
  const double b = rise * std::real(std::conj(apart) * rays[1]);
  const double c = rise * rise * std::norm(rays[1]) - std::norm(step);
  const double discriminant = b * b - a * c;
  disagree = discriminant < 0;
  std::vector<double> valid;
  if (disagree)
    return valid;
  for (double root : {std::sqrt(discriminant), -std::sqrt(discriminant)}) {
    const double H = (root - b) / a;
    if (H > 0 && H + rise > 0 && (valid.empty() || root < 0))
      valid.push_back(H);
  }
  return valid;
}

std::string sightProblem(const std::vector<vpLampSight> &lamps)
{
  for (size_t k = 0; k < lamps.size(); ++k) {
    const vpLampSight &lamp = lamps[k];
    const std::string name = "lamp " + lamp.id + ": ";
    if (!lamp.ray.allFinite())
      return name + "its ray is not finite";
    if (!lamp.position.allFinite())
      return name + "its position in the map is not finite";
    if (!std::isfinite(lamp.positionSigma) || lamp.positionSigma < 0)
      return name + "the sigma of its position is not a number of 0 or more";
    const Eigen::Matrix2d &C = lamp.covariance;
    if (!C.allFinite() || C(0, 0) < 0 || C(1, 1) < 0 || C.determinant() < -1e-9 * C(0, 0) * C(1, 1))
      return name + "the covariance of its ray has a negative or non-finite variance";
    for (size_t before = 0; before < k; ++before)
      if (lamps[before].id == lamp.id)
        return "lamp " + lamp.id + " is given twice; a lamp hangs in one place only";
  }
  return "";
}

std::string degrees(double angle)
{
  std::ostringstream text;
  text.precision(3);
  text << angle * 180 / M_PI << " degrees";
  return text.str();
}

std::string tooFewLamps(size_t seen)
{
  return seen == 0 ? "no lamp of the map seen" : "one lamp of the map seen, two are needed for a position";
}

vpVlpFix refusedFix(const std::string &refusal)
{
  vpVlpFix fix;
  fix.refusal = refusal;
  return fix;
}

bool describeFix(vpVlpFix &fix, const std::vector<vpLampSight> &lamps, const vpBasePose &pose,
                 const vpVlpRig &rig)
{
  const vpMountFrame mount(rig);
  for (const vpLampSight &lamp : lamps) {
    const vpPredictedRay predicted = predictRay(lamp.position, pose, mount);
    if (!predicted.inFront)
      return false;
    fix.lamps.push_back(lamp.id);
    fix.residuals.emplace_back(lamp.ray - predicted.ray);
  }
  fix.wMb = pose.wMb();
  fix.wMc = fix.wMb * rig.bMc;
  fix.valid = true;
  return true;
}

END_VISP_NAMESPACE
