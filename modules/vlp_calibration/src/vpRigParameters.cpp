/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_calibration/vpRigParameters.h>

#include <cmath>

#include <Eigen/Geometry>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_core/vpPoseText.h>

BEGIN_VISP_NAMESPACE

namespace
{
const double degrees = 180 / M_PI;

Eigen::Vector3d translationOf(const vpVlpRig &rig)
{
  return {rig.bMc[0][3], rig.bMc[1][3], rig.bMc[2][3]};
}
} // namespace

const std::array<vpRigParameterInfo, vpRigParameterCount> &vpRigParameterInfo::all()
{
  static const std::array<vpRigParameterInfo, vpRigParameterCount> infos{
      {{"x", "mm", 1000, 0.01},
       {"y", "mm", 1000, 0.01},
       {"z", "mm", 1000, 0.01},
       {"roll", "deg", degrees, 1 / degrees},
       {"pitch", "deg", degrees, 1 / degrees},
       {"yaw", "deg", degrees, 1 / degrees},
       {"u0", "px", 1, 4},
       {"v0", "px", 1, 4},
       {"focal", "%", 100, 0.01}}};
  return infos;
}

int vpRigParameterInfo::index(const std::string &name)
{
  std::string names;
  for (int i = 0; i < vpRigParameterCount; ++i) {
    const std::string &known = all()[static_cast<size_t>(i)].name;
    if (known == name) {
      return i;
    }
    names += (names.empty() ? "" : ", ") + known;
  }
  throw vpException(vpException::badValue, vpShown(name) + ", expected one of " + names);
}

vpVlpRig vpMovedRig(const vpVlpRig &rig, const vpRigVector &step)
{
  vpVlpRig moved = rig;
  const Eigen::Vector3d turn = step.segment<3>(3);
  const double angle = turn.norm();
  const Eigen::Quaterniond by(angle > 0 ? Eigen::AngleAxisd(angle, turn / angle)
                                        : Eigen::AngleAxisd(0, Eigen::Vector3d::UnitX()));
  moved.bMc = vpPoseOf(Eigen::Vector3d(translationOf(rig) + step.head<3>()),
                       Eigen::Quaterniond(by * vpQuaternionOf(rig.bMc)));
  moved.camera = vpPictureResize::withAxes(rig.camera, rig.camera.get_px() * (1 + step(8)),
                                           rig.camera.get_py() * (1 + step(8)), rig.camera.get_u0() + step(6),
                                           rig.camera.get_v0() + step(7));
  return moved;
}

vpRigVector vpRigStep(const vpVlpRig &from, const vpVlpRig &to)
{
  vpRigVector step;
  step.head<3>() = translationOf(to) - translationOf(from);
  const Eigen::AngleAxisd turn(vpQuaternionOf(to.bMc) * vpQuaternionOf(from.bMc).conjugate());
  step.segment<3>(3) = std::remainder(turn.angle(), 2 * M_PI) * turn.axis();
  step(6) = to.camera.get_u0() - from.camera.get_u0();
  step(7) = to.camera.get_v0() - from.camera.get_v0();
  step(8) = to.camera.get_px() / from.camera.get_px() - 1;
  return step;
}

vpRigVector vpStatedSigma(const vpVlpRig &rig)
{
  vpRigVector sigma = vpRigVector::Zero();
  sigma.head<3>() = rig.translationSigma;
  sigma.segment<3>(3) = rig.rotationSigma;
  sigma.segment<2>(6).setConstant(rig.principalPointSigma.value_or(0));
  sigma(8) = rig.focalLengthSigma.value_or(0);
  return sigma;
}

END_VISP_NAMESPACE
