/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpTrajectory_h
#define vpTrajectory_h

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <visp3/core/vpHomogeneousMatrix.h>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! A pose of the robot base b in the map w, and its time.
struct VISP_EXPORT vpTimedPose {
  double timestamp = 0;    // s
  vpHomogeneousMatrix wMb; // m
};

/*!
  Poses of the robot base over time, as a TUM file holds them: a row `timestamp tx ty tz qx qy qz qw` (s, m)
  each, fields parted by blanks; lines that begin with # are comments.
*/
class VISP_EXPORT vpTrajectory
{
public:
  /*!
    Reads a TUM file. A quaternion whose length is within 1 % of one is normalised. A file without a row is
    an empty trajectory.
    \throw vpException (ioError, badValue) with one line that names file, line, field, what came and what was
    expected: `truth.tum:7: qw: nan, expected a finite number`.
  */
  static vpTrajectory load(const std::string &filename);

  //! Writes a TUM file, whole or not at all. \throw vpException (ioError) where it cannot be written.
  void save(const std::string &filename) const;

  //! \throw vpException (badValue) where the time is not finite, or not after that of the pose before.
  void add(double timestamp, const vpHomogeneousMatrix &wMb);

  bool empty() const { return m_poses.empty(); }
  size_t size() const { return m_poses.size(); }
  const vpTimedPose &operator[](size_t i) const { return m_poses.at(i); }
  const std::vector<vpTimedPose> &poses() const { return m_poses; }

  /*!
    The pose at a time (s): that of a row of this very time, else between the two rows around it, position
    linearly and rotation along the shorter arc at even speed (slerp). Nothing before the first row and after
    the last, and between rows more than \e longestGap (s) apart.
  */
  std::optional<vpHomogeneousMatrix> at(double time,
                                        double longestGap = std::numeric_limits<double>::infinity()) const;

private:
  std::vector<vpTimedPose> m_poses;
};

END_VISP_NAMESPACE

#endif
