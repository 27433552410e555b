/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampHistory_h
#define vpLampHistory_h

#include <optional>
#include <string>
#include <unordered_map>

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
  Where and how large each lamp was in the frames before, as seen from where the filter expected the robot.
  One that somebody begins to hide drags its outline along, a little more in each frame, and no Mahalanobis
  distance of one frame shows it; but it looks smaller.
*/
class vpLampHistory
{
public:
  double mapTolerance = 0.03; // m, how far a lamp not seen before may hang from its place in the map, sigma
  double strangerTolerance = 0.005; // m, one that other lamps have shown to hang elsewhere, sigma
  double placeTolerance = 0.0005;   // m, how far a lamp may then seem to move, sigma
  double sizeTolerance = 0.015; // share of its extent by which a lamp may seem smaller or larger than it was
  double gate = 4;              // standard deviations, of its extent

  //! Empty where a lamp is as large and of the shape as before; else why not, in a few words.
  std::string changed(const vpLamp &lamp, const vpLampObservation &seen, const vpLampExtent &expected);
  //! The robot is at \e wMb: what the accepted lamps look larger by, all alike, is an error of the places
  //! from which they were seen before.
  void seeFrom(const vpLampFrame &frame, const vpHomogeneousMatrix &wMb);
  //! Whether the accepted lamps of a frame look from \e wMb as large as before, but for such an error.
  bool looksAsBefore(const vpLampFrame &frame, const vpHomogeneousMatrix &wMb) const;
  //! m, how far a lamp may seem to be from where the filter expects it, standard deviation.
  double tolerance(const vpLamp &lamp) const;
  //! What it is off by on average, normalised units; 0 where that may be chance.
  Eigen::Vector2d offset(const vpLamp &lamp) const;
  //! Takes what a frame shows of a lamp that is the map's.
  void add(const vpLamp &lamp, const vpLampObservation &seen, const vpVlpFilter::Innovation &innovation,
           const vpLampExtent &expected);

  //! Other lamps have, or have not, shown that it hangs elsewhere than the map says.
  void setStranger(const vpLamp &lamp, bool stranger);
  //! Whether they have, and it was not seen in its place since.
  bool isStranger(const vpLamp &lamp) const;
  //! Log density of a ray to a stranger, which hangs still, as high as its lamp. Minus infinity where it was
  //! not seen before.
  double logStill(const vpLamp &lamp, const vpVlpFilter::Innovation &innovation) const;
  //! Takes what a frame shows of a stranger. \return Nats by which the frame makes it less likely than the
  //! frames before did that it hangs still.
  double addStranger(const vpLamp &lamp, const vpVlpFilter::Innovation &innovation);
  //! Where lamps were seen; how large they are stays known, and which are strangers.
  void forgetPlaces();

private:
  struct Past {
    bool stranger = false;
    std::optional<Eigen::Vector2d> away; // m, x and y in w, of the stranger from the lamp,
    Eigen::Matrix2d awayCovariance;      // and its covariance, as rays
    double strayed = 0; // half the square of the most that a frame had it elsewhere, in sigmas
    int places = 0;     // frames that told its place
    Eigen::Vector2d offset = Eigen::Vector2d::Zero();     // normalised units, running mean of the innovations
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero(); // of that mean, were it 0
    int sizes = 0;                                        // frames that told its size
    Eigen::Vector2d size = Eigen::Vector2d::Zero();       // running mean of its extent over the expected one
    vpLampOutline::Shape shape = vpLampOutline::Shape::region;
    int changed = 0; // frames in a row with another extent
  };
  const Past *find(const vpLamp &lamp) const;

  std::unordered_map<std::string, Past> m_past; // by id
};

END_VISP_NAMESPACE

#endif
