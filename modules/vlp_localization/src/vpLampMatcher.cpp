/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_localization/vpLampMatcher.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

#include "vpLampGeometry.h"
#include "vpPlaceSearch.h"

BEGIN_VISP_NAMESPACE

namespace
{
using Complex = vpPlaceSearch::Complex;
using Place = vpPlaceSearch::Place;

void expect(bool right, const std::string &name, double came, const std::string &expected)
{
  if (!right) {
    throw vpException(vpException::badValue, "vpLampMatcher: %s is %s, expected %s", name.c_str(),
                      vpNumberText(came).c_str(), expected.c_str());
  }
}

//! The ray of an observation, turned upright. False where it does not point above the horizon.
bool turnUpright(const vpLampObservation &observation, const vpVlpRig &rig, double tiltSigma,
                 vpSeenLamp &seen)
{
  const vpLampSight sight = vpLampSight::from(vpLamp(), observation, rig.camera);
  const vpUprightRay upright(sight.ray, vpMountFrame(rig));
  seen.ray = upright.value;
  // A lean moves all rays alike, which the pose takes up, but for a part that grows with their square.
  const Eigen::Matrix2d covariance = upright.byRay * sight.covariance * upright.byRay.transpose();
  const double lean = tiltSigma * std::norm(upright.value);
  seen.variance = covariance.selfadjointView<Eigen::Lower>().operatorNorm() + lean * lean;
  return upright.aboveHorizon && std::isfinite(seen.variance);
}

//! What an observation may be, by its candidates or its id.
void addOptions(const vpLampObservation &observation, const vpLampIndex &index, vpSeenLamp &seen)
{
  const double all = static_cast<double>(index.size());
  for (const vpLedIdCandidate &candidate : observation.candidates) {
    const double p = candidate.probability;
    const double n = static_cast<double>(index.carriers(candidate.identifier));
    if (n > 0 && p > 0) {
      seen.options.push_back({candidate.identifier, vpLampIndex::nowhere, p, std::log(p * all / n)});
      seen.lamps += n;
    }
  }
  const size_t known = index.find(observation.id);
  if (observation.candidates.empty() && known != vpLampIndex::nowhere) {
    const double p = observation.confidence > 0 ? std::min(1.0, observation.confidence) : 1;
    seen.options.push_back({index.lamp(known).identifier, known, p, std::log(p * all)});
    seen.lamps = 1;
  }
}

std::string shown(const Place &place)
{
  std::ostringstream text;
  text.setf(std::ios::fixed);
  text.precision(2);
  text << "(" << place.camera.real() << ", " << place.camera.imag() << ")";
  return text.str();
}

std::string whyNot(const std::vector<Place> &places, size_t seen, bool complete)
{
  const std::string lamps = std::to_string(seen) + " lamps";
  if (!complete) {
    return lamps + " fit too many places of the map to look at them all";
  }
  if (places.empty()) {
    return "no place of the map explains the " + lamps + " seen";
  }
  if (places.size() == 1) {
    return lamps + " fit one place of the map, but not well enough to be sure of it";
  }
  return lamps + " fit " + std::to_string(places.size()) + " places of the map about equally well, as " +
         shown(places[0]) + " and " + shown(places[1]);
}

//! Where the camera can be, by the last pose of the base.
vpPlaceSearch::Bounds around(vpPlaceSearch::Bounds bounds, const vpPoseHint &hint, const vpMountFrame &mount)
{
  bounds.anywhere = false;
  bounds.turn = std::min(M_PI, hint.turn);
  bounds.heading = std::atan2(hint.wMb[1][0], hint.wMb[0][0]);
  const Complex arm(mount.btc.x(), mount.btc.y());
  bounds.around = Complex(hint.wMb[0][3], hint.wMb[1][3]) + std::polar(1.0, bounds.heading) * arm;
  bounds.reach = hint.reach + std::abs(arm) * std::min(2.0, bounds.turn);
  return bounds;
}

bool isPose(const vpPoseHint &hint)
{
  const double sum = hint.wMb[0][3] + hint.wMb[1][3] + hint.wMb[0][0] + hint.wMb[1][0];
  return std::isfinite(sum) && hint.reach > 0 && hint.turn > 0;
}

//! Of places that explain equally many regions about equally well the one near the last pose, or nullptr.
const Place *decidedByHint(const vpPlaceSearch &search, const vpPlaceSearch::Bounds &bounds, double minOdds)
{
  std::vector<const Place *> near;
  size_t most = 0;
  for (const Place &place : search.places()) {
    if (place.logEvidence >= search.places()[0].logEvidence - std::log(minOdds)) {
      most = std::max(most, place.count);
      if (bounds.near(place)) {
        near.push_back(&place);
      }
    }
  }
  return near.size() == 1 && near[0]->count == most && !search.tooFewOnALine(*near[0]) ? near[0] : nullptr;
}
} // namespace

