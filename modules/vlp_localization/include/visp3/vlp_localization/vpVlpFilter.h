/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpVlpFilter_h
#define vpVlpFilter_h

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <visp3/vlp_core/vpVlpRig.h>
#include <visp3/vlp_localization/vpVlpFix.h>
#include <visp3/vlp_robot/vpOdometry.h>

BEGIN_VISP_NAMESPACE

/*!
  Extended Kalman filter of a robot that looks at lamps: each lamp's image point is a measurement of its own,
  at the time of its own line, so that one lamp still corrects the pose and a rolling shutter bends nothing.

  The state, with its covariance:
  - the pose: x, y, z, yaw, and roll and pitch about x and y of b. The last two are constants of the rig, as
    uncertain as its rotationSigma states (known where that is 0): the base stands level and the camera leans
    about its own centre. Where the attitude is free both lean as one, and change;
  - the velocity of the base along x and y of b and its turn rate, constant but for random accelerations;
  - the odometry's errors: scales of speed and turn rate, bias of the turn rate;
  - what the rig's mount and the map's lamps may be off by, where they state a standard deviation, and with
    the mount's principal point and focal length, assumed where the rig does not state them. These errors
    are the same in every frame, and no averaging over frames takes them away: they are considered, not
    estimated (Schmidt 1966), so that the covariance stays honest. Roll and pitch are estimated, as far as a
    turning robot shows them.

  The measurement is that of the solvers: ray = projection of bRc^T (wRb^T (P - wtb) - btc).

  The variance of the lamps' image points is matched to the innovations. How large the random accelerations
  are, and what the odometry is worth, are hypotheses: set them, advance and update, and mix() the filters of
  several of them by how likely the lamps were (Blom and Bar-Shalom 1988).

  Odometry is the velocity's mean over the interval of each sample. Where it is followed, the base moves
  between samples on the arc of that velocity, and accelerates at random where there is none.

  \code
  vpVlpFilter filter(rig);
  filter.start(wMb, time);            // a first pose, as from vpManyLampSolver
  filter.mark(time);                  // of a frame
  filter.advance(time + lamp.time);   // its lamps in the order of time
  filter.update(sight);
  const vpVlpFix before = filter.marked(), now = filter.fixAt(time + 0.1);
  \endcode
*/
class VISP_EXPORT vpVlpFilter
{
public:
  //! Thresholds on the covariance, no more: whoever drives a robot decides by the covariance itself.
  enum class State {
    starting, //!< no pose yet
    tracking, //!< the pose is as certain as trackingSigma and trackingYaw demand
    coasting, //!< less certain, yet more than lostSigma and lostYaw: a lamp or two, or none, for a while
    lost      //!< less certain than these; a new start is needed
  };

  double trackingSigma = 0.02; // m, of x and of y
  double trackingYaw = 0.05;   // rad
  double lostSigma = 0.2;      // m
  double lostYaw = 0.6;        // rad

