/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "common/vpLampChart.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/QR>
#include <opencv2/imgproc.hpp>
#include <visp3/vlp_identification/vpLitShare.h>

#include "common/vpTextBlock.h"
#include "common/vpVlpColours.h"

BEGIN_VISP_NAMESPACE

namespace
{
constexpr size_t mostCharts = 3, fewestLines = 3;

bool blinks(const vpLampObservation &lamp)
{
  static const double leastModulation = 0.05; // as of vpStripeAnalyzer::minModulation
  return lamp.features.signal != vpStripeFeatures::Signal::unmodulated ||
         lamp.features.modulation >= leastModulation;
}

//! The wave that the features say, scaled to the light.
std::vector<double> fittedTo(const vpStripeProfile &profile, const vpStripeFeatures &features)
{
  const std::vector<double> lit = vpLitShareOf(features, profile.time);
  const auto lines = static_cast<Eigen::Index>(lit.size());
  static const Eigen::Index highest = 4, each = 8; // order of the envelope; lines, that each order needs
  const Eigen::Index order = std::min(highest, lines / each);
  const auto finite = [](double share) { return std::isfinite(share); };
  if (lines < 2 || !std::all_of(lit.begin(), lit.end(), finite)) {
    return {};
  }
  Eigen::MatrixXd model(lines, order + 2); // the offset, and what the orders of the envelope make of the wave
  model.col(0).setOnes();
  model.col(1) = Eigen::Map<const Eigen::VectorXd>(lit.data(), lines);
  const Eigen::VectorXd along = Eigen::VectorXd::LinSpaced(lines, -1, 1);
  for (Eigen::Index i = 1; i <= order; ++i) {
    model.col(i + 1) = model.col(i).cwiseProduct(along);
  }
  const Eigen::Map<const Eigen::VectorXd> light(profile.light.data(), lines);
  const Eigen::VectorXd fitted = model * model.colPivHouseholderQr().solve(light);
  return {fitted.data(), fitted.data() + lines};
}

std::vector<std::string> exposureText(const vpExposureEvidence &exposure)
{
  const double claimed = 1e6 * exposure.stated(), found = 1e6 * exposure.exposure(),
               sigma = found * exposure.logSigma();     // us
  const bool open = found < claimed || found > claimed; // else the rig left the stripes nothing to say
  return {vpFormat("exposure: rig says %.3g us,", claimed),
          open ? vpFormat("stripes say %.3g +/- %.2g us", found, sigma)
               : vpFormat("not measured, +/- %.2g us", sigma)};
}

//! Where times and grey levels are in a chart.
struct Axes {
  cv::Rect plot;
  double firstTime, lastTime, most; // s; light, from 0

  cv::Point2d operator()(double time, double light) const
  {
    const double share = std::clamp(light / most, -0.1, 1.1);
    return {plot.x + (plot.width - 1) * (time - firstTime) / (lastTime - firstTime),
            plot.y + (plot.height - 1) * (1 - share)};
  }
};

Axes axesOf(const vpLampChart &chart, const cv::Rect &plot)
{
  const auto [first, last] = std::minmax_element(chart.time.begin(), chart.time.end());
  static const double room = 1.15; // above the brightest line
  double most = *std::max_element(chart.light.begin(), chart.light.end());
  if (!chart.fitted.empty()) {
    most = std::max(most, *std::max_element(chart.fitted.begin(), chart.fitted.end()));
  }
  return {plot, *first, std::max(*last, *first + 1e-9), room * std::max(most, 1.0)};
}

void drawAxes(cv::Mat &picture, const Axes &axes, double unit)
{
  const cv::Rect &plot = axes.plot;
  const double small = 0.8 * unit;
  const int gap = cvRound(4 * unit), below = plot.br().y + cvRound(12 * unit);
  cv::line(picture, plot.tl(), {plot.x, plot.br().y}, vpVlpColours::grey, 1);
  cv::line(picture, {plot.x, plot.br().y}, plot.br(), vpVlpColours::grey, 1);
  const auto right = [&](const std::string &text, int edge, int base) {
    vpDrawText(picture, text, {edge - vpTextSize(text, small).width, base}, small, vpVlpColours::grey);
  };
  right(vpFormat("%.0f", axes.most), plot.x - gap, plot.y + cvRound(8 * unit));
  right("0", plot.x - gap, plot.br().y);
  vpDrawText(picture, vpFormat("%.1f", 1e3 * axes.firstTime), {plot.x, below}, small, vpVlpColours::grey);
  right(vpFormat("%.1f ms", 1e3 * axes.lastTime), plot.br().x, below);
}

void drawLegend(cv::Mat &picture, const Axes &axes, bool fitted, double unit)
{
  const double small = 0.8 * unit;
  const int base = axes.plot.y - cvRound(4 * unit);
  const std::string light = "light of each line";
  vpDrawText(picture, light, {axes.plot.x, base}, small, vpVlpColours::white);
  vpDrawText(picture, fitted ? "fitted wave" : "no wave fits",
             {axes.plot.x + vpTextSize(light, small).width + cvRound(12 * unit), base}, small,
             vpVlpColours::violet);
}
} // namespace

