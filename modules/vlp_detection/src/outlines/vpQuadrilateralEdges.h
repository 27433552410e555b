/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpQuadrilateralEdges_h
#define vpQuadrilateralEdges_h

#include <vector>

#include "vpEdgeFit.h"

BEGIN_VISP_NAMESPACE

//! What vpEdgeFit asks of the ends of a line, for a quadrilateral.
class vpQuadrilateralEdges
{
public:
  using EightLines = vpEightLines<vpQuadrilateralModel::parameters + 1>;
  using LineEnds = vpLineEnds<vpQuadrilateralModel::parameters + 1>;
  using Equations = vpNormalEquations<vpQuadrilateralModel::parameters + 1>;

  //! \param v, u Positions of the lines and of the samples, px. \param reach px on either side of the edge.
  vpQuadrilateralEdges(const cv::Mat_<unsigned char> &lines, const std::vector<double> &v,
                       const std::vector<double> &u, const vpQuadrilateralModel &model, double blur,
                       const vpLensShading &shading, double reach)
      : m_lines(lines), m_v(v), m_u(u), m_model(model), m_blur(blur), m_shading(shading), m_reach(reach)
  {
  }

  //! Appends the ends of the lines from \e from to \e to; where the outline runs along a line, its first one
  //! for both, whose equations are appended to \e along.
  void find(int from, int to, std::vector<EightLines> &ends, std::vector<Equations> &along) const;

private:
  void setCrossing(int line, const vpLineStretch &pixels, double crossing, int lane, LineEnds &end) const;
  void setAlong(int line, const vpLineStretch &pixels, int lane, LineEnds &end,
                std::vector<Equations> &along) const;

  const cv::Mat_<unsigned char> &m_lines;
  const std::vector<double> &m_v, &m_u;
  const vpQuadrilateralModel &m_model;
  double m_blur;
  vpLensShading m_shading;
  double m_reach;
};

END_VISP_NAMESPACE

#endif
