/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampReacquisition_h
#define vpLampReacquisition_h

#include <vector>

#include <visp3/vlp_core/vpLampObservation.h>
#include <visp3/vlp_core/vpRollingShutter.h>
#include <visp3/vlp_detection/vpLedRoiDetector.h>
#include <visp3/vlp_detection/vpOutlineTracker.h>

#include "vpStripeCheck.h"

BEGIN_VISP_NAMESPACE

/*!
  Quick check of a lamp that was fully recognised before: its outline is fitted from where it is expected, and
  its stripes are compared with those it had. A lamp that differs in any respect is not found here, and is
  left to vpLedDetector's full detection.
*/
class vpLampReacquisition
{
public:
  //! Whether a lamp was seen well enough to be reacquired.
  static bool suits(const vpLampObservation &before);

  /*!
    \param before Its outline (samples and lines of \e picture) is where the lamp is expected. \return Whether
    it is there and the same: then fit() says where, and `area` how many pixels of it are lit.
  */
  bool find(const vpLinePicture &picture, const vpLineTiming &timing, const vpLampObservation &before,
            double shapeSigma);
  const vpOutlineFit &fit() const { return m_outline.fit(); }
  double area() const { return m_area; }

private:
  void readProfile(const vpLinePicture &picture, const vpLineTiming &timing);
  bool sameStripes(const vpLinePicture &picture, const vpLineTiming &timing, const vpStripeFeatures &before);

  vpOutlineTracker m_outline; // kept for their memory: this,
  vpStripeProfile m_profile;
  std::vector<double> m_lengths; // px, of its lines inside the outline
  vpStripeCheck m_check;
  double m_area = 0; // px
};

END_VISP_NAMESPACE

#endif
