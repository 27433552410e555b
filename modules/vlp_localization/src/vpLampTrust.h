/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampTrust_h
#define vpLampTrust_h

#include <string>
#include <unordered_map>

#include <Eigen/Geometry>
#include <visp3/vlp_core/vpVlpRig.h>
#include <visp3/vlp_localization/vpVlpFilter.h>

#include "vpLampFrame.h"

BEGIN_VISP_NAMESPACE

//! Of a lamp in the picture.
struct vpLampExtent {
  Eigen::Vector2d size =
      Eigen::Vector2d::Zero(); // px, width and height; 0 where it is not in front of the camera
  double stretch = 0;          // standard deviation, as a share: by the robot's velocity during the readout
};

/*!
  Whether a lamp looks as it did in the frames before, from where the filter expects the robot: in its place,
  and as large. One that somebody begins to hide drags its outline along, a little more in each frame, and no
  Mahalanobis distance of one frame shows it; but it looks smaller.
*/
class vpLampTrust
{
public:
  double mapTolerance =
      0.03; // m, how far a lamp that was not seen before may hang from where the map says, sigma
  double doubtedTolerance = 0.005; // m, one that other lamps have shown to hang elsewhere, sigma
  double placeTolerance = 0.0005;  // m, how far one may then seem to move, sigma
  double sizeTolerance = 0.015; // share of its extent by which a lamp may seem smaller or larger than it was
  double gate = 4;              // standard deviations, of its extent

  //! Whether it is as large and of the shape as before; else why not, in a few words.
  std::string changed(const vpLamp &lamp, const vpLampObservation &seen, const vpLampExtent &expected);

  //! Whether the lamps of a frame that are accepted look from \e wMb as large as before.
  bool looksAsBefore(const vpLampFrame &frame, const vpHomogeneousMatrix &wMb) const;

  //! Whether it was seen in its place for some frames.
  bool knows(const vpLamp &lamp) const;

  //! m, how far it may seem to be from where the filter expects it, standard deviation.
  double tolerance(const vpLamp &lamp) const;

  //! What it is off by on average, where that is more than chance, normalised units: to be added to its
  //! doubt.
  Eigen::Vector2d offset(const vpLamp &lamp) const;

  void believe(const vpLamp &lamp, const vpLampObservation &seen, const vpVlpFilter::Innovation &innovation,
               const vpLampExtent &expected);

  //! Other lamps have, or have not, shown that it hangs elsewhere than the map says.
  void doubtPlace(const vpLamp &lamp, bool doubted) { m_past[lamp.id].doubted = doubted; }

  //! Whether they have, and it was not seen in its place since.
  bool doubts(const vpLamp &lamp) const;

  //! Where lamps were seen; how large they are stays known, and which are doubted.
  void forgetPlaces();
  /*!
    Width and height, px, of the picture of a lamp's disc or square as seen from \e wMb by a base that moves
    at \e velocity (m/s along x and y of b, rad/s): lines read while the lamp's picture runs ahead of the
    readout see it longer.
  */
  static Eigen::Vector2d extentOf(const vpLamp &lamp, const Eigen::Isometry3d &wMb,
                                  const Eigen::Vector3d &velocity, const vpVlpRig &rig, double lineTime);

  //! Pixel of a place (m, in w) and its velocity, px/s. False where it is not in front of the camera.
  static bool motionOf(const Eigen::Vector3d &place, const Eigen::Isometry3d &wMb,
                       const Eigen::Vector3d &velocity, const vpVlpRig &rig, Eigen::Vector2d &pixel,
                       Eigen::Vector2d &motion);

private:
  struct Past {
    int frames = 0;
    bool doubted = false;        // by doubtPlace()
    int sizes = 0;               // frames that told its size
    int smaller = 0, larger = 0; // frames in a row that it was so
    vpLampOutline::Shape shape = vpLampOutline::Shape::region;
    Eigen::Vector2d offset = Eigen::Vector2d::Zero(); // normalised units, running mean of the innovations
    Eigen::Matrix2d doubt = Eigen::Matrix2d::Zero();  // of that mean, were it 0
    Eigen::Vector2d size = Eigen::Vector2d::Zero();   // extent over the expected one
  };
  std::unordered_map<std::string, Past> m_past; // by id
};

END_VISP_NAMESPACE

#endif
