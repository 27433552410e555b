/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_detection/vpStripeAnalyzer.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/LU>

#include "vpOutlineModel.h"

BEGIN_VISP_NAMESPACE

namespace
{

const int white = 250; // grey value from which a pixel may have had more light than it shows

//! Stretch of line \e v inside the outline, shrunk towards its middle by \e share.
bool chordOf(const vpLampOutline &outline, double v, double share, double &first, double &last)
{
  if (outline.shape == vpLampOutline::Shape::ellipse) {
    if (!vpEllipseModel(outline.centre, outline.a, outline.b, outline.angle).stretch(v, 0, first, last)) {
      return false;
    }
  } else {
    first = 1e9;
    last = -1e9;
    for (size_t i = 0; i < 4; ++i) {
      const Eigen::Vector2d &p = outline.corners[i];
      const Eigen::Vector2d &q = outline.corners[(i + 1) % 4];
      if ((p.y() - v) * (q.y() - v) <= 0 && p.y() != q.y()) {
        const double u = p.x() + (q.x() - p.x()) * (v - p.y()) / (q.y() - p.y());
        first = std::min(first, u);
        last = std::max(last, u);
      }
    }
    if (first > last) {
      return false;
    }
  }
  const double cut = 0.5 * (1 - share) * (last - first);
  first += cut;
  last -= cut;
  return true;
}

//! Samples of one line, inside the lamp.
struct Chord {
  int line, first, last;
};

/*!
  How an emitter dims from its middle to its rim, as exp(a r^2 + b r^4), r being 0 at its middle and 1 at its
  outline. All samples of a line are exposed together, so each lit line shows it whatever the stripes are:
  least squares of the logarithms, each line with a brightness of its own.
*/
class Falloff
{
public:
  Falloff() = default;
  Falloff(const cv::Mat_<unsigned char> &lines, const std::vector<Chord> &chords, const vpOutlineFit &fit);

  //! Whether the lamp is about as bright at its rim as in its middle.
  bool even() const { return m_even; }

  //! Light at the samples of a chord, as a share of that at the lamp's middle.
  void along(const Chord &chord, std::vector<double> &shares) const
  {
    shares.assign(static_cast<size_t>(chord.last - chord.first + 1), 1);
    for (int x = chord.first; !m_even && x <= chord.last; ++x) {
      const double place = std::min(squaredRadius(x, chord.line) * perUnit, nodes - 1.001);
      const auto node = static_cast<size_t>(place);
      shares[static_cast<size_t>(x - chord.first)] =
          m_shares[node] + (place - static_cast<double>(node)) * (m_shares[node + 1] - m_shares[node]);
    }
  }

private:
  static constexpr size_t nodes = 256;
  static constexpr double perUnit = 200; // of the squared radius, which inside the lamp is 1 at most

  double squaredRadius(int sample, int line) const
  {
    return (m_toDisc * (Eigen::Vector2d(sample, line) - m_centre)).squaredNorm();
  }

