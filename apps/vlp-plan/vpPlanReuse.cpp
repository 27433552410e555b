/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpPlanReuse.h"

#include <opencv2/imgproc.hpp>
#include <visp3/core/vpException.h>
#include <visp3/core/vpPixelMeterConversion.h>
#include <visp3/core/vpRotationMatrix.h>
#include <visp3/vlp_identification/vpIdentifierLayout.h>
#include <visp3/vlp_identification/vpLedIdPlanner.h>

#include "vpPlanText.h"

BEGIN_VISP_NAMESPACE

double vpViewRadius(const vpVlpRig &rig, double height)
{
  vpRotationMatrix bRc;
  rig.bMc.extract(bRc);
  std::vector<cv::Point2f> ceiling; // a metre above the camera
  for (const double u : {0., rig.width - 1.}) {
    for (const double v : {0., rig.height - 1.}) {
      double x = 0, y = 0;
      vpPixelMeterConversion::convertPoint(rig.camera, u, v, x, y);
      const vpColVector up = bRc * vpColVector(std::vector<double>{x, y, 1});
      static const double leastRise = 0.05; // of a ray
      if (!(up[2] > leastRise * std::sqrt(up.sumSquare()))) {
        throw vpException(vpException::badValue,
                          "--view-radius: nothing, expected a radius (m): the picture shows the horizon");
      }
      ceiling.emplace_back(static_cast<float>(up[0] / up[2]), static_cast<float>(up[1] / up[2]));
    }
  }
  cv::Point2f centre;
  float radius = 0;
  cv::minEnclosingCircle(ceiling, centre, radius);
  return height * static_cast<double>(radius);
}

vpReportTable vpLayOver(vpLampMap &map, const std::vector<vpModulation> &signals, double viewRadius)
{
  std::vector<Eigen::Vector3d> positions;
  for (const vpLamp &lamp : map.lamps) {
    positions.push_back(lamp.position);
  }
  vpIdentifierLayout layout;
  layout.viewRadius = viewRadius;
  const vpIdentifierAssignment laid = layout.lay(positions, signals.size());
  for (size_t i = 0; i < map.lamps.size(); ++i) {
    map.lamps[i].modulation = signals[laid.identifiers[i]];
  }

  const std::vector<vpLedIdReuse> shared = vpLedIdPlanner::reuse(map); // those nearest to each other first
  const std::string apart = shared.empty()
                                ? "none is on two lamps"
                                : vpFigureText(shared[0].apart) + " (" + map.lamps[shared[0].first].id +
                                      ", " + map.lamps[shared[0].second].id + ")";
  const size_t used = map.identifiers().size();
  const std::string of = used == signals.size() ? "" : " of " + std::to_string(signals.size());
  vpReportTable table;
  table.heading = "Identifiers over lamps";
  table.columns = {"", ""};
  table.rows = {{"lamps", std::to_string(map.lamps.size())},
                {"identifiers", std::to_string(used) + of},
                {"radius of a view, m", vpFigureText(viewRadius)},
                {"least distance between two lamps of one identifier, m", apart},
                {"pairs of lamps that a view can hold", std::to_string(laid.pairsInView)},
                {"of these, with one identifier", std::to_string(laid.repeatedPairs)},
                {"sets of three lamps", std::to_string(laid.triples)},
                {"of these, repeated: they look like another one", std::to_string(laid.repeatedTriples)}};
  table.note = "A view that holds a set of three that is not repeated says where the robot is.";
  return table;
}

END_VISP_NAMESPACE