  double acceleration = 0.5;   // m/s^2/sqrt(Hz), random, along x and y of b, of a robot that starts and stops
  double turnAcceleration = 3; // rad/s^2/sqrt(Hz), likewise
  double manoeuvreShare = 1;   // of both, less than 1 of a robot that goes on as it does
  double drift = 0.002;        // m/sqrt(s), of z where the robot moves: a floor is not quite flat
  double tiltDrift = 0.05;     // rad/sqrt(s), of roll and pitch where the attitude is free
  double rollingTilt = 0.004;  // rad/sqrt(Hz), likewise between the plane of b and the way that it goes
  double startPlace = 0.3;     // m, standard deviation of x, y and z at the start, before its lamps are seen
  double startTurn = 0.3;      // rad, likewise of yaw
  double startVelocity = 0.2;  // m/s, likewise
  double startTurnRate = 1.5;  // rad/s, likewise
  double odometrySpeed = 0.002;    // m/s, standard deviation of a sample, along x and y: encoders count ticks
  double odometryShare = 0.01;     // likewise as a share of speed and turn rate: wheels slip now and then
  double odometryTurnRate = 0.005; // rad/s, likewise
  double odometryScale = 0.02;     // standard deviation of the speed's scale: a slip that stays
  double odometryTurnScale = 0.01; // of the turn rate's scale
  double odometryTurnBias = 0.002; // rad/s, of the turn rate's bias
  double odometryHeading = 0.03;   // rad, of the wheels' way ahead in b: the camera is turned on the robot
  double principalPoint = 0.001;   // normalised units, standard deviation, of a rig that states one for its
                                   // mount and none for its lens
  double focalLength = 0.003;      // share, likewise
  double claimedTilt =
      0.004; // rad, widenClaims(): standard deviation added to roll and pitch, each time twice as much
  double claimedPlace = 0.002; // m, likewise to each coordinate of each lamp
  bool freeAttitude = false; // roll and pitch change, and are as uncertain as the fix at the start; the base
                             // moves along its x and y, not level

  enum class Odometry {
    ignored,
    measured, //!< a measurement of a velocity that is constant but for the random accelerations
    followed  //!< the velocity is the odometry's
  };
  Odometry odometry = Odometry::followed;
  static constexpr double clockSetBack = 1; // s, by which what is earlier than before shows that of a clock

  explicit vpVlpFilter(const vpVlpRig &rig);

  /*!
    Starts from a pose good enough to linearise about. Its covariance is not used: the lamps that it came from
    are to follow as updates.
  */
  void start(const vpHomogeneousMatrix &wMb, double time);
  //! The same start once more, linearised, up to conclude(), about what the lamps since then have shown:
  //! their marked() pose and velocity. The lamps are to follow again, and so is the odometry \e odometryToo.
  void startAgain(bool odometryToo = false);
  void stop() { m_started = false; }
  bool started() const { return m_started; } // else time, lamps and marks change nothing

  /*!
    To be given before advance() passes the interval that it closes; a sample that is not later than the one
    before is left out. Where it is earlier by clockSetBack the clock was set back: it opens a first
    interval. \throw vpException (badValue) where a value is not finite.
  */
  void addOdometry(const vpOdometry &sample);
  //! The samples of another filter that are later than its own.
  void takeOdometry(const vpVlpFilter &other);
  //! Whether it tells of the time up to the next line that is seen.
  bool hasOdometry() const { return m_odometry.size() > 1; }
  //! Whether the latest sample is of wheels that do not stand.
  bool rolls() const;
  //! Log density of that one of its samples since the mark that is the least likely; very large without any.
  double leastOdometry() const { return m_leastOdometry; }

  //! Predicts up to \e time, s. Before time(): no more than a small step back, as for a line read earlier.
  void advance(double time);
  double time() const { return m_time; }

  //! A lamp's ray compared with its prediction, before the update.
  struct Innovation {
    bool inFront = false;                                 // of the camera, else the rest means nothing
    Eigen::Vector2d ray = Eigen::Vector2d::Zero();        // measured minus predicted, normalised units
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero(); // as predicted, the measurement's own included
    double depth = 0;                                     // m, of the lamp along the camera's axis
    Eigen::Matrix2d byPlace = Eigen::Matrix2d::Zero();    // 1/m, of ray by x and y of the lamp in w
    //! Mahalanobis distance squared, \e tolerance (m) added for how far lamps may hang from their place.
    double distance(double tolerance) const;
  };
  Innovation innovation(const vpLampSight &lamp) const;

  //! Makes the lamp's error a part of the state: filters that mix() have the same lamps.
  void expect(const vpLampSight &lamp);
  //! Corrects the state, its covariance in Joseph's form. \e lamp at time().
  void update(const vpLampSight &lamp);

