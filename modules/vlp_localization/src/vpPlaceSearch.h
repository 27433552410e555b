/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPlaceSearch_h
#define vpPlaceSearch_h

#include <complex>
#include <optional>
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
    double weight = 0; // log of p N / n
  };

  std::complex<double> ray; // upright: turned level and scaled to unit height
  double variance = 0;      // of ray in each direction: the image point's, and what a lean leaves of it
  std::vector<Option> options;
  double lamps = 0; // of the map that it may be
};

//! Places that a picture may have been taken from. Private to the module; vpLampMatcher says how.
class vpPlaceSearch
{
public:
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

  vpPlaceSearch(const vpLampMatcher &settings, const vpLampIndex &index, const std::vector<vpSeenLamp> &seen,
                double pictureArea, const Bounds &bounds);

  //! Sets places(), the likeliest first. False where there were more hypotheses than allowed.
  bool run();

  const std::vector<Place> &places() const { return m_places; }
  size_t hypotheses() const { return m_hypotheses; }
  //! Log of the evidence that one region shows a lamp of the map, seen from anywhere, and all others
  //! strangers: what a place that rests on chance has to be held against.
  double chance() const;
  //! Regions that a place has to explain.
  size_t fewest() const;
  //! Whether so many regions stay unexplained that lamps on one line are too weak an argument.
  bool tooFewOnALine(const Place &place) const;
  //! Takes those lamps out of \e place that another region, or another lamp of the same identifier, fits
  //! nearly as well.
  void dropUndecided(Place &place) const;

private:
  //! Normal equations of a place, in the camera's place and heading times height.
  struct Fit {
    double weight = 0;     // sum of the inverse variances, 1/m^2
    Complex middle;        // weighted mean ray
    double spread = 0;     // weighted sum of squared distances from it
    double lampHeight = 0; // m, weighted mean
  };

  std::vector<size_t> ordered() const;
  bool complete(size_t tried) const;
  void tryPair(size_t i, size_t j);
  void lampsInReach(const vpSeenLamp &lamp, const vpSeenLamp::Option &option,
                    std::vector<size_t> &found) const;
  void hypothesise(size_t i, size_t first, size_t j, size_t second);
  void settle(Place &place);
  bool withinBounds(const Place &place, double slack) const;
  Complex expected(const Place &place, size_t i, double lampHeight) const;
  double variance(size_t i, size_t lamp, double depth) const;
  double distance(const Place &place, size_t i, size_t lamp, double poseVariance) const;
  double poseVariance(const Fit &fit, size_t i) const;
  Fit fitOf(const Place &place) const;
  void lampsNear(const Place &place, size_t i, const vpSeenLamp::Option &option, double poseVariance) const;
  bool gather(Place &place, size_t needed) const;
  bool mistakable(const Place &place, const Fit &fit, size_t i) const;
  bool refine(Place &place) const;
  void judge(Place &place) const;
  double gain(size_t i, double variance, double depth) const;
  void keep(const Place &place);

  const vpLampMatcher &m_settings;
  const vpLampIndex &m_index;
  const std::vector<vpSeenLamp> &m_seen;
  const double m_area; // of the picture, upright units
  const Bounds m_bounds;
  std::vector<Place> m_places;
  size_t m_hypotheses = 0;
  size_t m_most = 0;                                       // lamps that a place explained so far
  mutable std::vector<size_t> m_firsts, m_seconds, m_near; // what the index found
};

END_VISP_NAMESPACE

#endif
