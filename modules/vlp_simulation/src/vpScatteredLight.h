/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpScatteredLight_h
#define vpScatteredLight_h

#include <vector>

#include <opencv2/core.hpp>
#include <visp3/vlp_simulation/vpRollingShutterRenderer.h>

#include "vpEmitterView.h"
#include "vpNodeGrid.h"

BEGIN_VISP_NAMESPACE

/*!
  Light of the lamps that does not come straight from them: the halo that the lens makes about each, and the
  glow of the ceiling beside it. Both are smooth: known at nodes, linear between them.
*/
class vpScatteredLight
{
public:
  //! \param light At each node: grey value while its lamp is lit all through the exposure.
  struct Lamp {
    const vpEmitter *emitter;
    cv::Mat_<float> light;
  };

  vpScatteredLight(const vpSensorGrid &grid, const vpSimulatedCamera &camera);

  //! The lamps whose scattered light shows. \e wMc: of each line of nodes.
  std::vector<Lamp> of(const std::vector<vpEmitter> &emitters, const vpSimulatedScene &scene,
                       const std::vector<vpHomogeneousMatrix> &wMc) const;

  const vpNodeGrid &nodes() const { return m_nodes; }

private:
  //! At each node.
  cv::Mat_<float> of(const vpEmitter &emitter, const vpSimulatedScene &scene,
                     const std::vector<vpHomogeneousMatrix> &wMc) const;

  const vpSensorGrid &m_grid;
  double m_share;  // of the lens's halo
  double m_radius; // px
  vpNodeGrid m_nodes;
};

END_VISP_NAMESPACE

#endif