  //! What both have in common, for who asks the one before the other: where a lamp is expected, once started.
  struct Predicted;
  Predicted predict(const vpLampSight &lamp) const;
  Innovation innovation(const vpLampSight &lamp, const Predicted &predicted) const;
  void update(const vpLampSight &lamp, const Predicted &predicted);

  /*!
    Mean and covariance of a mixture. \param parts Copies of one filter that went on under different
    hypotheses up to the same time, this one among them or not. \param weights Of each; their sum is 1.
  */
  void mix(const std::vector<const vpVlpFilter *> &parts, const std::vector<double> &weights);

  //! Adds claimedTilt and claimedPlace to the stated sigmas of the rig's attitude and the map's places, from
  //! the next start() on: earlier estimates rest on the stated sigmas alone.
  void widenClaims();
  bool claimsWidened() const { return m_extraPlaceSigma > 0; }
  double extraPlaceSigma() const { return m_extraPlaceSigma; } // m, of lamps' places: so far they are widened

  //! After start(): the velocity is what led here from \e before (m, of x and y in w; rad), \e since s ago.
  void comeFrom(const vpVlpFix &before, double since);

  /*!
    Linearises what follows about the path on which \e corrected has come to its mark(), up to conclude(): the
    estimate stays what it is, and is carried along as an offset from that path (iterated filter with the
    interval before the mark smoothed, Bell and Cathey 1993). \return False along odometry, which measures the
    path well enough: then nothing changes.
  */
  bool linearizeAbout(const vpVlpFilter &corrected);
  /*!
    The lamps of a frame are through: from here on about the estimate again. Of a robot that stands, what the
    lamps' points are stated to be off by and innovations do not show may be alike in all frames, as where
    stripes hide the same of an outline in each: no averaging takes it away, and poses have it in their
    covariance.
  */
  void conclude();

  /*!
    Predicts up to \e time and keeps the pose of then as a part of the state: what follows corrects it, too
    (stochastic cloning, Roumeliotis and Burdick 2002). So a frame's pose is that at its time stamp, though
    its lamps were seen later.
  */
  void mark(double time);
  vpVlpFix marked() const;
  //! Sets nothing but pose and covariance, and takes no memory.
  void tellMarked(vpVlpFix &fix) const;

  //! A pose in Eigen's terms: takes no memory.
  struct Pose {
    Eigen::Isometry3d wMb;
    Eigen::Vector3d wtc;                    // m, of the camera
    Eigen::Matrix<double, 6, 6> covariance; // as vpVlpFix's
  };
  //! The pose at time(), once started.
  Pose pose() const { return poseOf(x); }
  //! That at the mark.
  Pose markedPose() const { return poseOf(mark0); }
  vpVlpFix now() const { return fixOf(x); }
  //! The pose at any time: as predicted from time(), along the odometry as far as it is known, and by a robot
  //! that may start and stop from there on.
  vpVlpFix fixAt(double time) const;
  State state(const vpVlpFix &fix) const;
  State state(const Pose &pose) const { return stateOf(pose.covariance); }

  //! Along x and y of b (m/s), and the turn rate (rad/s).
  Eigen::Vector3d velocity() const { return m_x.segment<3>(vx); }
  Eigen::Matrix3d velocityCovariance() const { return m_P.block<3, 3>(vx, vx); }

private:
  enum Index {
    x,
    y,
    z,
    yaw,
    roll,
    pitch,
    vx,
    vy,
    w,
    speedScale,
    turnScale,
    turnBias,
    wheels,           // heading of what they call ahead, in b, rad
    mount,            // translation in b, m; heading about z of b
    lens = mount + 4, // principal point, in normalised coordinates; focal length, as a share
    mark0 = lens + 3, // x to pitch, at the mark
    lamps = mark0 + 6
  };
  static constexpr std::array<std::pair<Index, Index>, 2> estimated = {{{x, mount}, {mark0, lamps}}};
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;

  //! Derivative of a measurement by the state: its rows that are not zero, and which of the state they are.
  template <int Values>
  struct Derivative {
    std::array<Eigen::Index, 16> at;
    Eigen::Matrix<double, 16, Values> rows;
    int count = 0;

