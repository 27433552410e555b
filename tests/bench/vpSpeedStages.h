/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpSpeedStages_h
#define vpSpeedStages_h

#include <array>
#include <ctime>
#include <string>
#include <vector>

#include <visp3/vlp_identification/vpLedDetector.h>
#include <visp3/vlp_localization/vpManyLampSolver.h>

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

/*!
  The public pieces that a whole frame goes through, one after the other, and what each takes. The localizer
  does more: joins pieces of lamps, names lamps by their places, looks for those that disagree.
*/
class vpSpeedStages
{
public:
  static const std::vector<std::string> &names()
  {
    static const std::vector<std::string> all = {"regions", "outlines", "profiles", "stripes", "ids", "pose"};
    return all;
  }

  std::array<double, 6> spent{}; // s of this thread, by stage

  vpSpeedStages(const vpVlpRig &rig, const vpLampMap &map)
      : m_rig(rig), m_map(map), m_detector(rig, map), m_timing(rig.lineTiming())
  {
  }

  vpVlpFix process(const vpImage<unsigned char> &I)
  {
    m_last = now();
    const vpLinePicture picture(I, m_rig.shutter.alongColumns());
    const std::vector<vpLedRoi> rois = m_detector.roiDetector.detect(picture.grey);
    end(0);
    std::vector<vpOutlineFit> fits;
    std::vector<vpLampObservation> lamps(rois.size());
    const Eigen::Vector3d vertical(m_rig.bMc[2][0], m_rig.bMc[2][1], m_rig.bMc[2][2]);
    for (size_t i = 0; i < rois.size(); ++i) {
      fits.push_back(m_detector.outlineFitter.fit(picture.grey, m_timing.linePositions(),
                                                  m_timing.samplePositions(), rois[i]));
      lamps[i].outline = fits[i].outline;
      lamps[i].point = fits[i].outline.middle(m_rig.camera, vertical);
      lamps[i].covariance = fits[i].outline.centreCovariance;
    }
    end(1);
    std::vector<vpStripeProfile> profiles;
    for (size_t i = 0; i < rois.size(); ++i) {
      profiles.push_back(vpStripeProfile::along(picture.grey, m_timing, fits[i], rois[i]));
    }
    end(2);
    for (size_t i = 0; i < rois.size(); ++i) {
      lamps[i].features = m_detector.stripeAnalyzer.analyze(profiles[i]);
    }
    end(3);
    m_detector.recognizer.recognize(lamps);
    end(4);
    std::vector<vpLampSight> sights;
    for (const vpLampObservation &lamp : lamps) {
      if (const vpLamp *known = lamp.id.empty() ? nullptr : m_map.find(lamp.id)) {
        sights.push_back(vpLampSight::from(*known, lamp, m_rig.camera));
      }
    }
    const vpVlpFix fix = m_solver.solve(sights, m_rig);
    end(5);
    return fix;
  }

private:
  void end(size_t stage)
  {
    const double time = now();
    spent[stage] += time - m_last;
    m_last = time;
  }

  static double now()
  {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  vpVlpRig m_rig;
  vpLampMap m_map;
  vpLedDetector m_detector;
  vpLineTiming m_timing;
  vpManyLampSolver m_solver;
  double m_last = 0; // s
};

#endif
