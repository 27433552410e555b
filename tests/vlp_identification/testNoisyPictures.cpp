/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Lamps in noise that hides their edges, and that the grey scale clips.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <visp3/vlp_identification/vpLedDetector.h>

#include "common/vpLampPicture.h"
#include "common/vpPwmLamps.h"
#include "common/vpUpwardRig.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
//! One lamp of 146 px.
vpLampPicture noisyPicture(double noise, unsigned int seed)
{
  vpLampPicture picture;
  picture.width = picture.height = 200;
  picture.rowTime = picture.exposure = 40e-6;
  picture.blur = 0.7;
  picture.background = 3;
  picture.noise = noise;
  picture.seed = seed;
  picture.lamps.resize(1);
  picture.lamps[0].centre = {99.3, 99.6};
  picture.lamps[0].a = picture.lamps[0].b = 73;
  return picture;
}
} // namespace

//! Both ends of the grey scale clip noise. What black clips makes dark lines brighter, and what white clips
//! makes lit lines darker; no pulse is shorter or longer for it.
TEST(NoisyPictures, NoiseThatTheGreyScaleClipsLeavesDutiesAsTheyAre)
{
  for (const double amplitude : {150.0, 190.0}) {
    double squares = 0, sum = 0; // of normalised errors
    int count = 0;
    for (int phase = 0; phase < 40; ++phase) {
      vpLampPicture painted = noisyPicture(25, static_cast<unsigned int>(phase + 1));
      painted.lamps[0].amplitude = amplitude;
      painted.lamps[0].frequency = 5000 + 31.7 * phase;
      painted.lamps[0].phase = phase / 40.0;
      painted.lamps[0].pwm(0.3);
      vpLedDetector detector(vpUpwardRig(200, 200), vpPwmLamps({2000}));
      detector.detect(painted.render());
      ASSERT_FALSE(detector.observations().empty());
      const vpStripeFeatures &seen = detector.observations()[0].features;
      EXPECT_EQ(seen.dutyClipped, 0) << amplitude;
      const double off = (seen.duty - 0.3) / seen.dutySigma;
      ASSERT_TRUE(std::isfinite(off)) << amplitude;
      squares += off * off;
      sum += off;
      ++count;
    }
    const double rms = std::sqrt(squares / count);
    EXPECT_LT(rms, 1.5) << amplitude;
    EXPECT_LT(std::abs(sum) / count, 3 * rms / std::sqrt(count)) << amplitude; // no bias
  }
}

//! Where noise hides the edge, so that no outline is fitted, a line's light is no better known than its
//! pixels say, and the surroundings are as dark as black makes them: pulse and dark rest do not change
//! places.
TEST(NoisyPictures, DutiesOfLampsWithoutAnEdgeAreWithinTheirSigma)
{
  const double duty = 0.79;
  double squares = 0;
  int told = 0;
  for (unsigned int seed = 1; seed <= 60; ++seed) {
    vpLampPicture noisy = noisyPicture(80, seed);
    noisy.background = noisy.blur = 0;
    noisy.lamps[0].frequency = (58 + 0.03 * seed) / (146 * noisy.rowTime);
    noisy.lamps[0].phase = 0.618 * seed;
    noisy.lamps[0].pwm(duty);
    vpLedDetector detector(vpUpwardRig(200, 200), vpPwmLamps({2000}));
    detector.detect(noisy.render());
    if (detector.observations().empty()) {
      continue;
    }
    const vpStripeFeatures &seen = detector.observations()[0].features;
    if (seen.signal == vpStripeFeatures::Signal::pwm && seen.frequencySigma < 0.1 * seen.frequency) {
      ++told;
      squares += std::pow((seen.duty - duty) / seen.dutySigma, 2);
    }
  }
  EXPECT_GE(told, 30);
  EXPECT_LT(std::sqrt(squares / told), 2);
}

// A wave of twice the frequency explains two short pulses as well, where the lamp may be dark in between.
TEST(NoisyPictures, NoiseMakesNoFrequencyThatIsNone)
{
  int told = 0;
  for (unsigned int seed = 1; seed <= 60; ++seed) {
    vpLampPicture noisy = noisyPicture(40, seed);
    const double frequency = 2.07 / (146 * noisy.rowTime);
    noisy.lamps[0].frequency = frequency;
    noisy.lamps[0].phase = 0.0167 * seed;
    noisy.lamps[0].pwm(0.2);
    vpLedDetector detector(vpUpwardRig(200, 200), vpPwmLamps({frequency, 2000}));
    detector.detect(noisy.render());
    for (const vpLampObservation &seen : detector.observations()) {
      if (seen.features.signal == vpStripeFeatures::Signal::pwm &&
          seen.features.frequencySigma < 0.1 * seen.features.frequency) {
        ++told;
        EXPECT_NEAR(seen.features.frequency, frequency, 6 * seen.features.frequencySigma) << "seed " << seed;
      }
    }
  }
  EXPECT_GE(told, 15); // of 60: the others show their pulses not twice
}