vpLampMatcher::vpLampMatcher(const vpVlpRig &rig, const vpLampMap &map)
    : m_rig(rig), m_index(std::make_shared<vpLampIndex>(map))
{
}

void vpLampMatcher::check() const
{
  expect(mapTolerance > 0, "mapTolerance", mapTolerance, "more than 0 m");
  expect(tiltTolerance >= 0, "tiltTolerance", tiltTolerance, "0 rad or more");
  expect(std::isfinite(baseHeight), "baseHeight", baseHeight, "a number of metres");
  expect(baseHeightSigma > 0, "baseHeightSigma", baseHeightSigma, "more than 0 m");
  expect(strangers > 0, "strangers", strangers, "more than 0 regions");
  expect(minOdds >= 1, "minOdds", minOdds, "1 or more");
  expect(minShare >= 0 && minShare <= 1, "minShare", minShare, "a share between 0 and 1");
  expect(m_rig.width > 0 && m_rig.height > 0, "the width of the rig's picture", m_rig.width,
         "pixels, and as many lines");
}

/*!
  The regions that may be a lamp of the map, and of each the index of its observation.
*/
std::vector<vpSeenLamp> vpLampMatcher::seenLamps(const std::vector<vpLampObservation> &observations,
                                                 const std::vector<size_t> &usable,
                                                 std::vector<size_t> &which) const
{
  const double tilt = std::max(tiltTolerance, m_rig.rotationSigma.head<2>().maxCoeff());
  std::vector<vpSeenLamp> seen;
  for (size_t i : usable) {
    expect(i < observations.size(), "usable", static_cast<double>(i), "an index of the observations");
    vpSeenLamp lamp;
    addOptions(observations[i], *m_index, lamp);
    if (!lamp.options.empty() && turnUpright(observations[i], m_rig, tilt, lamp)) {
      seen.push_back(lamp);
      which.push_back(i);
    }
  }
  return seen;
}

vpLampMatch vpLampMatcher::match(const std::vector<vpLampObservation> &observations,
                                 const std::vector<size_t> &usable,
                                 const std::optional<vpPoseHint> &hint) const
{
  check();
  vpLampMatch match;
  match.lamps.assign(observations.size(), vpLampMatch::noLamp);
  match.probabilities.assign(observations.size(), 0);
  std::vector<size_t> which;
  const std::vector<vpSeenLamp> seen = seenLamps(observations, usable, which);
  if (seen.size() < 2) {
    match.refusal = tooFewLamps(seen.size());
    return match;
  }

  const vpMountFrame mount(m_rig);
  const double area = m_rig.width * m_rig.height / (m_rig.camera.get_px() * m_rig.camera.get_py());
  vpPlaceSearch::Bounds anywhere;
  anywhere.height = baseHeight + mount.btc.z();
  anywhere.heightSigma = baseHeightSigma;
  const auto accept = [&](const vpPlaceSearch &search, const Place &best) {
    match.outcome = vpLampMatch::Outcome::unique;
    match.odds = search.odds(best);
    const Eigen::AngleAxisd turn(std::arg(best.heading), Eigen::Vector3d::UnitZ());
    const Eigen::Vector3d camera(best.camera.real(), best.camera.imag(), best.height);
    match.wMb = vpBasePose{turn.matrix(), camera - turn * mount.btc}.wMb();
    const Place place = search.withoutUndecided(best);
    for (size_t k = 0; k < seen.size(); ++k) {
      if (place.lamps[k] != vpLampMatch::noLamp) {
        match.lamps[which[k]] = place.lamps[k];
        match.probabilities[which[k]] = seen[k].option(m_index->lamp(place.lamps[k]))->probability;
      }
    }
    return match;
  };

  // Near the last pose: the answer where it leaves nothing unexplained.
  const bool hinted = hint && isPose(*hint);
  const vpPlaceSearch::Bounds nearby = hinted ? around(anywhere, *hint, mount) : anywhere;
  if (hinted) {
    const vpPlaceSearch local(*this, *m_index, seen, area, nearby);
    match.hypotheses += local.hypotheses();
    match.byHint = local.decided() && local.places()[0].count == seen.size();
    if (match.byHint) {
      return accept(local, local.places()[0]);
    }
  }

  // The whole map; of places that explain the picture alike the last pose decides.
  const vpPlaceSearch search(*this, *m_index, seen, area, anywhere);
  const bool complete = search.complete();
  match.hypotheses += search.hypotheses();
  if (search.decided()) {
    return accept(search, search.places()[0]);
  }
  const Place *place = complete && hinted ? decidedByHint(search, nearby, minOdds) : nullptr;
  if (place != nullptr) {
    return accept(search, *place);
  }
  const bool none = complete && search.places().empty();
  match.outcome = none ? vpLampMatch::Outcome::none : vpLampMatch::Outcome::ambiguous;
  match.odds = complete && !none ? search.odds(search.places()[0]) : 0;
  match.refusal = whyNot(search.places(), seen.size(), complete);
  return match;
}

END_VISP_NAMESPACE
