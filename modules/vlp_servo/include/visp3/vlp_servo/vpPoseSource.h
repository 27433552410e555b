/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPoseSource_h
#define vpPoseSource_h

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include <visp3/vlp_localization/vpVlpFix.h>
#include <visp3/vlp_robot/vpMobileBase.h>
#include <visp3/vlp_servo/vpPictureFeed.h>

BEGIN_VISP_NAMESPACE

/*!
  What a control loop takes for the pose of its base. Besides that of the lamps there are two to compare it
  with: odometry alone, and commands alone, which closes no loop at all.
*/
class VISP_EXPORT vpPoseSource
{
public:
  virtual ~vpPoseSource() = default;

  virtual void addOdometry(const vpOdometry &) {}
  //! \e told was given to the base at \e time, s.
  virtual void addCommand(double /*time*/, const vpBaseVelocity & /*told*/) {}
  //! Pictures that have become known since the last call.
  virtual std::vector<vpLocatedPicture> look(double /*now*/) { return {}; }
  //! Whether poses come of pictures, without which they are worth nothing after a while.
  virtual bool needsPictures() const { return false; }
  //! Why no more pictures come, in one line; empty as long as some may.
  virtual std::string ended() const { return ""; }

  //! The pose at \e time, s, also a little ahead; not valid where there is none.
  virtual vpVlpFix at(double time) const = 0;
};

/*!
  By the lamps: the pose that the filter had after the newest picture, carried to any later time by
  the odometry since. This compensates the latency of camera and localizer.
*/
class VISP_EXPORT vpVlpPose : public vpPoseSource
{
public:
  //! \param feed Outlives this.
  explicit vpVlpPose(vpPictureFeed &feed) : m_feed(feed) {}

  void addOdometry(const vpOdometry &sample) override;
  std::vector<vpLocatedPicture> look(double now) override;
  bool needsPictures() const override { return true; }
  std::string ended() const override { return m_feed.ended(); }
  vpVlpFix at(double time) const override;

private:
  vpPictureFeed &m_feed;
  std::optional<vpVlpFilter> m_filter;
  std::deque<vpOdometry> m_recent; // which the filter of the next picture may not know yet
};

//! Calibrated errors of odometry. The default leaves it uncorrected.
struct VISP_EXPORT vpOdometryCalibration {
  double speedScale = 1; // true speed over that of the wheels
  double turnScale = 1;  // true turn rate over that of the odometry, once without bias
  double turnBias = 0;   // rad/s
};

//! By odometry alone, from a known start on.
class VISP_EXPORT vpOdometryPose : public vpPoseSource
{
public:
  //! \param wMb Where the base stands at \e time, s.
  vpOdometryPose(const vpHomogeneousMatrix &wMb, double time, const vpOdometryCalibration &calibration = {});

  void addOdometry(const vpOdometry &sample) override;
  vpVlpFix at(double time) const override;

private:
  vpHomogeneousMatrix m_wMb;
  double m_time; // s
  vpBaseVelocity m_velocity;
  vpOdometryCalibration m_calibration;
};

//! As if the base followed its commands exactly, from a known start on: open loop.
class VISP_EXPORT vpCommandedPose : public vpPoseSource
{
public:
  //! \param wMb Where the base stands at \e time, s.
  vpCommandedPose(const vpHomogeneousMatrix &wMb, double time) : m_wMb(wMb), m_time(time) {}

  void addCommand(double time, const vpBaseVelocity &told) override;
  vpVlpFix at(double time) const override;

private:
  vpHomogeneousMatrix m_wMb;
  double m_time; // s
  vpBaseVelocity m_velocity;
};

/*!
  Where a base at \e wMb is after \e time (s) of a constant velocity: on an arc, in the plane of its own x and
  y.
*/
VISP_EXPORT vpHomogeneousMatrix vpDrivenOn(const vpHomogeneousMatrix &wMb, const vpBaseVelocity &velocity,
                                           double time);

END_VISP_NAMESPACE

#endif
