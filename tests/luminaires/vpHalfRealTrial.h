/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpHalfRealTrial_h
#define vpHalfRealTrial_h

#include "luminaires/vpHalfRealPicture.h"

/*!
  \file vpHalfRealTrial.h
  Half-real pictures drawn at random, with the rig and the lamp map that a user would state for them.
*/

BEGIN_VISP_NAMESPACE

//! Ranges from which pictures are drawn, each evenly unless it says otherwise.
struct vpHalfRealRanges {
  int lampsOfMap = 5, fewest = 3, most = 5;            // lamps of a map, and of one picture of it
  double lowest = 1000, highest = 5000;                // Hz, by the logarithm
  double apart = 1.1;                                  // least ratio of two frequencies of the map
  double periods = 4;                                  // least number of them over what is lit of a lamp
  double shortest = 40, longest = 200;                 // px, diameter, by the logarithm; lines of what is lit
  double tilt = 0.6;                                   // rad, largest
  double leastDuty = 0.2, mostDuty = 0.8;              //
  double dutyStated = 0.5;                             // probability that the map states it
  double leastRowTime = 10e-6, mostRowTime = 45e-6;    // s
  double rowTimeSigma = 0.003;                         // share, standard deviation of the claim
  double leastExposure = 10e-6, mostExposure = 120e-6; // s, by the logarithm
  double exposurePeriods = 1. / 3;                     // longest exposure, periods of the map's fastest lamp
  double claimFactor = 4;                              // claim over truth, to both sides, by the logarithm
  double leastNoise = 0.5, mostNoise = 2;              // grey levels
  double leastLevel = 30, mostLevel = 250;             // grey levels of a lamp's brightest pixel
  double electrons = 30;                               // for one grey level
  double gamma = 1;                                    // tone curve of each picture
  int jpeg = 0;                                        // quality of each picture; 0: none
  vpModulation::Kind kind = vpModulation::Kind::pwm;   // of all lamps
};

//! A picture with its truth, and what a user states of it.
struct vpHalfRealTrial {
  vpHalfRealPicture picture; // the truth
  vpLampMap truth;           // with all duties
  vpLampMap map;             // as stated
  vpVlpRig rig;              // as stated
};

/*!
  The user's side of a trial and a sensor to match, without any lamp in the picture yet.
  \throw vpException (badValue) where the ranges allow no map.
*/
vpHalfRealTrial vpDrawTrial(const vpHalfRealRanges &ranges, std::mt19937_64 &generator);

//! Another picture of the same sensor and map: lamps of the patterns that do not touch each other.
void vpDrawLamps(const vpHalfRealRanges &ranges, const std::vector<vpEmissionPattern> &patterns,
                 vpHalfRealTrial &trial, std::mt19937_64 &generator);

END_VISP_NAMESPACE

#endif
