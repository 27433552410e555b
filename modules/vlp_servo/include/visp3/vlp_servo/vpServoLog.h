/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpServoLog_h
#define vpServoLog_h

#include <string>

#include <visp3/vlp_core/vpTrajectory.h>
#include <visp3/vlp_servo/vpPath.h>
#include <visp3/vlp_servo/vpServoRun.h>

BEGIN_VISP_NAMESPACE

/*!
  A run as a folder keeps it: `path.yaml`; `commands.csv`, a row for each period of the loop; `odometry.csv`;
  `poses.tum`, the pose of each picture at its own time; and where it is known `truth.tum`, the true pose at
  the time of each command.
*/
struct VISP_EXPORT vpServoLog {
  vpPath path;
  vpServoRun run;
  vpTrajectory poses;
  vpTrajectory truth; // may be empty

  //! The header of commands.csv: the command to the base, the output of the control law, the reference, and
  //! the pose that the command rests on, whose fields are empty where there was none.
  static const std::string columns;

  //! Writes these files into an existing folder, each whole or not at all. \throw vpException (ioError).
  void save(const std::string &folder) const;

  /*!
    Reads them back: of the run its steps only. \throw vpException with one line that names file, line, field,
    what came and what was expected.
  */
  static vpServoLog load(const std::string &folder);

  //! Errors from the path, by the true poses; empty where they are not known.
  std::vector<vpTrackError> trueErrors() const;
  //! Errors from the path, by the poses that the loop estimated.
  std::vector<vpTrackError> estimatedErrors() const { return vpTrackErrorsOf(path, run); }
};

END_VISP_NAMESPACE

#endif
