/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpEdgeFit_h
#define vpEdgeFit_h

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <visp3/vlp_detection/vpOutlineFitter.h>

#include "vpLineEnds.h"
#include "vpOutlineModel.h"

BEGIN_VISP_NAMESPACE

namespace vpEdgeLimits
{
constexpr float lit = 0.6f, unlit = 0.4f; // shares of a pixel that the pixels of an end have to reach beyond
constexpr double sharp = 0.5;             // px of blur up to which a pixel's square is no Gaussian
} // namespace vpEdgeLimits

//! How much brighter lens shading (vignetting) leaves some samples of a lamp than its middle.
struct vpLensShading {
  double middle;   // px along the line, of the lamp, about
  double perPixel; // share of the light there by which it grows along the line

  //! Times. \param u px along the line.
  double at(double u) const { return 1 + perPixel * (u - middle); }
};

//! Samples of a line about an edge.
struct vpLineStretch {
  int from, to;

  vpLineStretch(double first, double last, int samples)
      : from(std::max(0, static_cast<int>(std::ceil(first)))),
        to(std::min(samples - 1, static_cast<int>(std::floor(last))))
  {
  }
  bool enough() const { return to - from >= 3; }
};

//! How even a lamp is: 1 for a disc of one brightness.
struct vpLampEvenness {
  double edges = 0; // contrast of the edge over that of the brightest inside, mean over the lines
  //! Where white clips some lines, the edge lies too far out for its contrast to tell. Then, on lines that
  //! white spares: light a little inside the edge over that of all of the line, or the reverse, whichever is
  //! less. 0 where no such line tells.
  double spared = 1;
};

//! What outlines are fitted to.
struct vpEdgeFitPicture {
  const cv::Mat_<unsigned char> &lines;
  const std::vector<double> &linePositions, &samplePositions;
  bool samplesAligned; // each lies where its number says
};

/*!
  Gauss-Newton fit of an outline to the grey values about the two ends of each lit line: the pixel-integrated
  blurred edge, its blur, and each end's own background and amplitude, so that it does not matter where the
  stripes lie. Lens shading (vignetting) along the lines would move both ends the same way: how much
  there is of it is what amplitudes of first and last ends say together. Where the outline crosses a line,
  the edge is taken as straight within its blur for the derivatives, not for the distances, so that the
  minimum is the same.
*/
template <class Model>
class vpEdgeFit
{
public:
  static constexpr int N = Model::parameters + 1;
  using EightLines = vpEightLines<N>;
  using Equations = vpNormalEquations<N>;

  //! What a fit works on; one after the other may use the same, so that the next takes no memory.
  struct Memory {
    std::vector<EightLines> ends;
    std::vector<Equations> along;  // of ends that run along their line
    std::vector<float> sorted;     // of the ends
    std::vector<int> lines, light; // that are looked at, and how bright they are

    //! \param most Lines that there may be. Memory is taken for twice as many: the next lamp has one more.
    void clear(size_t most)
    {
      static const size_t touched = 64; // lines that the outline runs along
      ends.clear();
      along.clear();
      if (lines.capacity() < most) {
        along.reserve(touched);
        ends.reserve(2 * most / vpLanes::count + 1);
        sorted.reserve(4 * most);
        lines.reserve(2 * most);
        light.reserve(2 * most);
      }
    }
  };

  vpEdgeFit(const vpEdgeFitPicture &picture, const Model &start, Memory &memory)
      : m_lines(&picture.lines), m_v(&picture.linePositions), m_u(&picture.samplePositions),
        m_aligned(picture.samplesAligned), m_model(start), m_memory(&memory)
  {
  }

  //! How to get to the minimum. From a start that is good to a few pixels some of the lines will do first.
  struct Steps {
    int most;
    int sparse = 0;        // so many of the first are by a few lines, of those that are lit
    double still = 1e-3;   // px, of the last
    bool litOnly = false;  // by lit lines only, all of them
    bool litShine = false; // the few lit lines show an edge for certain: it is a lamp that was seen before
  };
  //! \param blur px, to begin with; 0: one that suits the size.
  bool run(const cv::Rect &box, double shapeSigma, const Steps &steps, double blur = 0);
  vpOutlineFit result() const;
  //! After run().
  const vpLampEvenness &evenness() const { return m_evenness; }
  //! Mean squared residual of all lit ends, the outliers among them too, grey levels^2; and how many pixels
  //! that is of.
  double misfit() const { return m_misfit; }
  double pixels() const { return m_pixels; }
  //! Share of the lit ends that take part: others are far from where the outline has them.
  double kept() const { return m_kept; }
  //! Share of the ends looked at that are lit: after runNear() nearly all are, of a lamp that nothing hides.
  double shining() const { return m_shining; }
  //! Chi-square of the shape's prior.
  double prior() const { return m_prior; }

private:
  void addEnds(int from, int to);
  void findEnds();
  void assemble(Equations &equations);
  std::vector<float> &valuesOf(vpLanes::Floats vpLineEnds<N>::*value,
                               vpLanes::Integers vpLineEnds<N>::*which) const;
  void measureEvenness();
  double sparedEvenness() const;

  const cv::Mat_<unsigned char> *m_lines;
  const std::vector<double> *m_v;
  const std::vector<double> *m_u;
  bool m_aligned; // of the samples
  Model m_model;
  double m_blur = 1.5;
  double m_middle = 0;  // px along the line, of the lamp, about
  double m_shading = 0; // share of the light in the middle by which it grows along the line, 1/px
  double m_reach = 0;   // px on either side of the edge
  // Lines that are looked at: the region's and a few beyond, as others show nothing of it.
  int m_first = 0, m_last = 0;
  bool m_some = false; // only a few lit lines are looked at, evenly spread
  struct Listed {
    int from = 0, to = -1;
    bool some = false;
  } m_listed;              // in m_memory
  bool m_litOnly = false;  // dark lines are not looked at
  bool m_litShine = false; // as of Steps
  Eigen::Matrix<double, N, N> m_covariance = Eigen::Matrix<double, N, N>::Zero();
  double m_residual = 0;
  double m_inflation = 1;
  double m_noise = 0;
  double m_misfit = 0;
  double m_pixels = 0;
  double m_prior = 0;
  double m_members = 0; // ends that take part
  double m_kept = 0, m_shining = 0;
  vpLampEvenness m_evenness;
  Memory *m_memory;
};

template <>
void vpEdgeFit<vpEllipseModel>::addEnds(int from, int to);
template <>
void vpEdgeFit<vpQuadrilateralModel>::addEnds(int from, int to);
extern template class vpEdgeFit<vpEllipseModel>;
extern template class vpEdgeFit<vpQuadrilateralModel>;

END_VISP_NAMESPACE

#endif
