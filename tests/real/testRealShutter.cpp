/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// vpShutterCalibration on real pictures of a blinking light, nothing known but its frequency.

#include <visp3/vlp_calibration/vpShutterCalibration.h>

#include "real/realSet.h"

namespace
{
vpShutterEstimate rowTimeOf(RealSet &set, double frequency)
{
  vpLamp lamp;
  lamp.id = "light";
  lamp.modulation.kind = vpModulation::Kind::pwm;
  lamp.modulation.frequency = frequency;
  vpShutterCalibration calibration(vpVlpRig(), vpLampMap{{lamp}});
  for (const YAML::Node &image : set.images()) {
    if (image["frequency_hz"].as<double>() == frequency) {
      calibration.add(set.frame(image));
    }
  }
  return calibration.solve();
}

TEST(RealShutter, RowTimeOfOnePictureAt1000Hz)
{
  VLP_REAL_SET(set, "row-time");
  const vpShutterEstimate found = rowTimeOf(set, 1000);
  ASSERT_TRUE(found.valid) << found.refusal;
  EXPECT_FALSE(found.alongColumns);
  std::cout << "row time " << 1e6 * found.rowTime << " +/- " << 1e6 * found.rowTimeSigma << " us\n";
  EXPECT_NEAR(found.rowTime, 14.565e-6, 0.003 * 14.565e-6);
}

TEST(RealShutter, RowTimeOfNarrowPicturesAt5000Hz)
{
  VLP_REAL_SET(set, "row-time");
  const vpShutterEstimate found = rowTimeOf(set, 5000);
  ASSERT_TRUE(found.valid) << found.refusal;
  EXPECT_FALSE(found.alongColumns);
  std::cout << "row time " << 1e6 * found.rowTime << " +/- " << 1e6 * found.rowTimeSigma << " us\n";
  EXPECT_NEAR(found.rowTime, 9.12e-6, 0.005 * 9.12e-6);
}
} // namespace
