/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpOdometry_h
#define vpOdometry_h

#include <string>
#include <vector>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  The base's own measurement of its motion, in its frame b (x forward, y left, z up). v and w are means
  over the interval from the sample before to \e timestamp: summed over the samples they lose no encoder tick.
  The first sample of a run only opens the first interval; its v and w are undefined.
*/
struct VISP_EXPORT vpOdometry {
  double timestamp = 0; // s, end of the interval, on the clock of the frames' time stamps
  double v = 0;         // m/s along x, from the wheels
  double w = 0;         // rad/s about z, from the wheels or a gyro
};

/*!
  Reads `odometry.csv`: header `timestamp_s,v_m_s,w_rad_s`, then one sample or more, time rising from each to
  the next. \throw vpException with one line that names file, line, column, what came and what was expected.
*/
VISP_EXPORT std::vector<vpOdometry> vpReadOdometry(const std::string &filename);

/*!
  Writes that file, whole or not at all; the numbers read back unchanged. \throw vpException where a sample is
  one that vpReadOdometry() would refuse (badValue), or where the file cannot be written (ioError).
*/
VISP_EXPORT void vpWriteOdometry(const std::string &filename, const std::vector<vpOdometry> &samples);

END_VISP_NAMESPACE

#endif
