/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampTracker_h
#define vpLampTracker_h

#include <memory>
#include <vector>

#include <visp3/vlp_core/vpVlpFrame.h>
#include <visp3/vlp_identification/vpLedDetector.h>
#include <visp3/vlp_identification/vpLedIdEvidence.h>
#include <visp3/vlp_tracking/vpTargetTracker.h>

BEGIN_VISP_NAMESPACE

/*!
  Follows all lamps at once. Each has a target tracker (improved Camshift-Kalman, or another), which gives
  the window in which outline, stripes and LED-ID are searched for. The stripes of all its frames together
  identify the lamp.

  A lamp that `sure` frames agree on is reacquired (vpLedDetector::reacquire()), a quick check that succeeds
  only where the lamp is as before in every respect. It is tried first at the place that the robot's motion
  predicts; if it succeeds there, the target tracker is not run. Else it is tried at the target tracker's
  place. Where it fails, the full detection runs, and so it does in windows that show any other light.

  New lamps come from a search that covers a strip of each frame, so that its cost is bounded. It covers the
  whole frame only where fewer lamps than `needed` were or are in sight. A lamp that is not seen for
  `patience` is dropped, and so is one that left the picture. Stripes that contradict a lamp's earlier ones
  are taken for another lamp's: it starts again, with a new number and without an id, until its own stripes
  give it one. So ids are never passed from lamp to lamp where two cross or one is replaced.

  A picture that shows all lamps as the frame before did, pixel for pixel, is a repeated one: a sensor has
  noise. Its stripes are no new measurement and do not count again.

  Steady regions (windows, lamps without stripes) are found by the search and not followed. For a while their
  places are left out of the search, moved along with the lamps: for as long as they have been there, ten
  times `steadiness` at most. Then one of them a frame is looked at again. Where a lamp is expected, all are.
  What looks striped is passed over likewise, as the shade of a luminaire may. It has fitted no lamp of the
  map in more than `sure` frames, shows no word, and cannot be reacquired.

  \code
  vpLampTracker tracker(rig, map);
  for (const vpLampObservation &lamp : tracker.track(frame)) {
    ...
  }
  \endcode
*/
class VISP_EXPORT vpLampTracker
{
public:
  vpLedDetector detector;
  vpTargetTracker::Method method = vpTargetTracker::Method::camshiftKalman;
  double patience = 1;      // s
  double margin = 0.7;      // of a lamp's extent, by which the search goes beyond its window on each side
  double searchShare = 0.2; // of the picture that is searched for new lamps in each frame
  size_t needed = 2;        // lamps in sight with an id, below which all of it is
  unsigned int sure = 5;    // frames that agree on a lamp, after which it may be reacquired
  double steadiness = 2;    // s, for which a region that is no lamp is not searched again at first

  vpLampTracker(const vpVlpRig &rig, const vpLampMap &map);
  ~vpLampTracker();
  vpLampTracker(vpLampTracker &&) noexcept;

  /*!
    Every lamp-like region that was examined, the one with the largest lit area first. Their features are
    those of all frames of the lamp together, `track` its number. \param expected Predicted windows, px, from
    the robot's motion, in which lamps are searched for as well. \throw vpException (dimensionError) where the
    picture has not the size that the rig states; (badValue) where its time is not finite, or not later than
    that of the one before, or where a window that counts has no finite corners.
  */
  const std::vector<vpLampObservation> &track(const vpVlpFrame &frame,
                                              const std::vector<vpRect> &expected = {});

  //! Forgets all lamps.
  void reset();

  //! Lamps that are followed, seen in the last frame or not.
  size_t tracks() const;

  //! Windows searched in the last frame, px: around each lamp that is followed, the predicted ones, and the
  //! strip of this frame. Windows may reach out of the picture. Empty: all of it was searched.
  const std::vector<vpRect> &searched() const { return m_searched; }

private:
  struct Track;
  struct Scratch;
  struct Steady {
    vpRect box;                  // px, in the last frame
    double since = 0, until = 0; // s: seen first, and to be looked at again
    bool asked = false;          // whether it was
  };

  void setWindows(const vpVlpFrame &frame, const std::vector<vpRect> &expected);
  void clearObservations();
  void addObservation(const vpLampObservation &seen);
  void sortByArea();
  vpRect strip();
  bool reacquireAt(Track &track, const vpImage<unsigned char> &I, const vpImagePoint &place);
  bool reacquireAsExpected(Track &track, const vpImage<unsigned char> &I,
                           const std::vector<vpRect> &expected);
  void reacquire(const vpImage<unsigned char> &I);
  bool shown(const vpRect &window) const;
  void openWindows(const vpVlpFrame &frame);
  void search(const vpVlpFrame &frame);
  void searchAll(const vpVlpFrame &frame);
  size_t lampsInSight() const;
  void moveSteady(double time);
  void askAgain(const vpRect &strip, double time);
  double noLampSince(const vpRect &box, double time) const;
  void rememberSteady(const vpRect &box, double since, bool cut, double time);
  void rememberSteady(const vpLampObservation &seen, double time);
  void assign();
  void followReacquired(Track &track, vpLampObservation &seen, const vpVlpFrame &frame);
  void setRight(Track &track, vpLampObservation &seen, const vpVlpFrame &frame);
  void follow(Track &track, vpLampObservation &seen, const vpVlpFrame &frame);
  std::unique_ptr<vpTargetTracker> targetAt(const vpImage<unsigned char> &I, const vpRect &box) const;
  int bear(vpLampObservation &seen, const vpVlpFrame &frame);
  void bury(double time);

  vpVlpRig m_rig;
  std::unique_ptr<Scratch> m_scratch; // memory that frames after the first take over
  std::vector<Track> m_tracks;
  std::vector<Steady> m_steady;
  std::vector<vpRect> m_searched;
  std::vector<vpLampObservation> m_observations;
  std::vector<int> m_trackOf; // of each observation, -1: none
  unsigned int m_born = 0;    // lamps in all
  double m_time = 0;          // s, of the last frame
  bool m_any = false;         // frame so far
  bool m_again = false;       // the frame at hand has the picture of the one before
  unsigned int m_strip = 0;   // that is searched next
  size_t m_inSight = 0;       // lamps with an id in the last frame
};

END_VISP_NAMESPACE

#endif
