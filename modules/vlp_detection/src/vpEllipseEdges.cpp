/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpEllipseEdges.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <visp3/vlp_core/vpSimdClones.h>

#include "vpEllipseLanes.h"

#pragma GCC diagnostic ignored "-Wpsabi" // vectors are passed within this file only

BEGIN_VISP_NAMESPACE

namespace
{
using vpEllipseLanes::Chord;
using vpEllipseLanes::Edge;
using vpEllipseLanes::Ellipse;
using vpEllipseLanes::Place;
using vpLanes::all;
using vpLanes::Floats;
using vpLanes::Integers;
constexpr int lanes = vpLanes::count;

//! Eight ends of lines.
struct Ends {
  std::array<const unsigned char *, lanes> row; // of each line
  std::array<int, lanes> from, pixels;          // samples; no pixels: it is none
  Floats v, crossing;                           // px from the ellipse's middle
};

//! What vpLineEnd says of each.
struct Found {
  std::array<Floats, 5> outward;
  Floats shiftShift, shiftBlur, blurBlur, shift, blur, squares, amplitude, background;
  Integers valid;
};

VP_SIMD_CLONES void measure(const Ends &ends, const double *samples, const Ellipse &ellipse, bool sharp,
                            Found &found)
{
  const int longest = *std::max_element(ends.pixels.begin(), ends.pixels.end());
  const Place crossing = vpEllipseLanes::placeOf(ellipse, ends.crossing, ends.v);
  found.outward = vpEllipseLanes::outwardAt(crossing);
  Floats reference, count, first; // first: of the samples, px from the ellipse's middle
  for (int lane = 0; lane < lanes; ++lane) {
    const int n = ends.pixels[lane];
    first[lane] = static_cast<float>(ends.from[lane] - ellipse.u);
    const unsigned char *pixel = ends.row[lane] + ends.from[lane];
    reference[lane] = n > 0 ? 0.5f * static_cast<float>(pixel[0] + pixel[n - 1]) : 0.f;
    count[lane] = static_cast<float>(n);
  }
  // Sums of grey value I, share D, its derivatives by shift S and blur B, and of their products.
  Floats I{}, D{}, S{}, B{}, II{}, DI{}, DD{}, SI{}, SD{}, SS{}, BI{}, BD{}, BS{}, BB{};
  Floats most = all(0), least = all(1);
  for (int k = 0; k < longest; ++k) {
    Floats grey, u;
    for (int lane = 0; lane < lanes; ++lane) {
      const int last = std::max(0, ends.pixels[lane] - 1);
      grey[lane] = ends.row[lane][ends.from[lane] + std::min(k, last)];
    }
    const Floats member = vpLanes::select(count > static_cast<float>(k), all(1), all(0));
    if (ellipse.aligned) {
      u = first + static_cast<float>(k);
    } else {
      for (int lane = 0; lane < lanes; ++lane) {
        const int sample = ends.from[lane] + (k < ends.pixels[lane] ? k : 0);
        u[lane] = static_cast<float>(samples[sample] - ellipse.u);
      }
    }
    const Floats distance = vpEllipseLanes::placeOf(ellipse, u, ends.v).distance;
    const Edge edge =
        sharp ? vpEllipseLanes::sharpEdge(distance, crossing.normalU, crossing.normalV, ellipse.blur)
              : vpEllipseLanes::smoothEdge(distance, ellipse.blur);
    const Floats light = member * (1 + ellipse.shading * u);
    const Floats i = member * (grey - reference), d = light * edge.share, s = light * edge.byShift,
                 b = light * edge.byBlur;
    most = vpLanes::most(most, d);
    least = vpLanes::least(least, vpLanes::select(member > 0, d, all(1)));
    I += i;
    D += d;
    S += s;
    B += b;
    II += i * i;
    DI += d * i;
    DD += d * d;
    SI += s * i;
    SD += s * d;
    SS += s * s;
    BI += b * i;
    BD += b * d;
    BS += b * s;
    BB += b * b;
  }
  // A mean and a multiple of D are taken off.
  const Floats perPixel = 1 / vpLanes::most(count, all(1));
  const Floats dd = DD - D * D * perPixel, di = DI - D * I * perPixel, sd = SD - S * D * perPixel,
               bd = BD - B * D * perPixel, a = di / dd, aa = a * a;
  found.amplitude = a;
  found.background = reference + (I - a * D) * perPixel;
  found.squares = vpLanes::most(II - I * I * perPixel - di * a, all(0));
  found.shiftShift = aa * (SS - S * S * perPixel - sd * sd / dd);
  found.shiftBlur = aa * (BS - B * S * perPixel - bd * sd / dd);
  found.blurBlur = aa * (BB - B * B * perPixel - bd * bd / dd);
  found.shift = a * (SI - S * I * perPixel - sd * a);
  found.blur = a * (BI - B * I * perPixel - bd * a);
  found.valid = (most >= vpEdgeLimits::lit) & (least <= vpEdgeLimits::unlit);
}

//! One line that the outline touches. Columns: 1, D, I, S; then the derivatives of D by the parameters and B.
struct Touch {
  static constexpr int one = 0, share = 1, grey = 2, shift = 3, first = 4, all = 10;
  const unsigned char *pixel;
  const double *sample; // px
  int pixels;
  float v, reference;
  std::array<std::array<float, all>, all> sums; // of products of two columns, the lower triangle
  float most, least;                            // share
};

VP_SIMD_CLONES void measure(Touch &touch, const Ellipse &ellipse, bool sharp)
{
  std::array<std::array<Floats, Touch::all>, Touch::all> sums{};
  Floats most = all(0), least = all(1);
  for (int k = 0; k < touch.pixels; k += lanes) {
    Floats grey, u, member;
    for (int lane = 0; lane < lanes; ++lane) {
      const bool inside = k + lane < touch.pixels;
      const int sample = inside ? k + lane : 0;
      grey[lane] = touch.pixel[sample];
      u[lane] = static_cast<float>(touch.sample[sample] - ellipse.u);
      member[lane] = inside ? 1.f : 0.f;
    }
    const Place at = vpEllipseLanes::placeOf(ellipse, u, all(touch.v));
    const Edge edge = sharp ? vpEllipseLanes::sharpEdge(at.distance, at.normalU, at.normalV, ellipse.blur)
                            : vpEllipseLanes::smoothEdge(at.distance, ellipse.blur);
    std::array<Floats, Touch::all> column;
    const Floats light = member * (1 + ellipse.shading * u);
    column[Touch::one] = member;
    column[Touch::share] = light * edge.share;
    column[Touch::grey] = member * (grey - touch.reference);
    column[Touch::shift] = light * edge.byShift;
    const std::array<Floats, 5> outward = vpEllipseLanes::outwardAt(at);
    for (size_t p = 0; p < outward.size(); ++p) {
      column[Touch::first + p] = column[Touch::shift] * outward[p];
    }
    column[Touch::all - 1] = light * edge.byBlur;
    most = vpLanes::most(most, column[Touch::share]);
    least = vpLanes::least(least, vpLanes::select(member > 0, edge.share, all(1)));
    for (size_t i = 0; i < Touch::all; ++i) {
      for (size_t j = 0; j <= i; ++j) {
        sums[i][j] += column[i] * column[j];
      }
    }
  }
  touch.most = 0;
  touch.least = 1;
  for (int lane = 0; lane < lanes; ++lane) {
    touch.most = std::max(touch.most, most[lane]);
    touch.least = std::min(touch.least, least[lane]);
  }
  for (size_t i = 0; i < Touch::all; ++i) {
    for (size_t j = 0; j <= i; ++j) {
      float sum = 0;
      for (int lane = 0; lane < lanes; ++lane) {
        sum += sums[i][j][lane];
      }
      touch.sums[i][j] = sum;
    }
  }
}

VP_SIMD_CLONES void chords(const Ellipse &ellipse, const Floats &v, Chord &outer, Chord &edge, Chord &inner)
{
  outer = vpEllipseLanes::chordOf(ellipse, v, ellipse.reach);
  edge = vpEllipseLanes::chordOf(ellipse, v, 0);
  inner = vpEllipseLanes::chordOf(ellipse, v, -ellipse.reach);
}

//! What is left of the sums once a mean and a multiple of D are taken off, as an end of a line.
bool reduce(const Touch &touch, vpEllipseEdges::End &end, vpEllipseEdges::Equations &equations)
{
  if (touch.most < vpEdgeLimits::lit || touch.least > vpEdgeLimits::unlit) {
    return false;
  }
  using Column = Eigen::Matrix<double, Touch::all, 1>;
  Eigen::Matrix<double, Touch::all, Touch::all> sums;
  for (int i = 0; i < Touch::all; ++i) {
    for (int j = 0; j <= i; ++j) {
      sums(i, j) = sums(j, i) = touch.sums[static_cast<size_t>(i)][static_cast<size_t>(j)];
    }
  }
  const Column mean = sums.col(Touch::one) / sums(Touch::one, Touch::one);
  sums -= sums(Touch::one, Touch::one) * mean * mean.transpose();
  const double DD = sums(Touch::share, Touch::share), a = sums(Touch::share, Touch::grey) / DD;
  const Column ofShare = sums.col(Touch::share) / DD;
  sums -= DD * ofShare * ofShare.transpose();
  end.amplitude = a;
  end.background = touch.reference + mean(Touch::grey) - a * mean(Touch::share);
  end.squares = std::max(0.0, sums(Touch::grey, Touch::grey));
  end.pixels = touch.pixels;
  end.shiftShift = a * a * sums(Touch::shift, Touch::shift);
  end.shift = a * sums(Touch::shift, Touch::grey);
  constexpr int N = Touch::all - Touch::first;
  equations.H = a * a * sums.bottomRightCorner<N, N>();
  equations.g = a * sums.col(Touch::grey).tail<N>();
  return true;
}

vpEllipseEdges::End endOf(const Found &side, int lane)
{
  vpEllipseEdges::End end;
  for (Eigen::Index p = 0; p < end.outward.size(); ++p) {
    end.outward(p) = side.outward[static_cast<size_t>(p)][lane];
  }
  end.shiftShift = side.shiftShift[lane];
  end.shiftBlur = side.shiftBlur[lane];
  end.blurBlur = side.blurBlur[lane];
  end.shift = side.shift[lane];
  end.blur = side.blur[lane];
  end.squares = side.squares[lane];
  end.amplitude = side.amplitude[lane];
  end.background = side.background[lane];
  return end;
}
} // namespace

