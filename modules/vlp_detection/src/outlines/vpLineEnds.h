/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLineEnds_h
#define vpLineEnds_h

#include <array>
#include <vector>

#include <Eigen/Core>

#include <visp3/vlp_core/vpLanes.h>

BEGIN_VISP_NAMESPACE

//! Of the outline's parameters and the blur.
template <int N>
struct vpNormalEquations {
  Eigen::Matrix<double, N, N> H = Eigen::Matrix<double, N, N>::Zero();
  Eigen::Matrix<double, N, 1> g = Eigen::Matrix<double, N, 1>::Zero();
};

/*!
  One end of each of eight lines, its own background and amplitude eliminated: how far it alone would move the
  edge, and the normal equations of an outward shift of the edge there and of the blur.
*/
template <int N>
struct alignas(vpLanes::alignment) vpLineEnds {
  std::array<vpLanes::Floats, N - 1> outward{}; // shift of the edge by the outline's parameters
  vpLanes::Floats shiftShift{}, shiftBlur{}, blurBlur{}, shift{}, blur{};
  vpLanes::Floats squares{}; // sum of squared residuals, grey levels
  vpLanes::Floats pixels{};
  vpLanes::Floats amplitude{};  // grey levels, of the lamp's middle
  vpLanes::Floats background{}; // grey value
  vpLanes::Floats crossing{};   // px along the line from the lamp's middle to its edge there
  vpLanes::Integers valid{};    // -1; 0: the line has no such end
  //! Of an edge that runs along the line: index of all its normal equations; else -1, as where it crosses it.
  vpLanes::Integers along = vpLanes::Integers{} - 1;

  vpLanes::Floats offset{};   // px outwards, that it alone would move the edge by,
  vpLanes::Floats variance{}; // of its pixels about what that leaves, grey levels^2,
  vpLanes::Integers shines{}; // -1 where it shows an edge,
  vpLanes::Floats weight{};   // of its equations
};

//! The first and the last ends of eight lines.
template <int N>
struct vpEightLines {
  std::array<int, vpLanes::count> line{};
  std::array<vpLineEnds<N>, 2> sides;
};

//! Sums over the ends of lines that vpEdgeFit works with.
namespace vpEndSums
{
//! What all ends say together.
template <int N>
struct Sums {
  vpNormalEquations<N> equations; // of those that cross their line
  double shift = 0;               // of weighted shift times offset
  double shiftShift = 0;          // weighted
  double squares = 0, pixels = 0; // of all that shine
  double members = 0;             // robust weights
  double shining = 0, kept = 0;   // ends
};

//! Sets offset and variance.
void judge(std::vector<vpEightLines<6>> &lines);
void judge(std::vector<vpEightLines<9>> &lines);

/*!
  Sets the weights: those of Tukey over an end's variance, which is that of its own residuals or \e noise,
  whichever is more; an end that would move the edge far beyond what the others want is let go of. An end is
  no outlier for being noisy: its own variance widens the limit.
  \param scale px, of offsets.
*/
void weigh(std::vector<vpEightLines<6>> &lines, double noise, double scale, Sums<6> &sums);
void weigh(std::vector<vpEightLines<9>> &lines, double noise, double scale, Sums<9> &sums);

//! How fast the light grows along the lines, by the amplitudes of their two ends, where both show an edge: a
//! share per pixel, 0 where no line tells.
double shading(const std::vector<vpEightLines<6>> &lines);
double shading(const std::vector<vpEightLines<9>> &lines);
} // namespace vpEndSums

END_VISP_NAMESPACE

#endif
