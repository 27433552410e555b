/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampBundle_h
#define vpLampBundle_h

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <visp3/vlp_calibration/vpLampRun.h>
#include <visp3/vlp_calibration/vpRigParameters.h>

BEGIN_VISP_NAMESPACE

//! A distance between two lamps that somebody measured.
struct VISP_EXPORT vpLampDistance {
  size_t from = 0, to = 0; // indices into the map
  double metres = 0;
  double sigma = 0.001; // m
};

//! An image point compared with the result.
struct VISP_EXPORT vpBundleResidual {
  size_t run = 0, view = 0, lamp = 0;
  Eigen::Vector2d point = Eigen::Vector2d::Zero();    // px
  Eigen::Vector2d residual = Eigen::Vector2d::Zero(); // px, measured minus predicted
  double sigmas = 0;                                  // Mahalanobis distance
  bool used = true;                                   // false: an outlier
};

/*!
  How a base moves where its odometry measures v and w: at v (1 + speed) + driftPerTurn w, turning at
  w (1 + turn) + turnPerMetre v + turnBias. Wheels whose radii differ by the share e, at a distance d where
  the odometry takes s, have turnPerMetre = e / d, driftPerTurn = e s / 4 and 1 + turn = (1 + speed) s / d.
*/
struct VISP_EXPORT vpOdometryError {
  double speed = 0;        // share
  double driftPerTurn = 0; // m/rad: forwards, while it means to turn on the spot
  double turn = 0;         // share
  double turnPerMetre = 0; // rad/m: while it means to go straight on
  double turnBias = 0;     // rad/s
};

//! What was found, with its covariance.
struct VISP_EXPORT vpBundleResult {
  bool valid = false;
  std::string refusal;                             // one line that says what to do, where not valid
  bool converged = false;                          // else the iterations ended before a minimum
  vpVlpRig rig;                                    // its sigmas those of rigCovariance
  vpRigVector step = vpRigVector::Zero();          // from the rig that was given
  vpRigMatrix rigCovariance = vpRigMatrix::Zero(); // of the step; 0 where it was held
  vpLampMap map;                                   // its sigmas those of lampCovariance
  std::vector<Eigen::Matrix3d> lampCovariance;     // m^2, of each lamp's position
  std::vector<size_t> lampImages;                  // of each lamp, that were used
  std::vector<vpTrajectory> poses;                 // of each run, at the mean time of each view's images
  std::vector<vpBundleResidual> residuals;
  double rms = 0;         // px, of the residuals used, along each axis
  double imageFactor = 1; // by which the stated standard deviations of image points had to be multiplied
  vpOdometryError odometry;
  //! m, standard deviation that was added to positions of lamps which were to be held, but which do not
  //! explain the pictures; 0 where they do.
  double inflatedLampSigma = 0;
  std::vector<size_t> inflatedLamps; // these lamps
  /*!
    Combinations of rig parameters that the pictures do not tell apart, or only by effects smaller than a
    detector's systematic error: each as text, `u0 with x`. Priors take no part in this.
  */
  std::vector<std::string> unseparated;
};

/*!
  Bundle adjustment of a camera on a robot, of the lamps above it and of the robot's way: Levenberg-Marquardt
  (Ceres) over what is left free of rig and lamps, and the pose of each frame.

  An image point is predicted at the time of its own line: the pose belongs to the mean time of the frame's
  images, and from there the base moves on by its odometry, or, without one, as fast as the frames before
  and after show. The residual is that of the solvers, ray = projection of bRc^T (wRb^T (P - wtb) - btc),
  weighed by the point's covariance. Where a lamp's outline is known, its middle is placed in it anew for each
  solution: a camera that leans otherwise than the rig stated sees the middle of a disc elsewhere in its
  ellipse, all of them by the same way. Residuals of the motion: how far the step from frame to frame is off
  the odometry's, along the base, sideways and in heading; its constant errors (vpOdometryError) are estimated
  along, and so is the slip of each wheel, which lasts longer than a step (a Gauss-Markov process along its
  way).

  Huber's loss bounds the influence of an outlier, and points far off are left out in the end. How large the
  errors of image points and odometry truly are is estimated with the rest: variance components (Foerstner
  1979), each the sum of squares of its residuals over their redundancy, which a stochastic trace estimates
  (Hutchinson 1990). So the standard deviations hold where an odometry is better or worse than stated, and a
  detector worse; for a better detector they are kept: an error that all images share shows in no residual.

  The covariance is the inverse of the information of rig and lamps, the poses eliminated (Schur complement).
*/
class VISP_EXPORT vpLampBundle
{
public:
  static constexpr double free = std::numeric_limits<double>::infinity();

  //! Standard deviations of the rig's parameters about their given values: 0 held, free without a prior.
  vpRigVector rigSigma = vpRigVector::Zero();
  //! Standard deviation of each lamp's position about the map's, m: 0 held, free without a prior.
  std::vector<double> lampSigma;
  //! Where no lamp has a prior or is held: a measured distance gives the scale. Its first lamp then keeps x
  //! and y of the map, and the second one its direction from there.
  std::optional<vpLampDistance> distance;

  double slip = 0.01;           // of each wheel's way, standard deviation
  double slipLength = 0.1;      // m rolled, over which slip is forgotten
  double odometryLength = 5e-5; // m, that each step may be off by, standard deviation
  double odometryTurn = 5e-4;   // rad, likewise
  double odometrySpeed = 5e-4;  // m/s, that the speed within a frame may be off by, likewise
  double odometryRate = 5e-3;   // rad/s, that the turn rate within a frame may be off by, likewise
  double odometryChange = 0.1; // of how speed and turn rate change within a frame, beside these two, likewise
  double sideways = 1e-7;      // m, likewise; small, since residuals raise it, and hardly ever lower it
  /*!
    Distance of the wheels, m, where the odometry's turn rate is theirs: then one difference of their radii
    makes both driftPerTurn and turnPerMetre, and without that a sideways offset of the camera would pass for
    the former. Wheels have no bias. 0: the turn rate is a gyro's, which has a bias and does not depend on the
    distance driven.
  */
  double wheelSeparation = 0.16;
  double odometryScale = 0.05;       // of speed and turn rate, prior standard deviation
  double odometryTurnPerMetre = 0.2; // rad/m, likewise
  double odometryDrift = 0.001;      // m/rad, likewise
  double odometryBias = 0.01;        // rad/s, likewise
  double systematicError = 0.02;     // px, what all image points may be off by together
  double outlier = 8;                // standard deviations from which an image point is left out
  int maxIterations = 100;

  /*!
    \param rig First guess, and the middle of its priors.
    \param map Likewise of the lamps; those with a finite lampSigma need to be near the truth, others not.
    \throw vpException (badValue) where lampSigma has not one value for each lamp.
  */
  vpBundleResult solve(const std::vector<vpLampRun> &runs, const vpVlpRig &rig, const vpLampMap &map) const;
};

END_VISP_NAMESPACE

#endif
