/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpEmission_h
#define vpEmission_h

#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>

#include <Eigen/Core>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  Emission pattern of a luminaire: how bright each place of it is, 1 at its brightest.

  Places are in the lamp's own axes, which turn with its yaw. A disc's outline is the unit circle, a square's
  goes from -1 to 1 in x and y. Lengths are shares of the radius or of the half side. A `width` is the
  standard deviation of a Gaussian. `rest` is the brightness far from all that is bright. Numbers beyond the
  ranges below are refused with a vpException (badValue) `name: came, expected ...`.
*/
class VISP_EXPORT vpEmission
{
public:
  //! Lengths that a pattern may have.
  static constexpr double narrowest = 0.02, widest = 10;
  //! Dies in a ring or across a grid, patches of a cracked cover.
  static constexpr unsigned int mostDies = 100, mostAcross = 20, mostPatches = 200;

  //! The same everywhere. (vpSimulatedLamp::rim still dims a disc's rim.)
  vpEmission() = default;

  //! One die behind a cover: rest + (1 - rest) G(p - place, width). \param place Within the unit circle.
  static vpEmission hotSpot(const Eigen::Vector2d &place, double width, double rest);

  //! Dies evenly on a circle, the first on the x axis: rest + (1 - rest) sum of G(p - die, width), over its
  //! maximum. \param radius Of the circle, 0.05 to 0.95.
  static vpEmission ringOfDies(unsigned int dies, double radius, double width, double rest);

  //! Dies in the middles of \e across x \e across cells: rest + (1 - rest) G(p - nearest die, width).
  static vpEmission gridOfDies(unsigned int across, double width, double rest);

  //! An opal dome: rim + (1 - rim) (1 - r^2)^(power / 2). \param power 0 to 10; 1: the height of a sphere.
  static vpEmission dome(double rim, double power);

  //! A panel lit from its edges x = 1 and x = -1: rest + (1 - rest) (exp((x - 1) / depth) + other exp((-1 -
  //! x) / depth)), over its maximum. \param other Light of the edge x = -1, share of that of the edge x = 1.
  static vpEmission edgeLit(double depth, double rest, double other);

  //! Voronoi cells about random places, each of a brightness of its own. \param spread Standard deviation of
  //! the logarithm of the brightness, 0 to 3.
  static vpEmission cracked(unsigned int patches, double spread, std::uint64_t seed);

  //! Of a square only the strip |y| < width shines, evenly. \param width Share of the side, 0.01 to 1.
  static vpEmission tube(double width);

  //! Whether all of the outline shines, equally bright.
  bool even() const { return !patterned() && m_strip == 1; }

  //! Whether what shines of it is not equally bright.
  bool patterned() const { return static_cast<bool>(m_pattern); }

  //! Share of a square's side that shines, about its x axis: less than 1 of a tube only.
  double strip() const { return m_strip; }

  //! Brightness at a place, 0 to 1; regardless of the outline.
  double at(const Eigen::Vector2d &place) const
  {
    return m_pattern ? m_pattern(place) : std::abs(place.y()) <= m_strip ? 1 : 0;
  }

  //! What a mirror makes of it: at (x, y) what was at (x, -y).
  vpEmission mirrored() const;

private:
  using Pattern = std::function<double(const Eigen::Vector2d &place)>;
  explicit vpEmission(Pattern pattern) : m_pattern(std::move(pattern)) {}

  Pattern m_pattern; // none: even
  double m_strip = 1;
};

END_VISP_NAMESPACE

#endif