  bool m_even = true;
  std::array<double, nodes> m_shares{}; // by squared radius
  Eigen::Vector2d m_centre = Eigen::Vector2d::Zero();
  Eigen::Matrix2d m_toDisc = Eigen::Matrix2d::Identity(); // from the outline to the unit circle
};

Falloff::Falloff(const cv::Mat_<unsigned char> &lines, const std::vector<Chord> &chords,
                 const vpOutlineFit &fit)
    : m_centre(fit.outline.centre)
{
  const vpLampOutline &outline = fit.outline;
  const double c = std::cos(outline.angle), s = std::sin(outline.angle);
  m_toDisc << c / outline.a, s / outline.a, -s / outline.b, c / outline.b;
  static const double roughness = 0.02; // share of the light by which an emitter is not smooth, sigma
  static const double usual = 1;        // of a and b, standard deviation
  static const int enough = 64;         // samples of a line
  const double noise = std::max(fit.noise, 0.3), least = std::max(8 * noise, 6.0);
  std::array<double, 256> logs{}; // of the light of each grey value
  for (size_t grey = 0; grey < logs.size(); ++grey) {
    logs[grey] = std::log(std::max(static_cast<double>(grey) - fit.background, least));
  }
  Eigen::Matrix2d H = Eigen::Matrix2d::Identity() / (usual * usual);
  Eigen::Vector2d g = Eigen::Vector2d::Zero();
  for (const Chord &chord : chords) {
    const int step = std::max(1, (chord.last - chord.first) / enough);
    double weights = 0, sum = 0;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero(), byLog = Eigen::Vector2d::Zero();
    Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
    for (int x = chord.first; x <= chord.last; x += step) {
      const double light = lines(chord.line, x) - fit.background;
      if (light < least || lines(chord.line, x) >= white) {
        continue;
      }
      const double weight = 1 / (noise * noise / (light * light) + roughness * roughness);
      const double r2 = squaredRadius(x, chord.line), log = logs[lines(chord.line, x)];
      const Eigen::Vector2d powers(r2, r2 * r2);
      weights += weight;
      sum += weight * log;
      mean += weight * powers;
      byLog += weight * log * powers;
      squares += weight * powers * powers.transpose();
    }
    if (weights > 0) {
      mean /= weights;
      H += squares - weights * mean * mean.transpose();
      g += byLog - sum * mean;
    }
  }
  const Eigen::Vector2d solution = H.inverse() * g;
  static const double most = 4; // of the logarithm at the rim: what goes farther is no lamp's falloff
  // The envelope of the stripes makes up for so little.
  static const double little = 0.003;
  m_even = !(solution.allFinite() && std::abs(solution.sum()) < most && solution.norm() < 3 * most) ||
           solution.cwiseAbs().sum() < little;
  for (size_t node = 0; !m_even && node < nodes; ++node) {
    const double r2 = static_cast<double>(node) / perUnit;
    m_shares[node] = std::exp((solution.x() + solution.y() * r2) * r2);
  }
}

//! Sums over some samples of a line, for least squares of its brightness at the lamp's middle.
struct Brightness {
  double light = 0, squares = 0;
  void add(double share, double seen)
  {
    light += share * seen;
    squares += share * share;
  }
  double value() const { return light / squares; }
};

//! The samples of one line of the lamp.
class LineSamples
{
public:
  LineSamples(const unsigned char *row, const Chord &chord, const Falloff &falloff, double background)
      : m_first(row + chord.first), m_count(chord.last - chord.first + 1), m_even(falloff.even()),
        m_background(background)
  {
    if (!m_even) {
      falloff.along(chord, m_shares);
    }
  }
  int count() const { return m_count; }

  //! Of samples \e from to before \e to.
  Brightness sum(int from, int to) const
  {
    Brightness brightness;
    if (m_even) {
      int light = 0;
      for (int i = from; i < to; ++i) {
        light += m_first[i];
      }
      return {light - (to - from) * m_background, static_cast<double>(to - from)};
    }
    for (int i = from; i < to; ++i) {
      brightness.add(m_shares[static_cast<size_t>(i)], m_first[i] - m_background);
    }
    return brightness;
  }

  //! Of those that are not white; of all where these are too few.
  Brightness whole() const
  {
    static const int enough = 4; // samples
    int count = 0;
    for (int i = 0; i < m_count; ++i) {
      count += m_first[i] < white;
    }
    if (count == m_count || count < enough) {
      return sum(0, m_count);
    }
    Brightness brightness;
    for (int i = 0; i < m_count; ++i) {
      if (m_first[i] < white) {
        brightness.add(m_even ? 1 : m_shares[static_cast<size_t>(i)], m_first[i] - m_background);
      }
    }
    return brightness;
  }

private:
  const unsigned char *m_first;
  int m_count;
  bool m_even;
  double m_background;
  std::vector<double> m_shares;
};

/*!
  Correlation over the lines of what their left and right halves show, pixel noise taken off: 1 where light
  that varies from line to line does so on the whole of each line, as a shutter's stripes do.
*/
class Agreement
{
public:
  void add(const LineSamples &line, double noise)
  {
    static const int fewest = 8; // samples of a line
    const int half = line.count() / 2;
    if (line.count() < fewest) {
      return;
    }
    const double left = line.sum(0, half).value(),
                 right = line.sum(line.count() - half, line.count()).value(), weight = line.count();
    m_weight += weight;
    m_left += weight * left;
    m_right += weight * right;
    m_leftLeft += weight * left * left;
    m_rightRight += weight * right * right;
    m_leftRight += weight * left * right;
    m_noise += weight * noise * noise / half;
  }

