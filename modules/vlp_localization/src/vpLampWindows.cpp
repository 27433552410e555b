/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLampWindows.h"

#include <algorithm>
#include <cmath>

#include "vpLampPicture.h"

BEGIN_VISP_NAMESPACE

void vpLampWindows::expect(const vpVlpFilter &filter, const vpLampMap &map, const vpVlpRig &rig,
                           double lineTime, std::vector<vpRect> &windows)
{
  static const double farthest = 3;  // heights of a lamp above the camera
  static const double unknown = 0.1; // rad: the lamps are then anywhere
  const vpVlpFilter::Pose pose = filter.pose();
  const double place = std::sqrt(std::max(pose.covariance(0, 0), pose.covariance(1, 1))),
               turn = std::sqrt(pose.covariance(5, 5));
  for (const vpLamp &lamp : map.lamps) {
    const double height = lamp.position.z() - pose.wtc.z(),
                 apart = std::hypot(lamp.position.x() - pose.wtc.x(), lamp.position.y() - pose.wtc.y());
    if (!(height > 0 && apart < farthest * height && turn + place / height < unknown)) {
      continue;
    }
    const vpLampPicture picture(lamp, {pose.wMb.linear(), pose.wMb.translation()}, rig);
    if (!picture.inFront()) {
      continue;
    }
    const Eigen::Vector2d extent = picture.extent(filter.velocity(), lineTime);
    const Eigen::Vector2d motion = picture.motion(filter.velocity());
    Eigen::Vector2d middle = picture.middle();
    const int along = rig.shutter.alongColumns() ? 0 : 1;
    const double lines = middle(along) - 0.5 * ((along == 0 ? rig.width : rig.height) - 1.0);
    middle += motion * lineTime * lines / std::max(0.1, 1 - motion(along) * lineTime);
    static const double sigmas = 3, around = 0.7; // of the extent, on each side
    const double uncertain = sigmas * rig.camera.get_px() * (place + turn * apart) / height;
    const Eigen::Vector2d half =
        (std::isfinite(lamp.size) ? 0.5 + around : 0.2) * extent + Eigen::Vector2d(uncertain, uncertain);
    const Eigen::Vector2d least = middle - half, most = middle + half;
    if (most.minCoeff() > 0 && least.x() < rig.width - 1 && least.y() < rig.height - 1) {
      windows.emplace_back(least.x(), least.y(), 2 * half.x(), 2 * half.y());
    }
  }
}

END_VISP_NAMESPACE
