/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampMatcher_h
#define vpLampMatcher_h

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <visp3/core/vpHomogeneousMatrix.h>
#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_core/vpLampObservation.h>
#include <visp3/vlp_core/vpVlpRig.h>

BEGIN_VISP_NAMESPACE

class vpLampIndex;
struct vpSeenLamp;

//! Where the robot was seen last, and how far from there it can be by now.
struct VISP_EXPORT vpPoseHint {
  vpHomogeneousMatrix wMb;
  double reach = 0; // m, in x and y
  double turn = 0;  // rad, of the heading, either way
};

//! Which lamp of the map each lamp-like region is, or why that stays open.
struct VISP_EXPORT vpLampMatch {
  enum class Outcome {
    unique,    //!< one place explains the picture
    ambiguous, //!< several places explain it about equally well
    none       //!< no place does
  };
  static constexpr size_t noLamp = static_cast<size_t>(-1);

  Outcome outcome = Outcome::none;
  std::string refusal; // one line, where not unique
  /*!
    Where unique, for each observation the lamp's index in the map; noLamp of a region that is none of the
    lamps (a reflection, a lamp that the map does not know), of one that may be either of two, and of one that
    took no part.
  */
  std::vector<size_t> lamps;
  std::vector<double> probabilities; // of each lamp's identifier, by its stripes; 0 with noLamp
  vpHomogeneousMatrix wMb; // where unique: a level pose, good enough to tell lamps apart and for no more
  double odds = 0;         // of this place against all others together, without the last pose's prior
  bool byHint = false;     // found near the last pose, without a look at the rest of the map
  size_t hypotheses = 0;   // places that were looked at
};

/*!
  Recognition by place: tells lamps that share an identifier from each other, and a lamp from its reflection,
  which carries the lamp's own stripes.

  Under the mount's attitude two lamps give the pose in closed form (vpTwoLampSolver). Every pair of lamps of
  the map that two regions may show, whose distance fits that of the regions in the picture and the height of
  the camera, is a hypothesis; an index by identifier and place finds these pairs, and then for each other
  region the lamp that its ray leads to. A least-squares fit over the lamps found so gives how likely the
  picture is from there:

    log E = sum over its lamps of [log(p N / n) + log(A / strangers) + log density of the residual]
            + log of the pose's prior density and of the volume of poses that fit (Laplace's approximation),

  with p the probability of the identifier, n of the map's N lamps its carriers, A the area of the picture
  (MacKay 2003, chapter 28: the factor by which the picture is likelier from there than if all its regions
  were strangers). A place is the answer where its E is `minOdds` times that of all other places and of
  a chance agreement together. Pairs are tried until a place that was missed would leave out too many regions
  to count. Lamps that the pose predicts and the picture does not show do not count against a place: lamps are
  hidden and switched off, many at a time, so that missing lamps are not independent.

  A last pose restricts the search to its surroundings. What is found there is the answer if it explains
  every region. Otherwise the whole map is searched, and the last pose only decides between places that
  explain equally many regions: a robot that was carried elsewhere is found there, or nowhere.
*/
class VISP_EXPORT vpLampMatcher
{
public:
  double mapTolerance = 0.03;   // m, how far lamps may hang from the map's positions, standard deviation
  double tiltTolerance = 0.01;  // rad, how far the robot may lean where the rig states less, likewise
  double baseHeight = 0;        // m, z of the robot's base: it stands on the floor
  double baseHeightSigma = 0.1; // m, standard deviation
  double strangers = 0.1;       // regions a picture that show no lamp of the map directly, on average
  double minOdds = 100;         // a place has to be this many times likelier than all others together
  double minShare = 0.6;        // share of the regions that a place has to explain, and two at least
  size_t maxHypotheses = 20000; // places to look at before the picture counts as ambiguous

  vpLampMatcher(const vpVlpRig &rig, const vpLampMap &map);

  /*!
    Tells which lamps \e observations show, of which those at the indices \e usable take part. An observation
    may be any lamp of its `candidates`; one without is the lamp of its `id`.
    \throw vpException (badValue) naming a setting out of its range, or the index.
  */
  vpLampMatch match(const std::vector<vpLampObservation> &observations, const std::vector<size_t> &usable,
                    const std::optional<vpPoseHint> &hint = std::nullopt) const;

private:
  void check() const;
  std::vector<vpSeenLamp> seenLamps(const std::vector<vpLampObservation> &observations,
                                    const std::vector<size_t> &usable, std::vector<size_t> &which) const;

  vpVlpRig m_rig;
  std::shared_ptr<const vpLampIndex> m_index; // never changes: copies of the matcher share it
};

END_VISP_NAMESPACE

#endif
