/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpEdgeFit_h
#define vpEdgeFit_h

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <visp3/vlp_detection/vpOutlineFitter.h>

#include "vpOutlineModel.h"

BEGIN_VISP_NAMESPACE

/*!
  One end of one line: the normal equations of the outline's parameters and the blur from its pixels, with the
  end's own background and amplitude eliminated.
*/
template <int N>
struct vpLineEnd {
  Eigen::Matrix<double, N, N> H;
  Eigen::Matrix<double, N, 1> g;
  double squares = 0; // sum of squared residuals, grey levels
  int pixels = 0;
  double amplitude = 0;  // grey levels
  double background = 0; // grey value
  double offset = 0;     // px, how far this end alone would move the edge outwards
  double offsetWeight = 0;
};

/*!
  Gauss-Newton fit of an outline to the grey values about the two ends of each lit line: the pixel-integrated
  blurred edge, its blur, and each end's own background and amplitude, so that it does not matter where the
  stripes lie.
*/
template <class Model>
class vpEdgeFit
{
public:
  static constexpr int N = Model::parameters + 1;
  using End = vpLineEnd<N>;

  vpEdgeFit(const cv::Mat_<unsigned char> &lines, const std::vector<double> &linePositions,
            const std::vector<double> &samplePositions, const Model &start)
      : m_lines(lines), m_v(linePositions), m_u(samplePositions), m_model(start)
  {
  }

  bool run(const cv::Rect &box, double shapeSigma, int maxIterations);
  vpOutlineFit result() const;
  //! Contrast of the edge over that of the brightest inside, mean over the lines: 1 for an even disc.
  double evenness() const;
  //! Mean squared residual of all lit ends, the outliers among them too, grey levels^2; and how many pixels
  //! that is of.
  double misfit() const { return m_misfit; }
  double pixels() const { return m_pixels; }
  //! Chi-square of the shape's prior.
  double prior() const { return m_prior; }

private:
  std::optional<End> lineEnd(int line, double first, double last) const;
  void collect(int line, double v, std::vector<End> &ends) const;
  std::vector<End> lineEnds() const;
  void assemble(const std::vector<End> &ends, Eigen::MatrixXd &H, Eigen::VectorXd &g);

  const cv::Mat_<unsigned char> &m_lines;
  const std::vector<double> &m_v;
  const std::vector<double> &m_u;
  Model m_model;
  double m_blur = 1.5;
  double m_reach = 0; // px on either side of the edge
  Eigen::MatrixXd m_covariance;
  double m_residual = 0;
  double m_inflation = 1;
  double m_background = 0;
  double m_noise = 0;
  double m_misfit = 0;
  double m_pixels = 0;
  double m_prior = 0;
  double m_members = 0; // ends that take part
};

extern template class vpEdgeFit<vpEllipseModel>;
extern template class vpEdgeFit<vpQuadrilateralModel>;

END_VISP_NAMESPACE

#endif
