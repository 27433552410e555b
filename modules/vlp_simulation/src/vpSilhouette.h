/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpSilhouette_h
#define vpSilhouette_h

#include <vector>

#include <opencv2/core.hpp>
#include <visp3/core/vpHomogeneousMatrix.h>
#include <visp3/vlp_simulation/vpSimulatedScene.h>

#include "vpNodeGrid.h"
#include "vpSensorGrid.h"

BEGIN_VISP_NAMESPACE

//! What people hide from the camera.
class vpSilhouette
{
public:
  //! \e wMc and \e times (s): of each line of nodes.
  vpSilhouette(const vpSensorGrid &grid, const vpNodeGrid &nodes, double blur, const vpSimulatedScene &scene,
               const std::vector<vpHomogeneousMatrix> &wMc, const std::vector<double> &times);

  bool empty() const { return m_people.empty(); }

  //! Takes what people hide out of a line of light (grey values), and puts their own in. \e wMc, \e time: of
  //! that line.
  void hide(int line, const vpHomogeneousMatrix &wMc, double time, float *light) const;

private:
  //! Someone in view: px from the outline at each node, negative inside.
  struct Seen {
    const vpSimulatedPerson *person;
    cv::Mat_<float> distance;
  };

  double distance(const vpSimulatedPerson &person, const vpHomogeneousMatrix &wMc, double time,
                  const Eigen::Vector2d &pixel) const;
  float shareAt(const vpSimulatedPerson &person, const vpHomogeneousMatrix &wMc, double time,
                const Eigen::Vector2d &pixel) const;

  const vpSensorGrid &m_grid;
  const vpNodeGrid &m_nodes;
  double m_blur;
  double m_sure; // px, farther from the outline than this, everything between two nodes is on the same side
  std::vector<Seen> m_people;
};

END_VISP_NAMESPACE

#endif
