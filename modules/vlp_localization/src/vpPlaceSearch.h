/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPlaceSearch_h
#define vpPlaceSearch_h

#include "vpPlaceModel.h"

BEGIN_VISP_NAMESPACE

//! Places that a picture may have been taken from. Private to the module; vpLampMatcher says how.
class vpPlaceSearch
{
public:
  using Complex = vpPlaceModel::Complex;
  using Place = vpPlaceModel::Place;
  using Bounds = vpPlaceModel::Bounds;
  using Fit = vpPlaceModel::Fit;

  vpPlaceSearch(const vpLampMatcher &settings, const vpLampIndex &index, const std::vector<vpSeenLamp> &seen,
                double pictureArea, const Bounds &bounds);

  //! Sets places(), the likeliest first. False where there were more hypotheses than allowed.
  bool run();

  const vpPlaceModel &model() const { return m_model; }
  const std::vector<Place> &places() const { return m_places; }
  size_t hypotheses() const { return m_hypotheses; }
  //! Of one of the places against all others and a chance agreement together.
  double odds(const Place &place) const;
  //! Whether the likeliest place is the answer.
  bool decided() const;
  //! \e place without those lamps that another region fits nearly as well, and without those whose region
  //! another lamp of the same identifier fits nearly as well.
  Place withoutUndecided(const Place &place) const;

private:
  std::vector<size_t> ordered() const;
  bool complete(size_t tried) const;
  void tryPair(size_t i, size_t j);
  void lampsInReach(const vpSeenLamp &lamp, const vpSeenLamp::Option &option,
                    std::vector<size_t> &found) const;
  void hypothesise(size_t i, size_t first, size_t j, size_t second);
  void settle(Place &place);
  bool gather(Place &place, size_t needed) const;
  bool mistakable(const Place &place, const Fit &fit, size_t i) const;
  void keep(const Place &place);

  const vpPlaceModel m_model;
  const vpLampMatcher &m_settings;
  const vpLampIndex &m_index;
  const std::vector<vpSeenLamp> &m_seen;
  const Bounds m_bounds;
  std::vector<Place> m_places;
  bool m_allowed = true; // no more hypotheses than that
  size_t m_hypotheses = 0;
  size_t m_most = 0;                                       // lamps that a place explained so far
  mutable std::vector<size_t> m_firsts, m_seconds, m_near; // what the index found
};

END_VISP_NAMESPACE

#endif
