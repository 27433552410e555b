/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpIdentifierLayout_h
#define vpIdentifierLayout_h

#include <vector>

#include <Eigen/Core>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! Which identifier each lamp gets, and what is left that looks alike.
struct VISP_EXPORT vpIdentifierAssignment {
  std::vector<size_t> identifiers; // of each lamp, from 0
  size_t pairsInView = 0;          // pairs of lamps that one view can hold
  size_t repeatedPairs = 0;        // of these, both with one identifier
  size_t triples = 0;              // sets of three lamps that were compared
  size_t repeatedTriples = 0;      // of these, such as look like another one, or hold an identifier twice
};

/*!
  Lays few identifiers over many lamps so that a camera that sees three of them or more knows where it is.

  Two lamps that one view can hold get different identifiers wherever these suffice. Three lamps look like
  three others where identifiers and distances are the same and they lie the same way round: turned and
  shifted copies look alike, mirror images do not. A regular grid is the hardest ceiling, as all its distances
  are the same.

  Greedy: the lamps in the order of x, each given, of the identifiers that no lamp in view has, the one that
  makes the fewest sets of three look alike; then passes over the lamps of such sets, each given a better one
  where there is one. Look-alikes are found by a hash over the identifiers of a set. The same numbers and seed
  give the same layout.
*/
class VISP_EXPORT vpIdentifierLayout
{
public:
  double viewRadius = 2.5; // m, of the circle on the ceiling that the picture shows part of
  double tolerance = 0.15; // m, distances less than this apart look the same
  /*!
    Lamps next to each one whose sets of three are told apart: a view that holds more holds some of these sets
    whole, and each is enough.
  */
  unsigned int neighbours = 20;
  unsigned int choices = 12; // identifiers compared for each lamp
  unsigned int passes = 5;   // over what looks alike, at most
  unsigned int seed = 1;

  /*!
    \param positions Of the lamps, m in the map.
    \param identifiers How many there are.
    \throw vpException (badValue) naming the argument or setting: fewer than two lamps, none or one
    identifier, a position that is not finite, a setting that is not above 0.
  */
  vpIdentifierAssignment lay(const std::vector<Eigen::Vector3d> &positions, size_t identifiers) const;
};

END_VISP_NAMESPACE

#endif
