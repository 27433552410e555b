/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpEllipseEdges_h
#define vpEllipseEdges_h

#include <vector>

#include "vpEdgeFit.h"
#include "vpEllipseLanes.h"

BEGIN_VISP_NAMESPACE

/*!
  What vpEdgeFit asks of the ends of a line, for an ellipse and eight lines at a time: it is there that nearly
  all pixels are looked at. In single precision, relative to the ellipse's middle.
*/
class vpEllipseEdges
{
public:
  using EightLines = vpEightLines<vpEllipseModel::parameters + 1>;
  using LineEnds = vpLineEnds<vpEllipseModel::parameters + 1>;
  using Equations = vpNormalEquations<vpEllipseModel::parameters + 1>;

  //! \param v, u Positions of the lines and of the samples, px. \param aligned Each sample lies where its
  //! number says. \param shading 1/px, share by which the light grows along the line. \param reach px on
  //! either side of the edge.
  vpEllipseEdges(const cv::Mat_<unsigned char> &lines, const std::vector<double> &v,
                 const std::vector<double> &u, bool aligned, const vpEllipseModel &model, double blur,
                 double shading, double reach)
      : m_lines(lines), m_v(v), m_u(u), m_model(model), m_blur(blur), m_shading(shading), m_reach(reach),
        m_aligned(aligned)
  {
  }

  /*!
    The lines from \e from to \e to; where \e litOnly those that are lit in their middle, about, as the ends
    of others show nothing, and of these \e most at most, evenly spread. \param some Takes their numbers.
    \param light For its memory.
  */
  static void linesOf(const cv::Mat_<unsigned char> &lines, int from, int to, const vpEllipseModel &model,
                      size_t most, bool litOnly, std::vector<int> &some, std::vector<int> &light);

  //! Appends the ends of these lines; where the outline runs along a line, and \e touched asks for it, its
  //! first one for both, whose equations are appended to \e along.
  void find(const std::vector<int> &lines, bool touched, std::vector<EightLines> &ends,
            std::vector<Equations> &along) const;

private:
  void touch(const vpEllipseLanes::Ellipse &ellipse, bool sharp, const vpLineStretch &stretch, float v,
             int lane, EightLines &eight, std::vector<Equations> &along) const;

  const cv::Mat_<unsigned char> &m_lines;
  const std::vector<double> &m_v, &m_u;
  const vpEllipseModel &m_model;
  double m_blur, m_shading, m_reach;
  bool m_aligned;
};

END_VISP_NAMESPACE

#endif
