/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpEllipseLanes_h
#define vpEllipseLanes_h

#include <array>
#include <cmath>

#include <visp3/vlp_core/vpLanes.h>

BEGIN_VISP_NAMESPACE

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpsabi" // as in vpLanes.h

//! vpEllipseModel and vpPixelEdge for eight pixels or lines at a time, in single precision about the
//! ellipse's middle.
namespace vpEllipseLanes
{
using vpLanes::all;
using vpLanes::Floats;
using vpLanes::Integers;

//! Of an ellipse |M x| = 1 about its middle.
struct Ellipse {
  float uu, uv, vv; // M
  float radius, blur, shading, reach;
  double u, v;  // px, its middle
  bool aligned; // samples lie where their numbers say
};

//! Where lines meet the ellipse grown by some distance, px from its middle.
struct alignas(vpLanes::alignment) Chord {
  Floats first, last;
  Integers meets;
};

VP_LANES_INLINE Chord chordOf(const Ellipse &ellipse, const Floats &v, float distance)
{
  const float a = ellipse.uu * ellipse.uu + ellipse.uv * ellipse.uv,
              perV = ellipse.uu * ellipse.uv + ellipse.uv * ellipse.vv,
              perV2 = ellipse.uv * ellipse.uv + ellipse.vv * ellipse.vv,
              grown = 1 + distance / ellipse.radius;
  const Floats b = perV * v, discriminant = b * b - a * (perV2 * v * v - grown * grown);
  const Integers meets = (discriminant > 0) & Integers(all(grown) > 0);
  const Floats half = vpLanes::root(vpLanes::select(meets, discriminant, all(0)));
  return {(-b - half) / a, (-b + half) / a, meets};
}

//! A pixel as the ellipse sees it.
struct Place {
  Floats x0, x1;           // M x
  Floats rho, perSlope;    // |M x|, 1 / |M M x|
  Floats normalU, normalV; // of the outline nearest to it
  Floats distance;         // px outside of it, to first order
};

VP_LANES_INLINE Place placeOf(const Ellipse &ellipse, const Floats &u, const Floats &v)
{
  Place at;
  at.x0 = ellipse.uu * u + ellipse.uv * v;
  at.x1 = ellipse.uv * u + ellipse.vv * v;
  const Floats gradientU = ellipse.uu * at.x0 + ellipse.uv * at.x1,
               gradientV = ellipse.uv * at.x0 + ellipse.vv * at.x1;
  at.rho = vpLanes::root(at.x0 * at.x0 + at.x1 * at.x1);
  at.perSlope = 1 / vpLanes::most(vpLanes::root(gradientU * gradientU + gradientV * gradientV), all(1e-12f));
  at.normalU = gradientU * at.perSlope;
  at.normalV = gradientV * at.perSlope;
  at.distance = (at.rho - 1) * at.rho * at.perSlope;
  return at;
}

//! How the edge there moves outwards with the parameters of vpEllipseModel.
VP_LANES_INLINE std::array<Floats, 5> outwardAt(const Place &at)
{
  return {at.normalU, at.normalV, at.perSlope * at.rho * at.rho,
          0.5f * at.perSlope * (at.x0 * at.x0 - at.x1 * at.x1), at.perSlope * at.x0 * at.x1};
}

//! Of pixels about straight edges: vpPixelEdge, eight at a time.
struct Edge {
  Floats share, byShift, byBlur;
};

//! A Gaussian of the same variance takes the place of the pixel's square.
class SmoothEdge
{
public:
  explicit SmoothEdge(float blur)
      : m_perSpread(1 / std::sqrt(blur * blur + 1 / 12.f)), m_byBlur(blur * m_perSpread * m_perSpread)
  {
  }
  VP_LANES_INLINE Edge at(const Floats &distance) const
  {
    const Floats z = -distance * m_perSpread;
    const vpLanes::Normal normal = vpLanes::normal(z);
    return {normal.below, normal.density * m_perSpread, -z * normal.density * m_byBlur};
  }

private:
  float m_perSpread, m_byBlur;
};

VP_LANES_INLINE Edge sharpEdge(const Floats &distance, const Floats &normalU, const Floats &normalV,
                               float blur)
{
  static constexpr float narrowest = 0.02f;
  const Floats p = vpLanes::most(0.5f * vpLanes::magnitude(normalU), all(narrowest)),
               q = vpLanes::most(0.5f * vpLanes::magnitude(normalV), all(narrowest));
  const float perBlur = 1 / blur;
  Edge edge{all(0), all(0), all(0)};
  for (int corner = 0; corner < 4; ++corner) {
    const float sideP = corner < 2 ? 1 : -1, sideQ = corner % 2 == 0 ? 1 : -1, sign = sideP * sideQ;
    const Floats z = (sideP * p + sideQ * q - distance) * perBlur;
    const vpLanes::Normal normal = vpLanes::normal(z);
    const Floats once = z * normal.below + normal.density;
    edge.share += sign * 0.5f * (z * once + normal.below);
    edge.byShift += sign * once;
    edge.byBlur += sign * normal.below;
  }
  const Floats perArea = blur / (4 * p * q);
  return {edge.share * perArea * blur, edge.byShift * perArea, edge.byBlur * perArea};
}
} // namespace vpEllipseLanes

#pragma GCC diagnostic pop

END_VISP_NAMESPACE

#endif