  double value() const
  {
    if (!(m_weight > 0)) {
      return 1;
    }
    const double left = m_left / m_weight, right = m_right / m_weight, noise = m_noise / m_weight;
    const double leftVariance = m_leftLeft / m_weight - left * left - noise,
                 rightVariance = m_rightRight / m_weight - right * right - noise;
    const double common = m_leftRight / m_weight - left * right;
    return common / std::sqrt(std::max(leftVariance * rightVariance, 1e-12));
  }

private:
  double m_weight = 0, m_left = 0, m_right = 0, m_leftLeft = 0, m_rightRight = 0, m_leftRight = 0,
         m_noise = 0;
};

//! Whether most of some line is white.
bool hasWhiteLines(const cv::Mat_<unsigned char> &lines, const std::vector<Chord> &chords)
{
  return std::any_of(chords.begin(), chords.end(), [&lines](const Chord &chord) {
    const unsigned char *row = lines[chord.line];
    return 2 * std::count_if(row + chord.first, row + chord.last + 1,
                             [](unsigned char grey) { return grey >= white; }) >
           chord.last - chord.first;
  });
}

} // namespace

vpStripeProfile vpStripeProfile::along(const cv::Mat_<unsigned char> &lines, const vpLineTiming &timing,
                                       const vpOutlineFit &fit, const vpLedRoi &roi)
{
  const vpLampOutline &outline = fit.outline;
  const bool ellipse = outline.shape == vpLampOutline::Shape::ellipse; // else its sides along the lines hide
  const bool soft = outline.shape == vpLampOutline::Shape::region || fit.blur > 0.1 * outline.diameter() / 2;
  const double margin = soft ? 0 : 2 * fit.blur;
  const Eigen::Vector4d box = outline.box();
  const double top = ellipse ? std::max(0.0, box(1)) : std::max<double>(roi.box.y, box(1));
  const double bottom =
      ellipse ? std::min(lines.rows - 1.0, box(3)) : std::min<double>(roi.box.br().y - 1, box(3));
  auto chordsOf = [&](double share) {
    std::vector<Chord> chords;
    for (int line = static_cast<int>(std::ceil(top + margin)); line <= bottom - margin; ++line) {
      double first, last;
      if (!chordOf(outline, line, share, first, last)) {
        continue;
      }
      const int left = std::max(0, static_cast<int>(std::ceil(first)));
      const int right = std::min(lines.cols - 1, static_cast<int>(std::floor(last)));
      if (right - left >= 2) {
        chords.push_back({line, left, right});
      }
    }
    return chords;
  };
  static const double inside = 0.8, middle = 0.35; // of a chord
  std::vector<Chord> chords = chordsOf(soft ? middle : inside);
  if (ellipse && !soft && hasWhiteLines(lines, chords)) {
    chords = chordsOf(std::max(inside, 1 - (margin + 1) / outline.b)); // the rim may be dimmer than white
  }
  const Falloff falloff = ellipse && !soft ? Falloff(lines, chords, fit) : Falloff();
  vpStripeProfile profile;
  profile.exposure = std::hypot(timing.exposure(), timing.averaging());
  Agreement agreement;
  for (const Chord &chord : chords) {
    const LineSamples line(lines[chord.line], chord, falloff, fit.background);
    const Brightness brightness = line.whole();
    profile.time.push_back(timing.middle(static_cast<unsigned int>(chord.line)));
    profile.light.push_back(brightness.value());
    profile.sigma.push_back(std::max(fit.noise, 0.3) / std::sqrt(brightness.squares));
    agreement.add(line, fit.noise);
  }
  profile.agreement = agreement.value();
  return profile;
}

END_VISP_NAMESPACE
