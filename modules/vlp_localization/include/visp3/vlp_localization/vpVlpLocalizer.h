/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpVlpLocalizer_h
#define vpVlpLocalizer_h

#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include <visp3/vlp_core/vpVlpFrame.h>
#include <visp3/vlp_localization/vpLampMatcher.h>
#include <visp3/vlp_localization/vpManyLampSolver.h>
#include <visp3/vlp_localization/vpTwoLampSolver.h>
#include <visp3/vlp_localization/vpVlpFilter.h>
#include <visp3/vlp_localization/vpVlpHypotheses.h>
#include <visp3/vlp_tracking/vpLampTracker.h>

BEGIN_VISP_NAMESPACE

class vpPoseMixture;
class vpPoseHypothesis;
struct vpLampFrame;

//! What one frame gave.
struct VISP_EXPORT vpVlpLocation {
  double timestamp = 0;   // s, of the frame
  vpVlpFix fix;           // fix.valid false and fix.refusal where there is no position
  bool tracked = false;   // the filter's, not of this frame alone
  bool relocated = false; // the robot seems to have been put there; no third lamp has confirmed it yet
  vpVlpFilter::State state = vpVlpFilter::State::starting; // of fix, by its covariance
  std::vector<vpLampObservation> observations; // every lamp-like region, accepted where it counts for the fix
  std::vector<vpRect> searched; // px, the windows in which they were looked for; empty: the whole picture
};

/*!
  The whole system: a frame goes in, a pose comes out. process() is the paper's section 2, top to bottom.

  The first pose is that of two lamps or more in one frame. From there on the filter carries it: each lamp
  corrects it at the time of its own line, one lamp alone as well, and where there is none it goes on by the
  odometry, or as fast as before. `tracking` off: each frame by itself.

  A map may use one identifier for several lamps, and a reflection shows the identifier of its lamp. Where a
  picture holds such lamps, `matcher` tells by their places which lamp each is, the last pose being a hint.

  Frames come in the order of their time. One that is not later than the frame before gives nothing, unless it
  is earlier by more than a second: then the clock was set back, and all begins anew. After a gap, the
  covariance tells whether the pose is lost.
*/
class VISP_EXPORT vpVlpLocalizer
{
public:
  enum class Solver {
    all, //!< least squares over all lamps seen
    two  //!< the paper's double-lamp solver on the pair of best geometry
  };

  bool tracking = true;
  bool compensateShutter = true; // off: all lamps as if seen at the frame's time stamp
  Solver solver = Solver::all;   // of single frames, and of the first pose
  vpLampTracker tracker;         // its detector: of single frames, too
  vpManyLampSolver manyLamps;    // its attitude: mount or free
  vpTwoLampSolver twoLamps;
  vpLampMatcher matcher; // under the mount's attitude, with a map tolerance of its own; free: does not run
  vpVlpFilter filter;    // its odometry: addOdometry() before process()
  vpVlpHypotheses hypotheses; // of what happens between two frames
  double mapTolerance = 0.03; // m, how far lamps may be off their map position before they disagree, sigma
  double outlierLikelihood = 1e-4; // lamps disagree where their residuals are less likely than this

  //! Lamps that blink alike are looked for first within filter.startPlace and startTurn of the last pose, and
  //! farther by these for the time since then.
  double maxSpeed = 1;    // m/s
  double maxTurnRate = 3; // rad/s

  vpVlpLocalizer(const vpVlpRig &rig, const vpLampMap &map);
  ~vpVlpLocalizer();
  vpVlpLocalizer(vpVlpLocalizer &&) noexcept;

  /*!
    \throw vpException (dimensionError) where the picture has not the size that the rig states. Whatever else
    is in a picture leads to a position or to a refusal.
  */
  vpVlpLocation process(const vpVlpFrame &frame);
  //! The same into what an earlier frame gave: where lamps are followed it takes no memory.
  void process(const vpVlpFrame &frame, vpVlpLocation &location);

  /*!
    A pose from lamps that are seen already, by another detector or in a simulation; nothing else differs from
    process(). \param timestamp s, of the frame's first line. \param observations Each with its `id` or
    `candidates`, `point`, `covariance`, `outline`, `cut`, and its `time` since the time stamp.
  */
  vpVlpLocation locate(double timestamp, std::vector<vpLampObservation> observations);

private:
  struct Scratch;
  struct LastPose {
    vpVlpFix fix;
    double time = 0; // s
  };

  bool open(double time, vpVlpLocation &location);
  const std::vector<vpLampObservation> &look(const vpVlpFrame &frame);
  void locate(vpVlpLocation &location);
  vpLampMatch matchByPlace(const std::vector<vpLampObservation> &observations,
                           const std::vector<size_t> &usable, double time) const;
  vpVlpFix solve(std::vector<vpLampObservation> &observations, const std::vector<size_t> &usable) const;
  vpPoseHypothesis placeAt(const vpVlpFix &fix, const vpLampFrame &frame, bool put, int wider) const;
  void begin(vpVlpLocation &location, const std::vector<size_t> &usable);
  void follow(vpVlpLocation &location, const std::vector<size_t> &usable);

  vpVlpRig m_rig;
  vpLampMap m_map;
  std::optional<LastPose> m_lastPose;
  std::optional<double> m_lastFrame; // s
  std::unique_ptr<vpPoseMixture> m_places;
  std::unique_ptr<Scratch> m_scratch; // memory that frames after the first take over
};

END_VISP_NAMESPACE

#endif
