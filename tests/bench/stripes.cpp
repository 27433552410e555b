/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// Frequency, duty and phase difference as the detector reads them from rendered pictures: lamps of 146 lines
// with few stripes and many, cut, saturated, uneven, faint, compressed.

#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <visp3/vlp_identification/vpLedDetector.h>
#include <visp3/vlp_simulation/vpRollingShutterRenderer.h>

#include "vpSimulatedStripes.h"

namespace
{
const int diameter = 146; // px

struct Condition {
  const char *name;
  double level = 150;        // grey levels of the lit lamp
  double rim = 0;            // share by which it is dimmer at its rim
  double cut = 0;            // share of it that the picture's border takes, across the stripes
  int jpeg = 0;              // quality; 0: not compressed
  double exposure = 43.1e-6; // s
  double noise = 1;          // grey levels, of a pixel, standard deviation
  vpModulation::Kind kind = vpModulation::Kind::pwm;
};

struct Sum {
  int seen = 0, told = 0, accepted = 0, wrongKind = 0;
  double frequency = 0, duty = 0, phase = 0;          // squared errors
  double ownFrequency = 0, ownDuty = 0, ownPhase = 0; // the same in own standard deviations
  double worst = 0;
};

vpVlpRig rigOf(const Condition &condition)
{
  vpVlpRig rig;
  rig.width = rig.height = 200;
  rig.camera.initPersProjWithoutDistortion(1250, 1250, 99.5, 99.5);
  rig.shutter.rowTime = 43.1e-6;
  rig.shutter.rowTimeSigma = 2e-9;
  rig.shutter.exposure = condition.exposure;
  return rig;
}

vpModulation modulationOf(const Condition &condition, double stripes, std::mt19937_64 &generator)
{
  std::uniform_real_distribution<double> uniform(0, 1);
  vpModulation modulation;
  modulation.kind = condition.kind;
  modulation.frequency = stripes / (diameter * 43.1e-6) * (0.975 + 0.05 * uniform(generator));
  modulation.duty = 0.2 + 0.6 * uniform(generator);
  if (condition.kind == vpModulation::Kind::twoPulse) {
    modulation.duty = 0.2 + 0.2 * uniform(generator);
    modulation.phaseDifference = 0.25 + 0.17 * uniform(generator);
  }
  return modulation;
}

vpImage<unsigned char> compressed(const vpImage<unsigned char> &I, int quality)
{
  const cv::Mat picture(static_cast<int>(I.getHeight()), static_cast<int>(I.getWidth()), CV_8U, I.bitmap);
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, quality});
  const cv::Mat back = cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
  return vpImage<unsigned char>(back.data, I.getHeight(), I.getWidth(), true);
}

