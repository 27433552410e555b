/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpShutterCalibration_h
#define vpShutterCalibration_h

#include <string>
#include <vector>

#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_core/vpVlpFrame.h>
#include <visp3/vlp_core/vpVlpRig.h>

BEGIN_VISP_NAMESPACE

//! Estimate of the shutter from one lamp in one picture.
struct VISP_EXPORT vpShutterSight {
  std::string picture;      // name of its frame
  std::string lamp;         // id
  double rowTime = 0;       // s, that makes its stripes those of the lamp's frequency
  double sigma = 0;         // s, standard deviation by the stripes alone, the lamp's clock exact
  double exposure = 0;      // s, by the softness of its stripes' edges
  double exposureSigma = 0; // s
  bool used = true;         // false: an outlier
};

//! A rolling shutter as lamps of known frequency show it, or why they do not.
struct VISP_EXPORT vpShutterEstimate {
  bool valid = false;
  std::string refusal;       // one line that says what to do, where not valid
  bool alongColumns = false; // readout along columns instead of rows; stripes do not show its direction
  double rowTime = 0;        // s, of the sensor's lines
  double rowTimeSigma = 0;   // s, clocks of the lamps included
  double exposure = 0;       // s, effective: of sensor, lens and tone curve together
  double exposureSigma = 0;  // s; NaN where the stripes do not tell it, and then exposure, too
  size_t pictures = 0;       // that were analysed
  std::vector<vpShutterSight> sights;
};

/*!
  Row time and effective exposure of a rolling shutter from lamps whose frequency is known.

  Stripes of a lamp that blinks at f measure the product c = f T_row, cycles a line. Each picture is analysed
  as if its lines were rows and as if they were columns, and with several exposures to start from; the reading
  under which most lamps blink, and whose waveforms fit best, is the right one. So nothing needs to be known
  beforehand. A map of several lamps: the row time is that under which most stripes are those of one of its
  lamps.

  The row time is the weighted mean over all sights, in two steps: over the pictures of each lamp, then over
  the lamps, each of whose clocks is off by its `oscillatorPpm`, the same in all its pictures. Sights far from
  the median are left out. Where sights scatter more than their standard deviations, these are inflated to
  match (the Birge ratio).

  A pulse and an exposure are both boxes, and a line's light is their convolution. The lamp's `duty` tells
  which is which; where the map does not state it, the shorter one is taken for the exposure.

  \code
  vpShutterCalibration calibration(rig, map);
  while (source.next(frame)) {
    calibration.add(frame);
  }
  const vpShutterEstimate shutter = calibration.solve();
  \endcode
*/
class VISP_EXPORT vpShutterCalibration
{
public:
  double gate = 5;                  // standard deviations from the median beyond which a sight is left out
  double worstRelativeSigma = 0.01; // a single sight of a larger sigma, as a share, is not used

  /*!
    \param rig What is known of the camera: its `resize` is used, its picture size where it has one (else the
    first frame's), and its row time (0: unknown) where several explain the stripes alike.
    \param lamps Those that may be in view; only pwm and twoPulse lamps are used.
    \throw vpException (badValue) where no lamp has a frequency.
  */
  vpShutterCalibration(const vpVlpRig &rig, const vpLampMap &lamps);

  //! Analyses one picture. \throw vpException (dimensionError) where it has not the size of those before.
  void add(const vpVlpFrame &frame);

  vpShutterEstimate solve() const;

private:
  //! Stripes of one region, in lines: nothing in here depends on a row time.
  struct Stripes {
    size_t picture;
    double cycles, cyclesSigma; // a line
    double duty;
    double exposure, exposureSigma; // lines
    double misfit;
  };
  //! A way to read the pictures.
  struct Reading {
    bool alongColumns;
    double exposure; // lines, to start from
    std::vector<Stripes> stripes;
    double score = 0; // how many lamps blink, each by how well its waveform fits
  };

  void look(const vpVlpFrame &frame, Reading &reading) const;
  double likeliestRowTime(const std::vector<Stripes> &stripes, std::string &refusal) const;
  size_t lampOf(double cycles, double relativeSigma, double rowTime) const;
  std::vector<vpShutterSight> sightsAt(double rowTime, const std::vector<Stripes> &stripes,
                                       std::vector<size_t> &lamps) const;
  void average(vpShutterEstimate &estimate, const std::vector<size_t> &lamps) const;

  vpVlpRig m_rig;
  vpLampMap m_map; // lamps with a frequency
  std::vector<Reading> m_readings;
  std::vector<std::string> m_pictures; // names
};

END_VISP_NAMESPACE

#endif