    void add(Eigen::Index index, const Eigen::Matrix<double, 1, Values> &row)
    {
      at[static_cast<size_t>(count)] = index;
      rows.row(count++) = row;
    }
  };
  //! What the estimate's offset makes of a measurement.
  template <int Values>
  Eigen::Matrix<double, Values, 1> aside(const Derivative<Values> &H) const
  {
    Eigen::Matrix<double, Values, 1> sum = Eigen::Matrix<double, Values, 1>::Zero();
    for (int k = 0; m_aside && k < H.count; ++k) {
      sum += m_offset(H.at[static_cast<size_t>(k)]) * H.rows.row(k).transpose();
    }
    return sum;
  }
  Eigen::Index lampIndex(const vpLampSight &lamp) const;
  double placeSigma(const vpLampSight &lamp) const
  {
    return std::hypot(lamp.positionSigma, m_extraPlaceSigma);
  }
  //! \param stated The covariance that the lamp's ray came with.
  void weighNoise(const Innovation &seen, const Eigen::Matrix2d &stated);
  Pose poseOf(Index first) const;
  void tell(Index first, vpVlpFix &fix) const;
  vpVlpFix fixOf(Index first) const;
  State stateOf(const Eigen::Matrix<double, 6, 6> &covariance) const;
  void standAside(const Eigen::Matrix<double, 9, 1> &path);
  void carryAlong(Index first, const Eigen::Vector2d &shift);
  void mirror();
  //! \param R Covariance of what was measured. \return That of the innovation.
  template <int Values>
  Eigen::Matrix<double, Values, Values> measure(const Derivative<Values> &H,
                                                const Eigen::Matrix<double, Values, 1> &innovation,
                                                const Eigen::Matrix<double, Values, Values> &R);
  void arc(double dt);
  void move(double dt, bool accelerates);
  void wander(double time);
  void useOdometry(const vpOdometry &before, const vpOdometry &sample);

  struct Given; // the rig
  struct Start;
  std::shared_ptr<const Given> m_given; // of all copies
  std::shared_ptr<const Start> m_start; // state, covariance and odometry at the start
  bool m_started = false;
  double m_time = 0;     // s
  double m_markTime = 0; // s
  Vector m_x;
  Matrix m_P;
  Vector m_offset;                                    // of the estimate from m_x,
  bool m_aside = false;                               // where it is not m_x: see linearizeAbout()
  std::vector<std::string> m_lamps;                   // ids whose errors are states, in their order
  Eigen::Matrix<double, Eigen::Dynamic, 3> m_PH, m_K; // of measure(): kept, so that it takes no memory
  std::vector<vpOdometry> m_odometry; // not used up yet; the first one's time begins the next interval
  double m_extraTiltSigma = 0;        // rad, added to the rig's sigma of roll and pitch
  double m_extraPlaceSigma = 0;       // m, added to the map's sigma of its lamps
  double m_noise = 1;                 // variance of the lamps' points, as a share of the stated one
  int m_weighed = 0;                  // points that it rests on
  Eigen::Matrix4d m_information = Eigen::Matrix4d::Zero(); // of x, y, z and yaw, by the lamps since the mark
  int m_sights = 0;                                        // lamps since the mark
  double m_imageSpeed = 0;                                 // px/s, of the fastest of them
  double m_leastOdometry = std::numeric_limits<double>::max();
  Eigen::Matrix4d m_common =
      Eigen::Matrix4d::Zero(); // covariance of what frames have in common: see conclude()
  double m_followed = -1e300;  // s, end of the interval whose odometry the velocity is
};

extern template Eigen::Matrix3d vpVlpFilter::measure<3>(const Derivative<3> &, const Eigen::Vector3d &,
                                                        const Eigen::Matrix3d &);

END_VISP_NAMESPACE

#endif
