/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpTextbookPipeline_h
#define vpTextbookPipeline_h

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "vpSpeedScene.h"

/*!
  What one builds of OpenCV for the same job with the books open: Otsu's threshold, a closing that fills the
  dark stripes, contours, an ellipse for each, the profile of its lines, the peak of its Fourier transform,
  the map's lamp of the nearest frequency, the pose of the two lamps farthest apart.

  Each step is as fast and as exact as OpenCV gives it without leaving that road. The closing's kernel is one
  column, as high as the longest dark stripe and a little: it fills stripes only, needs one pass, and leaves
  the sides as they are. Ellipses are fitted to the convex hull's points, since the notches that are left in
  the contour would pull them inwards. Matrices are kept from frame to frame. It takes lamps for discs that
  are read out along rows, and knows no exposure, tilt or motion.
*/
class vpTextbookPipeline
{
public:
  double least = 12;          // px, smallest height and width of a lamp
  double roundness = 0.75;    // least area of a contour, as a share of the ellipse in its bounding box
  double strip = 0.4;         // of the ellipse's half width, over which lines are averaged
  double rows = 0.9;          // of its half height, over which the strip lies inside
  double minModulation = 0.2; // swing of the fundamental over the mean, below which a lamp counts as steady
  int padding = 4;            // times the profile's length, at least, that are transformed

  vpTextbookPipeline(const vpVlpRig &rig, const vpLampMap &map) : m_rig(rig), m_map(map)
  {
    std::vector<double> frequencies;
    double longestDark = 0; // s
    for (const vpLamp &lamp : map.lamps) {
      const double frequency = lamp.modulation.frequency;
      frequencies.push_back(frequency);
      longestDark = std::max(longestDark, (1 - lamp.modulation.duty.value_or(0.5)) / frequency);
    }
    std::sort(frequencies.begin(), frequencies.end());
    m_lowest = frequencies.front();
    m_highest = frequencies.back();
    m_refusal = 0.5 * m_lowest;
    for (size_t i = 1; i < frequencies.size(); ++i) {
      m_refusal = std::min(m_refusal, 0.5 * (frequencies[i] - frequencies[i - 1]));
    }
    const int dark = static_cast<int>(std::ceil(longestDark / rig.shutter.rowTime));
    m_kernel = cv::getStructuringElement(cv::MORPH_RECT, cv::Size(1, 2 * (dark / 2 + 1) + 1));
  }

  vpSpeedResult process(const vpImage<unsigned char> &I)
  {
    const cv::Mat_<unsigned char> grey(static_cast<int>(I.getHeight()), static_cast<int>(I.getWidth()),
                                       I.bitmap);
    cv::threshold(grey, m_binary, 0, 255, cv::THRESH_BINARY | cv::THRESH_OTSU);
    cv::morphologyEx(m_binary, m_closed, cv::MORPH_CLOSE, m_kernel);
    cv::findContours(m_closed, m_contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);

    std::vector<Lamp> lamps;
    for (const std::vector<cv::Point> &contour : m_contours) {
      if (!mayBeLamp(contour)) {
        continue;
      }
      cv::convexHull(contour, m_hull);
      if (m_hull.size() < 5) {
        continue;
      }
      const cv::RotatedRect ellipse = cv::fitEllipse(m_hull);
      const int index = nearestLamp(frequencyOf(grey, ellipse.boundingRect2f()));
      if (index >= 0) {
        addLamp(lamps, {index, ellipse.center, ellipse.size.area()});
      }
    }
    return locate(lamps);
  }

private:
  struct Lamp {
    int index; // in the map
    cv::Point2f centre;
    float area;
  };
  using Complex = std::complex<double>;

  bool mayBeLamp(const std::vector<cv::Point> &contour) const
  {
    const cv::Rect box = cv::boundingRect(contour);
    return std::min(box.width, box.height) >= least && box.width < 2 * box.height &&
           box.height < 2 * box.width &&
           cv::contourArea(contour) > roundness * M_PI / 4 * box.width * box.height;
  }

