/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpEllipseEdges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

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
using vpLanes::Unsigned;
constexpr int lanes = vpLanes::count;

//! Eight ends of lines.
struct alignas(vpLanes::alignment) Ends {
  std::array<const unsigned char *, lanes> row; // of each line
  std::array<int, lanes> from, pixels;          // samples; no pixels: it is none
  int samples;                                  // of a line
  Floats v, crossing;                           // px from the ellipse's middle
};

//! Grey values of four samples from \e first on, the first one in the lowest byte; 0 beyond the line's end.
//! \param samples Of the line, four or more.
VP_LANES_INLINE std::uint32_t fourOf(const unsigned char *row, int first, int samples)
{
  std::uint32_t four;
  const int beyond = std::max(0, first + 4 - samples);
  std::memcpy(&four, row + first - beyond, sizeof(four));
  return beyond == 0 ? four : beyond < 4 ? four >> (8 * beyond) : 0;
}

VP_SIMD_CLONES void measure(const Ends &ends, const double *samples, const Ellipse &ellipse, bool sharp,
                            vpEllipseEdges::LineEnds &found)
{
  const int longest = *std::max_element(ends.pixels.begin(), ends.pixels.end());
  const vpEllipseLanes::SmoothEdge smooth(ellipse.blur);
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
  Unsigned four{}; // grey values of each line, the next one in the lowest byte
  for (int k = 0; k < longest; ++k) {
    if (k % 4 == 0) {
      for (int lane = 0; lane < lanes; ++lane) {
        four[lane] = fourOf(ends.row[lane], ends.from[lane] + k, ends.samples);
      }
    }
    const Floats grey = __builtin_convertvector(reinterpret_cast<Integers>(four & 0xff), Floats);
    four >>= 8;
    Floats u;
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
              : smooth.at(distance);
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
  const Integers valid = (count > 0) & (most >= vpEdgeLimits::lit) & (least <= vpEdgeLimits::unlit);
  auto known = [&valid](const Floats &value) { return vpLanes::select(valid, value, all(0)); };
  found.valid = valid;
  found.crossing = ends.crossing;
  found.pixels = count;
  found.amplitude = known(a);
  found.background = known(reference + (I - a * D) * perPixel);
  found.squares = known(vpLanes::most(II - I * I * perPixel - di * a, all(0)));
  found.shiftShift = known(aa * (SS - S * S * perPixel - sd * sd / dd));
  found.shiftBlur = known(aa * (BS - B * S * perPixel - bd * sd / dd));
  found.blurBlur = known(aa * (BB - B * B * perPixel - bd * bd / dd));
  found.shift = known(a * (SI - S * I * perPixel - sd * a));
  found.blur = known(a * (BI - B * I * perPixel - bd * a));
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
  const vpEllipseLanes::SmoothEdge smooth(ellipse.blur);
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
                            : smooth.at(at.distance);
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
bool reduce(const Touch &touch, int lane, vpEllipseEdges::LineEnds &end, vpEllipseEdges::Equations &equations)
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
  end.amplitude[lane] = static_cast<float>(a);
  end.background[lane] = static_cast<float>(touch.reference + mean(Touch::grey) - a * mean(Touch::share));
  end.squares[lane] = static_cast<float>(std::max(0.0, sums(Touch::grey, Touch::grey)));
  end.pixels[lane] = static_cast<float>(touch.pixels);
  end.shiftShift[lane] = static_cast<float>(a * a * sums(Touch::shift, Touch::shift));
  end.shift[lane] = static_cast<float>(a * sums(Touch::shift, Touch::grey));
  end.valid[lane] = -1;
  constexpr int N = Touch::all - Touch::first;
  equations.H = a * a * sums.bottomRightCorner<N, N>();
  equations.g = a * sums.col(Touch::grey).tail<N>();
  return true;
}
} // namespace

