/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpEmitterFalloff_h
#define vpEmitterFalloff_h

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <visp3/vlp_detection/vpOutlineFitter.h>

BEGIN_VISP_NAMESPACE

/*!
  How an emitter dims from its middle to its rim, as exp(a r^2 + b r^4), r being 0 at its middle and 1 at its
  outline. All samples of a line are exposed together, so each lit line shows it whatever the stripes are:
  least squares of the logarithms, each line with a brightness of its own.
*/
class vpEmitterFalloff
{
public:
  static constexpr int white = 250; // grey value from which a pixel may have had more light than it shows

  //! Samples of one line, inside the lamp.
  struct Chord {
    int line, first, last;
  };

  //! Squared distance from a lamp's middle along one line, 1 being its outline: scale (x - nearest)^2 +
  //! least.
  struct SquaredRadius {
    float scale, nearest, least;
  };

  //! Of the light at some squared distance from the lamp's middle.
  struct Log {
    float linear = 0, square = 0;
  };

  vpEmitterFalloff() = default;
  vpEmitterFalloff(const cv::Mat_<unsigned char> &lines, const std::vector<Chord> &chords,
                   const vpOutlineFit &fit);

  const Log &log() const { return m_log; }
  bool even() const { return m_log.linear == 0 && m_log.square == 0; }

  SquaredRadius along(int line) const
  {
    const Eigen::Vector2d perSample = m_toDisc.col(0), start = m_toDisc * Eigen::Vector2d(0, line) - m_middle;
    const double scale = perSample.squaredNorm(), nearest = -perSample.dot(start) / scale;
    return {static_cast<float>(scale), static_cast<float>(nearest),
            static_cast<float>((start + nearest * perSample).squaredNorm())};
  }

private:
  Log m_log;
  Eigen::Matrix2d m_toDisc = Eigen::Matrix2d::Identity(); // from the outline to the unit circle
  Eigen::Vector2d m_middle = Eigen::Vector2d::Zero();     // as that has it
};

END_VISP_NAMESPACE

#endif
