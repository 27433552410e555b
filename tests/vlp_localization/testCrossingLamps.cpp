/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Lamps at different heights that pass each other in the picture.

#include <cmath>
#include <utility>

#include <gtest/gtest.h>
#include <visp3/core/vpMeterPixelConversion.h>
#include <visp3/vlp_localization/vpVlpLocalizer.h>
#include <visp3/vlp_simulation/vpSimulation.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
//! Whether what was seen lies in the disc of the lamp whose id it has, or has none.
bool isNamedRightly(const vpLampObservation &seen, double timestamp, vpSimulation &simulation)
{
  const vpLamp *lamp = simulation.map().find(seen.id);
  if (lamp == nullptr) {
    return true;
  }
  const vpVlpRig &rig = simulation.rig();
  const vpHomogeneousMatrix cMw = (simulation.wMb(timestamp + seen.time) * rig.bMc).inverse();
  const vpColVector c = cMw * vpColVector({lamp->position.x(), lamp->position.y(), lamp->position.z(), 1});
  double u = 0, v = 0;
  vpMeterPixelConversion::convertPoint(rig.camera, c[0] / c[2], c[1] / c[2], u, v);
  return std::hypot(seen.point.x() - u, seen.point.y() - v) < 0.5 * lamp->size * rig.camera.get_px() / c[2];
}
} // namespace

// A region of two lamps is neither of them, and no region has its neighbour's stripes.
TEST(CrossingLamps, GiveNoIdToWhatLiesBesideThem)
{
  for (const auto &[seed, frames] : {std::pair(5, 39), std::pair(11, 17)}) {
    vpSimulation simulation(vpScenario::load(VLP_DATA_DIR "/scenarios/crossing.yaml"),
                            static_cast<std::uint64_t>(seed));
    vpVlpLocalizer localizer(simulation.rig(), simulation.map());
    vpVlpFrame frame;
    for (int k = 0; k < frames; ++k) {
      ASSERT_TRUE(simulation.next(frame));
      for (const vpLampObservation &seen : localizer.process(frame).observations) {
        EXPECT_TRUE(isNamedRightly(seen, frame.timestamp, simulation))
            << seen.id << ", seed " << seed << ", " << k;
      }
    }
  }
}