void vpEllipseEdges::linesOf(const cv::Mat_<unsigned char> &lines, int from, int to,
                             const vpEllipseModel &model, size_t most, bool litOnly, std::vector<int> &some,
                             std::vector<int> &light)
{
  some.clear();
  for (int line = from; line <= to; ++line) {
    some.push_back(line);
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
  const auto [darkest, brightest] = std::minmax_element(light.begin(), light.end());
  static const double dark = 0.2; // share of the swing
  const double limit = *darkest + dark * (*brightest - *darkest);
  size_t kept = 0;
  for (size_t i = 0; i < some.size(); ++i) {
    if (light[i] >= limit) {
      some[kept++] = some[i];
    }
  }
  if (kept > most) { // evenly, the middle of each share
    for (size_t i = 0; i < most; ++i) {
      some[i] = some[(2 * i + 1) * kept / (2 * most)];
    }
    kept = most;
  }
  some.resize(kept);
}

void vpEllipseEdges::find(const std::vector<int> &lines, bool touched, std::vector<EightLines> &ends,
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
  const int count = static_cast<int>(lines.size());
  for (int block = 0; block < count; block += lanes) {
    ends.emplace_back();
    EightLines &eight = ends.back();
    std::array<Ends, 2> sides; // where the outline begins on the line, and where it ends
    sides[0].samples = sides[1].samples = m_lines.cols;
    alignas(vpLanes::alignment) Floats v;
    for (int lane = 0; lane < lanes; ++lane) {
      const int line = lines[static_cast<size_t>(std::min(block + lane, count - 1))];
      eight.line[static_cast<size_t>(lane)] = line;
      v[lane] = static_cast<float>(m_v[static_cast<size_t>(line)] - centre.y());
      sides[0].row[lane] = sides[1].row[lane] = m_lines[line];
    }
    Chord outer, edge, inner;
    chords(ellipse, v, outer, edge, inner);
    sides[0].crossing = edge.first;
    sides[1].crossing = edge.last;
    for (Ends &side : sides) {
      side.v = v;
      side.pixels.fill(0);
      side.from.fill(0);
    }
    std::array<bool, lanes> touches{};
    bool any = false, anyTouches = false;
    for (int lane = 0; lane < lanes && block + lane < count; ++lane) {
      if (edge.meets[lane] == 0 || outer.meets[lane] == 0) {
        continue;
      }
      if (inner.meets[lane] == 0 || inner.last[lane] - inner.first[lane] <= 1) {
        touches[static_cast<size_t>(lane)] = anyTouches = touched;
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
    if (any) {
      measure(sides[0], m_u.data(), ellipse, sharp, eight.sides[0]);
      measure(sides[1], m_u.data(), ellipse, sharp, eight.sides[1]);
    }
    for (int lane = 0; lane < lanes && anyTouches; ++lane) {
      if (touches[static_cast<size_t>(lane)]) {
        touch(ellipse, sharp, {centre.x() + outer.first[lane], centre.x() + outer.last[lane], m_lines.cols},
              v[lane], lane, eight, along);
      }
    }
  }
}

//! A line that the outline touches, or comes near: its direction changes from pixel to pixel.
void vpEllipseEdges::touch(const vpEllipseLanes::Ellipse &ellipse, bool sharp, const vpLineStretch &stretch,
                           float v, int lane, EightLines &eight, std::vector<Equations> &along) const
{
  if (!stretch.enough()) {
    return;
  }
  Touch touch{m_lines[eight.line[static_cast<size_t>(lane)]] + stretch.from,
              m_u.data() + stretch.from,
              stretch.to - stretch.from + 1,
              v,
              0,
              {},
              0,
              0};
  touch.reference = 0.5f * static_cast<float>(touch.pixel[0] + touch.pixel[touch.pixels / 2]);
  measure(touch, ellipse, sharp);
  LineEnds &end = eight.sides[0];
  Equations equations;
  for (Floats &outward : end.outward) {
    outward[lane] = 0;
  }
  end.shiftBlur[lane] = end.blurBlur[lane] = end.blur[lane] = 0;
  if (reduce(touch, lane, end, equations)) {
    end.along[lane] = static_cast<int>(along.size());
    along.push_back(equations);
  }
}

END_VISP_NAMESPACE
