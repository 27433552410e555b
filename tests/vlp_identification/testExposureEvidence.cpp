/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// What lamps say of the exposure together.

#include <cmath>

#include <gtest/gtest.h>
#include <visp3/vlp_identification/vpExposureEvidence.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
const double stated = 40e-6, twice = 0.69; // s; standard deviation of the logarithm: a factor of two

//! A lamp whose stripes show an exposure to a share of it.
vpStripeFeatures seenWith(double exposure, double share)
{
  vpStripeFeatures seen;
  seen.signal = vpStripeFeatures::Signal::pwm;
  seen.frequencySigma = 1;
  seen.duty = 0.5;
  seen.exposure = exposure;
  seen.exposureSigma = share * exposure;
  return seen;
}

//! Lamps of different frequencies: of one frequency all pulses might be the exposure.
vpExposureEvidence after(const std::vector<vpStripeFeatures> &lamps)
{
  const vpExposureEvidence before(stated, twice);
  vpExposureEvidence evidence = before;
  double frequency = 1000; // Hz
  for (vpStripeFeatures seen : lamps) {
    seen.frequency = frequency;
    frequency *= 1.3;
    evidence.add(seen, before);
  }
  return evidence;
}
} // namespace

TEST(ExposureEvidence, WithoutLampsIsWhatTheRigStates)
{
  const vpExposureEvidence evidence = after({});
  EXPECT_DOUBLE_EQ(evidence.exposure(), stated);
  EXPECT_DOUBLE_EQ(evidence.logSigma(), twice);
  EXPECT_FALSE(evidence.contradicts());
}

// A reading as uncertain as the claim is the claim: however many of them there are, they add nothing.
TEST(ExposureEvidence, WhatWasKnownBeforeCountsOnce)
{
  const vpExposureEvidence evidence = after(std::vector<vpStripeFeatures>(10, seenWith(stated, twice)));
  EXPECT_GT(evidence.logSigma(), 0.7 * twice);
  EXPECT_NEAR(std::log(evidence.exposure() / stated), 0, 0.3 * twice);
}

TEST(ExposureEvidence, LampsThatAgreeTellIt)
{
  const double shown = 2.5 * stated;
  const vpExposureEvidence evidence = after(std::vector<vpStripeFeatures>(4, seenWith(shown, 0.03)));
  EXPECT_NEAR(std::log(evidence.exposure() / shown), 0, 3 * evidence.logSigma());
  EXPECT_LT(evidence.logSigma(), 0.1);
  EXPECT_TRUE(evidence.contradicts());
}

// Tone curves and blur soften lamps differently: lamps that scatter say less than lamps that agree.
TEST(ExposureEvidence, LampsThatScatterTellLess)
{
  const vpExposureEvidence agreeing = after(std::vector<vpStripeFeatures>(4, seenWith(stated, 0.03))),
                           scattered = after({seenWith(0.8 * stated, 0.03), seenWith(0.95 * stated, 0.03),
                                              seenWith(1.05 * stated, 0.03), seenWith(1.25 * stated, 0.03)});
  EXPECT_GT(scattered.logSigma(), 1.5 * agreeing.logSigma());
}

TEST(ExposureEvidence, OneLampThatIsOffDoesNotMoveTheOthers)
{
  const vpExposureEvidence evidence =
      after({seenWith(stated, 0.03), seenWith(stated, 0.03), seenWith(stated, 0.03), seenWith(stated, 0.03),
             seenWith(3 * stated, 0.03)});
  EXPECT_NEAR(std::log(evidence.exposure() / stated), 0, 0.15);
}