void vpEllipseEdges::linesOf(const cv::Mat_<unsigned char> &lines, int from, int to,
                             const vpEllipseModel &model, int every, bool litOnly, std::vector<int> &some,
                             std::vector<int> &light)
{
  some.clear();
  for (int block = from; block <= to; block += lanes * every) {
    for (int line = block; line <= std::min(to, block + lanes - 1); ++line) {
      some.push_back(line);
    }
  }
  if (!litOnly || some.empty()) {
    return;
  }
  // About the middle, where no part of the outline is but at the lamp's ends.
  static const int apart = 5; // samples
  const int middle = std::clamp(static_cast<int>(model.centre().x()), 2 * apart, lines.cols - 1 - 2 * apart);
  light.clear();
  for (int line : some) {
    const unsigned char *row = lines[line] + middle;
    light.push_back(row[-2 * apart] + row[-apart] + row[0] + row[apart] + row[2 * apart]);
  }
  const auto [least, most] = std::minmax_element(light.begin(), light.end());
  static const double dark = 0.2; // share of the swing
  const double limit = *least + dark * (*most - *least);
  size_t kept = 0;
  for (size_t i = 0; i < some.size(); ++i) {
    if (light[i] >= limit) {
      some[kept++] = some[i];
    }
  }
  some.resize(kept);
}