void measure(const Condition &condition, double stripes, std::mt19937_64 &generator, Sum &sum,
             std::mutex &guard)
{
  const vpModulation modulation = modulationOf(condition, stripes, generator);
  std::uniform_real_distribution<double> uniform(0, 1);
  vpSimulatedCamera camera;
  camera.rig = rigOf(condition);
  camera.readNoise = condition.noise;
  vpSimulatedLamp lamp;
  lamp.lamp.id = "A";
  const double v =
      condition.cut > 0 ? 1 - 0.5 * diameter + diameter * (1 - condition.cut) : 99.5 + uniform(generator);
  lamp.lamp.position = Eigen::Vector3d((uniform(generator) - 0.5) / 1250, (v - 99.5) / 1250, 1);
  lamp.lamp.size = diameter / 1250.;
  lamp.lamp.modulation = modulation;
  lamp.light = vpLampLight(modulation, 1, uniform(generator));
  lamp.level = condition.level;
  lamp.rim = condition.rim;
  vpSimulatedScene scene;
  scene.lamps.push_back(lamp);
  vpImage<unsigned char> I;
  vpRollingShutterRenderer(camera).render(
      scene, [](double) { return vpHomogeneousMatrix(); }, 0, generator(), I);
  if (condition.jpeg > 0) {
    I = compressed(I, condition.jpeg);
  }
  vpLedDetector detector(camera.rig, vpLampMap{{lamp.lamp}});
  detector.detect(I);
  const std::lock_guard<std::mutex> lock(guard);
  ++sum.seen;
  if (detector.observations().empty()) {
    return;
  }
  sum.accepted += detector.observations().front().id == "A";
  const vpStripeFeatures &features = detector.observations().front().features;
  const bool two = modulation.kind == vpModulation::Kind::twoPulse;
  if (features.signal != (two ? vpStripeFeatures::Signal::twoPulse : vpStripeFeatures::Signal::pwm)) {
    ++sum.wrongKind;
    return;
  }
  const double f = features.frequency - modulation.frequency, d = features.duty - *modulation.duty;
  if (!(features.frequencySigma < 0.1 * features.frequency)) {
    return;
  }
  ++sum.told;
  sum.frequency += f * f;
  sum.duty += d * d;
  sum.ownFrequency += std::pow(f / features.frequencySigma, 2);
  sum.ownDuty += std::pow(d / features.dutySigma, 2);
  sum.worst = std::max(sum.worst, std::abs(f) / features.frequencySigma);
  if (two) {
    const double k = features.phaseDifference - modulation.phaseDifference;
    sum.phase += k * k;
    sum.ownPhase += std::pow(k / features.phaseDifferenceSigma, 2);
  }
}

void run(const Condition &condition, double stripes, int lamps)
{
  Sum sum;
  std::mutex guard;
  vpRunTrials(lamps,
              [&](int, std::mt19937_64 &generator) { measure(condition, stripes, generator, sum, guard); });
  auto rms = [&sum](double squares) { return std::sqrt(squares / std::max(1, sum.told)); };
  std::printf("%-34s %5.1f %6.2f %6.2f %6.2f | %7.2f %5.2f %5.2f | %6.4f %5.2f | %6.4f %5.2f\n",
              condition.name, stripes, 100. * sum.accepted / sum.seen, 100. * sum.wrongKind / sum.seen,
              100. * sum.told / sum.seen, rms(sum.frequency), rms(sum.ownFrequency), sum.worst, rms(sum.duty),
              rms(sum.ownDuty), rms(sum.phase), rms(sum.ownPhase));
  std::fflush(stdout);
}
} // namespace

int main(int argc, char **argv)
{
  const int lamps = argc > 1 ? std::atoi(argv[1]) : 1000;
  std::vector<Condition> conditions(11);
  conditions[0].name = "even disc";
  conditions[1].name = "half of it beyond the border";
  conditions[1].cut = 0.5;
  conditions[2].name = "saturated, 2 x white";
  conditions[2].level = 510;
  conditions[2].rim = 0.7;
  conditions[3].name = "globe, rim at 0.2";
  conditions[3].rim = 0.8;
  conditions[4].name = "JPEG, quality 85";
  conditions[4].jpeg = 85;
  conditions[5].name = "30 grey levels";
  conditions[5].level = 30;
  conditions[6].name = "exposed for 120 us";
  conditions[6].exposure = 120e-6;
  conditions[7].name = "two pulses";
  conditions[7].kind = vpModulation::Kind::twoPulse;
  conditions[8].name = "noise of a line 32 dB, a pixel 20";
  conditions[8].noise = 20;
  conditions[9].name = "noise of a line 26 dB, a pixel 40";
  conditions[9].noise = 40;
  conditions[10].name = "noise of a line 20 dB, a pixel 80";
  conditions[10].noise = 80;
  if (argc > 2)
    conditions = {conditions[static_cast<size_t>(std::atoi(argv[2]))]};
  std::printf("%-34s %5s %6s %6s %6s | %s\n", "lamp", "strip", "id %", "kind", "told %",
              "frequency Hz, own, worst | duty, own | phase difference, own");
  for (const Condition &condition : conditions) {
    for (double stripes : {2., 3., 8., 20., 44., 60.}) {
      run(condition, stripes, lamps);
    }
  }
  return 0;
}
