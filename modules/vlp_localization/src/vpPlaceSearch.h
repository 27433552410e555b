/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPlaceSearch_h
#define vpPlaceSearch_h

#include <complex>
#include <vector>

#include <Eigen/Core>
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

  //! The option that a lamp of the map is of; nullptr: none.
  const Option *option(const vpLampIndex::Lamp &lamp) const;
};

/*!
  Places that a picture may have been taken from: pairs of regions give hypotheses, each is fitted to all
  regions that it explains, and weighed by its evidence. Private to the module; vpLampMatcher has the formula.
*/
class vpPlaceSearch
{
public:
  using Complex = std::complex<double>;

  //! The camera, level, and which lamp each region is from there.
  struct Place {
    Complex camera;             // m
    Complex heading = 1;        // of the base, exp(i yaw)
    double height = 0;          // m, of the camera
    std::vector<size_t> lamps;  // vpLampMatch::noLamp where none fits
    size_t count = 0;           // lamps found
    Eigen::Matrix4d covariance; // of x, y and z of the camera (m) and its yaw (rad), by these lamps
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

    //! Whether a place is near the last pose.
    bool near(const Place &place) const;
  };

  //! Searches. \param pictureArea In units of upright rays.
  vpPlaceSearch(const vpLampMatcher &settings, const vpLampIndex &index, const std::vector<vpSeenLamp> &seen,
                double pictureArea, const Bounds &bounds);

  //! False where there were more hypotheses than allowed.
  bool complete() const { return m_complete; }
  size_t hypotheses() const { return m_hypotheses; }
  //! The likeliest first.
  const std::vector<Place> &places() const { return m_places; }
  //! Of one of the places against all others and a chance agreement together.
  double odds(const Place &place) const;
  //! Whether the likeliest place is the answer.
  bool decided() const;
  //! Whether so many regions stay unexplained that lamps on one line are too weak an argument.
  bool tooFewOnALine(const Place &place) const;
  //! \e place without those lamps that another region fits nearly as well, and without those whose region
  //! another lamp of the same identifier fits nearly as well.
  Place withoutUndecided(const Place &place) const;

private:
  size_t needed() const;
  void tryPair(size_t i, size_t j);
  void hypothesise(size_t i, size_t first, size_t j, size_t second);
  void settle(Place &place);
  bool gather(Place &place) const;
  void keep(const Place &place);
  bool mistakable(const Place &place, size_t i) const;

  void within(const vpSeenLamp::Option &option, const Complex &place, double radius,
              std::vector<size_t> &found) const;
  template <class Visit>
  void visitLamps(const Place &place, size_t i, double poseVariance, const Visit &visit) const;
  Complex expected(const Place &place, size_t i, double lampHeight) const;
  double variance(size_t i, double positionSigma, double depth) const;
  double distance(const Place &place, size_t i, size_t lamp, double poseVariance) const;
  Eigen::Matrix<double, 2, 4> byPose(const Place &place, size_t i, double lampHeight) const;
  void fit(Place &place) const;
  double poseVariance(const Place &place, size_t i) const;
  double logEvidence(const Place &place) const;
  double chance() const;

  const vpLampMatcher &m_settings;
  const vpLampIndex &m_index;
  const std::vector<vpSeenLamp> &m_seen;
  const double m_area; // of the picture, upright units
  const Bounds m_bounds;
  std::vector<Place> m_places;
  bool m_complete = true;
  size_t m_hypotheses = 0;
  size_t m_most = 0;                                       // lamps that a place explained so far
  mutable std::vector<size_t> m_firsts, m_seconds, m_near; // what the index found
};

END_VISP_NAMESPACE

#endif
