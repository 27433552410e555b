/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_calibration/vpLampRun.h>

#include <unordered_map>

#include <Eigen/LU>

BEGIN_VISP_NAMESPACE

vpLampView vpLampView::of(double timestamp, const std::string &name,
                          const std::vector<vpLampObservation> &observations, const vpLampMap &map)
{
  vpLampView view;
  view.timestamp = timestamp;
  view.name = name;
  std::unordered_map<std::string, int> shown; // two regions of one id: a reflection, one does not know which
  for (const vpLampObservation &seen : observations) {
    ++shown[seen.id];
  }
  for (const vpLampObservation &seen : observations) {
    const vpLamp *lamp = seen.id.empty() ? nullptr : map.find(seen.id);
    if (lamp == nullptr || seen.cut || shown[seen.id] > 1 || !seen.point.allFinite() ||
        !(seen.covariance.determinant() > 0) || seen.outline.shape == vpLampOutline::Shape::region) {
      continue;
    }
    vpLampImage image;
    image.lamp = static_cast<size_t>(lamp - map.lamps.data());
    image.time = timestamp + seen.time;
    image.point = seen.point;
    image.outline = seen.outline;
    image.covariance = seen.covariance;
    view.images.push_back(image);
  }
  return view;
}

double vpLampView::middle() const
{
  if (images.empty()) {
    return timestamp;
  }
  double sum = 0;
  for (const vpLampImage &image : images) {
    sum += image.time;
  }
  return sum / static_cast<double>(images.size());
}

END_VISP_NAMESPACE
