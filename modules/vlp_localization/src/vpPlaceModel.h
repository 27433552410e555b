/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPlaceModel_h
#define vpPlaceModel_h

#include <complex>
#include <vector>

#include <visp3/vlp_localization/vpLampMatcher.h>

#include "vpLampIndex.h"

BEGIN_VISP_NAMESPACE

//! A lamp-like region as the search sees it.
struct vpSeenLamp {
  //! What it may be: any lamp of an identifier, or one lamp of it.
  struct Option {
    size_t identifier = 0;
    size_t only = vpLampIndex::nowhere;
    double probability = 0; // p, of the identifier
    double weight = 0;      // log of p N / n
  };

  std::complex<double> ray; // upright: turned level and scaled to unit height
  double variance = 0;      // of ray in each direction: the image point's, and what a lean leaves of it
  std::vector<Option> options;
  double lamps = 0; // of the map that it may be
};

/*!
  How well a place explains the regions of a picture: residuals on the ceiling and their doubt, the fit of a
  place to its lamps, and its evidence. Private to the module; vpLampMatcher has the formula.
*/
class vpPlaceModel
{
public:
  static constexpr double gate = 4; // standard deviations, beyond which a lamp is not where it is expected
  static constexpr double leastDepth = 0.05; // m from the camera up to a lamp

  using Complex = std::complex<double>;

  //! The camera, level, and which lamp each region is from there.
  struct Place {
    Complex camera;            // m
    Complex heading = 1;       // of the base, exp(i yaw)
    double height = 0;         // m, of the camera
    std::vector<size_t> lamps; // vpLampMatch::noLamp where none fits
    size_t count = 0;          // lamps found
    double logEvidence = 0;
  };

  //! Where the camera can be.
  struct Bounds {
    double height = 0;      // m, of the camera
    double heightSigma = 0; // m
    bool anywhere = true;   // under the lamps; else around a last pose:
    Complex around;         // m, of the camera
    double reach = 0;       // m
    double heading = 0;     // rad
    double turn = M_PI;     // rad, either way
  };

  //! Normal equations of a place, in the camera's place and heading times height.
  struct Fit {
    double weight = 0;     // sum of the inverse variances, 1/m^2
    Complex middle;        // weighted mean ray
    double spread = 0;     // weighted sum of squared distances from it
    double lampHeight = 0; // m, weighted mean
  };

  vpPlaceModel(const vpLampMatcher &settings, const vpLampIndex &index, const std::vector<vpSeenLamp> &seen,
               double pictureArea, const Bounds &bounds);

  //! Regions that a place has to explain.
  size_t fewest() const;
  //! \param slack m and rad, by which it may miss them.
  bool withinBounds(const Place &place, double slack) const;
  Complex expected(const Place &place, size_t i, double lampHeight) const;
  double variance(size_t i, size_t lamp, double depth) const;
  double distance(const Place &place, size_t i, size_t lamp, double poseVariance) const;
  Fit fitOf(const Place &place) const;
  //! Of the point that the ray of region \e i leads to, in each direction, m^2.
  double poseVariance(const Fit &fit, size_t i) const;
  void lampsNear(const Place &place, size_t i, const vpSeenLamp::Option &option, double poseVariance,
                 std::vector<size_t> &found) const;
  //! Fits the place to its lamps. False where they do not determine it.
  bool refine(Place &place) const;
  double gain(size_t i, double variance, double depth) const;
  //! Sets the log evidence.
  void judge(Place &place) const;
  //! Log of the evidence that one region shows a lamp of the map, seen from anywhere, and all others
  //! strangers: what a place that rests on chance has to be held against.
  double chance() const;
  //! Whether so many regions stay unexplained that lamps on one line are too weak an argument.
  bool tooFewOnALine(const Place &place) const;

private:
  const vpLampMatcher &m_settings;
  const vpLampIndex &m_index;
  const std::vector<vpSeenLamp> &m_seen;
  const double m_area; // of the picture, upright units
  const Bounds m_bounds;
};

END_VISP_NAMESPACE

#endif