  //! Of the light along a lamp's lines, Hz; 0 where it does not blink.
  double frequencyOf(const cv::Mat_<unsigned char> &grey, const cv::Rect2f &box)
  {
    const double u = box.x + 0.5 * box.width, v = box.y + 0.5 * box.height;
    const double halfWidth = 0.5 * strip * box.width, halfHeight = 0.5 * rows * box.height;
    const cv::Rect inside = cv::Rect(cv::Point(cvRound(u - halfWidth), cvRound(v - halfHeight)),
                                     cv::Point(cvRound(u + halfWidth) + 1, cvRound(v + halfHeight) + 1)) &
                            cv::Rect(0, 0, grey.cols, grey.rows);
    if (inside.width < 1 || inside.height < least / 2) {
      return 0;
    }
    cv::reduce(grey(inside), m_profile, 1, cv::REDUCE_AVG, CV_32F);
    const int lines = m_profile.rows, length = cv::getOptimalDFTSize(padding * lines);
    const float mean = static_cast<float>(cv::mean(m_profile)[0]);
    m_signal.create(1, length);
    m_signal = 0;
    double windows = 0;
    for (int i = 0; i < lines; ++i) {
      const double window = 0.5 - 0.5 * std::cos(2 * M_PI * (i + 0.5) / lines);
      m_signal(i) = static_cast<float>(window) * (m_profile(i) - mean);
      windows += window;
    }
    cv::dft(m_signal, m_spectrum);

    const double perHertz = length * m_rig.shutter.rowTime; // bins
    const int first = std::max(1, static_cast<int>((m_lowest - m_refusal) * perHertz)),
              last = std::min((length - 1) / 2 - 1, static_cast<int>((m_highest + m_refusal) * perHertz) + 1);
    int peak = first;
    for (int k = first + 1; k <= last; ++k) {
      peak = power(k) > power(peak) ? k : peak;
    }
    if (2 * std::sqrt(power(peak)) / windows < minModulation * mean) {
      return 0;
    }
    const double before = std::log(power(std::max(1, peak - 1)) + 1e-9), at = std::log(power(peak) + 1e-9),
                 after = std::log(power(peak + 1) + 1e-9), bend = before - 2 * at + after;
    return (peak + (bend < 0 ? 0.5 * (before - after) / bend : 0)) / perHertz;
  }

  //! Of one bin of the packed spectrum, not the first.
  double power(int k) const
  {
    const double re = m_spectrum(2 * k - 1), im = m_spectrum(2 * k);
    return re * re + im * im;
  }

  //! Index in the map; -1 where no lamp's frequency is near.
  int nearestLamp(double frequency) const
  {
    int nearest = -1;
    double apart = m_refusal;
    for (size_t i = 0; i < m_map.lamps.size(); ++i) {
      const double distance = std::abs(m_map.lamps[i].modulation.frequency - frequency);
      if (distance < apart) {
        apart = distance;
        nearest = static_cast<int>(i);
      }
    }
    return nearest;
  }

  //! Each lamp of the map once: where it is the largest.
  static void addLamp(std::vector<Lamp> &lamps, const Lamp &lamp)
  {
    const auto same = std::find_if(lamps.begin(), lamps.end(),
                                   [&lamp](const Lamp &other) { return other.index == lamp.index; });
    if (same == lamps.end()) {
      lamps.push_back(lamp);
    } else if (lamp.area > same->area) {
      *same = lamp;
    }
  }

  //! The two-lamp formula (section 2.1.3 of the paper, in complex numbers) on the pair farthest apart.
  vpSpeedResult locate(const std::vector<Lamp> &lamps) const
  {
    vpSpeedResult result;
    const Lamp *one = nullptr, *two = nullptr;
    double farthest = 0;
    for (const Lamp &a : lamps) {
      result.seen.push_back({lampOf(a).id, Eigen::Vector2d(a.centre.x, a.centre.y)});
      for (const Lamp &b : lamps) {
        const double apart = cv::norm(a.centre - b.centre);
        if (apart > farthest) {
          farthest = apart;
          one = &a;
          two = &b;
        }
      }
    }
    if (!one) {
      return result;
    }
    const Complex q1 = rayOf(*one), q2 = rayOf(*two), P1 = placeOf(*one), P2 = placeOf(*two);
    const Complex a = (P2 - P1) / (q2 - q1), C = (P1 * q2 - P2 * q1) / (q2 - q1);
    const vpHomogeneousMatrix wMc(C.real(), C.imag(), lampOf(*one).position.z() - std::abs(a), 0, 0,
                                  std::arg(a));
    result.wMb = wMc * m_rig.bMc.inverse();
    return result;
  }

  const vpLamp &lampOf(const Lamp &lamp) const { return m_map.lamps[static_cast<size_t>(lamp.index)]; }
  Complex placeOf(const Lamp &lamp) const { return {lampOf(lamp).position.x(), lampOf(lamp).position.y()}; }
  Complex rayOf(const Lamp &lamp) const
  {
    const vpCameraParameters &camera = m_rig.camera;
    return {(lamp.centre.x - camera.get_u0()) / camera.get_px(),
            (lamp.centre.y - camera.get_v0()) / camera.get_py()};
  }

  vpVlpRig m_rig;
  vpLampMap m_map;
  double m_lowest = 0, m_highest = 0; // Hz, of the map
  double m_refusal = 0; // Hz off the nearest lamp's, from which a frequency is none of the map's
  cv::Mat m_kernel, m_binary, m_closed;
  std::vector<std::vector<cv::Point>> m_contours;
  std::vector<cv::Point> m_hull;
  cv::Mat_<float> m_profile, m_signal, m_spectrum;
};

#endif