void vpEllipseEdges::find(const std::vector<int> &lines, std::vector<End> &ends,
                          std::vector<Equations> &along) const
{
  const Eigen::Matrix2d &shape = m_model.shape();
  const Eigen::Vector2d centre = m_model.centre();
  const Ellipse ellipse{static_cast<float>(shape(0, 0)),
                        static_cast<float>(shape(0, 1)),
                        static_cast<float>(shape(1, 1)),
                        static_cast<float>(m_model.radius()),
                        static_cast<float>(m_blur),
                        static_cast<float>(m_shading),
                        static_cast<float>(m_reach),
                        centre.x(),
                        centre.y(),
                        m_aligned};
  const bool sharp = m_blur <= vpEdgeLimits::sharp;
  auto touchAt = [&](int line, float v, double first, double last) {
    const vpLineStretch stretch(centre.x() + first, centre.x() + last, m_lines.cols);
    if (!stretch.enough()) {
      return;
    }
    Touch touch{m_lines[line] + stretch.from,
                m_u.data() + stretch.from,
                stretch.to - stretch.from + 1,
                v,
                0,
                {},
                0,
                0};
    touch.reference = 0.5f * static_cast<float>(touch.pixel[0] + touch.pixel[touch.pixels / 2]);
    measure(touch, ellipse, sharp);
    End end;
    Equations equations;
    if (reduce(touch, end, equations)) {
      end.line = line;
      end.along = static_cast<int>(along.size());
      along.push_back(equations);
      ends.push_back(end);
    }
  };
  const int count = static_cast<int>(lines.size());
  for (int block = 0; block < count; block += lanes) {
    auto lineOf = [&](int lane) { return lines[static_cast<size_t>(std::min(block + lane, count - 1))]; };
    std::array<Ends, 2> sides; // where the outline begins on the line, and where it ends
    Floats v;
    for (int lane = 0; lane < lanes; ++lane) {
      v[lane] = static_cast<float>(m_v[static_cast<size_t>(lineOf(lane))] - centre.y());
    }
    Chord outer, edge, inner;
    chords(ellipse, v, outer, edge, inner);
    sides[0].crossing = edge.first;
    sides[1].crossing = edge.last;
    for (Ends &side : sides) {
      side.v = v;
      side.pixels.fill(0);
      side.from.fill(0);
      for (int lane = 0; lane < lanes; ++lane) {
        side.row[lane] = m_lines[lineOf(lane)];
      }
    }
    bool any = false;
    for (int lane = 0; lane < lanes && block + lane < count; ++lane) {
      if (edge.meets[lane] == 0 || outer.meets[lane] == 0) {
        continue;
      }
      if (inner.meets[lane] == 0 || inner.last[lane] - inner.first[lane] <= 1) {
        touchAt(lineOf(lane), v[lane], outer.first[lane], outer.last[lane]);
        continue;
      }
      auto place = [&](Ends &side, double first, double last) {
        const vpLineStretch stretch(centre.x() + first, centre.x() + last, m_lines.cols);
        if (stretch.enough()) {
          side.from[lane] = stretch.from;
          side.pixels[lane] = stretch.to - stretch.from + 1;
          any = true;
        }
      };
      place(sides[0], outer.first[lane], inner.first[lane]);
      place(sides[1], inner.last[lane], outer.last[lane]);
    }
    if (!any) {
      continue;
    }
    std::array<Found, 2> found;
    measure(sides[0], m_u.data(), ellipse, sharp, found[0]);
    measure(sides[1], m_u.data(), ellipse, sharp, found[1]);
    for (int lane = 0; lane < lanes; ++lane) {
      for (size_t s = 0; s < 2; ++s) {
        if (sides[s].pixels[lane] > 0 && found[s].valid[lane] != 0) {
          ends.push_back(endOf(found[s], lane));
          ends.back().line = lineOf(lane);
          ends.back().crossing = sides[s].crossing[lane];
          ends.back().pixels = sides[s].pixels[lane];
        }
      }
    }
  }
}

END_VISP_NAMESPACE
