/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpDutyRidge_h
#define vpDutyRidge_h

#include <optional>
#include <vector>

#include <visp3/vlp_core/vpLampObservation.h>

BEGIN_VISP_NAMESPACE

//! Frequency and duty where stripes leave them open together: what vpStripeFeatures::alongDuty says.
class vpDutyRidge
{
public:
  //! Under a duty that is known about so well.
  struct Reading {
    double frequency, frequencySigma; // Hz
    double duty, dutySigma;
    double density;  // of the duty that was seen
    double distance; // of it, standard deviations
    double spread;   // Hz, of frequencies by a duty that is not stated, standard deviation
  };

  /*!
    What the stripes say of a lamp whose map states the duty, good to \e dutyError, or does not. Where
    alongDuty is empty, duty and frequency know nothing of each other; without a stated duty the density is 1
    and the distance 0.
  */
  static Reading of(const vpStripeFeatures &seen, const std::optional<double> &stated, double dutyError);

  //! Takes frequency and duty, whatever the lamp, from alongDuty where it says something.
  static void settle(vpStripeFeatures &features);

  //! What alongDuty is of two frames of one lamp.
  static std::vector<vpDutySlice> together(const vpStripeFeatures &one, const vpStripeFeatures &other);

  //! Those slices, or none where one duty alone explains the stripes.
  static std::vector<vpDutySlice> whereOpen(std::vector<vpDutySlice> slices);

private:
  static vpDutySlice at(const vpStripeFeatures &seen, double duty);
};

END_VISP_NAMESPACE

#endif