cv::Mat vpLampChart::draw(double unit) const
{
  cv::Mat picture(cvRound(88 * unit), cvRound(204 * unit), CV_8UC3, cv::Scalar::all(0));
  if (time.empty()) {
    return picture;
  }
  const int left = cvRound(28 * unit), top = cvRound(15 * unit), low = cvRound(16 * unit),
            right = cvRound(8 * unit);
  const Axes axes = axesOf(*this, {left, top, picture.cols - left - right, picture.rows - top - low});
  drawAxes(picture, axes, unit);
  drawLegend(picture, axes, !fitted.empty(), unit);

  constexpr int bits = 4; // that OpenCV's drawing takes as the fraction of a coordinate
  const auto fixed = [&](double at, double level) {
    const cv::Point2d point = axes(at, level) * (1 << bits);
    return cv::Point(cvRound(point.x), cvRound(point.y));
  };
  std::vector<cv::Point> wave;
  for (size_t i = 0; i < fitted.size(); ++i) {
    wave.push_back(fixed(time[i], fitted[i]));
  }
  if (!wave.empty()) {
    cv::polylines(picture, wave, false, vpVlpColours::violet, std::max(1, cvRound(0.5 * unit)), cv::LINE_AA,
                  bits);
  }
  for (size_t i = 0; i < light.size(); ++i) {
    cv::circle(picture, fixed(time[i], light[i]), cvRound(1.1 * unit * (1 << bits)), vpVlpColours::white,
               cv::FILLED, cv::LINE_AA, bits);
  }
  return picture;
}

std::vector<vpLampChart> vpLampChartsOf(const vpImage<unsigned char> &I,
                                        const std::vector<vpLampObservation> &observations,
                                        const vpLedDetector &detector)
{
  std::vector<size_t> unidentified;
  for (size_t i = 0; i < observations.size(); ++i) {
    if (observations[i].id.empty() && blinks(observations[i])) {
      unidentified.push_back(i);
    }
  }
  std::stable_sort(unidentified.begin(), unidentified.end(), [&](size_t a, size_t b) {
    return observations[a].features.area > observations[b].features.area;
  });
  std::vector<vpLampChart> charts;
  for (const size_t i : unidentified) {
    if (charts.size() == mostCharts) {
      break;
    }
    vpStripeProfile profile = detector.profile(I, observations[i]);
    if (profile.light.size() < fewestLines) {
      continue;
    }
    vpLampChart chart;
    chart.lamp = i;
    chart.fitted = fittedTo(profile, observations[i].features);
    chart.time = std::move(profile.time);
    chart.light = std::move(profile.light);
    chart.caption = exposureText(detector.exposure());
    charts.push_back(std::move(chart));
  }
  return charts;
}

END_VISP_NAMESPACE
