/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpOutlineTracker_h
#define vpOutlineTracker_h

#include <memory>

#include <visp3/vlp_core/vpLampObservation.h>
#include <visp3/vlp_core/vpRollingShutter.h>
#include <visp3/vlp_detection/vpLedRoiDetector.h>
#include <visp3/vlp_detection/vpOutlineFitter.h>

BEGIN_VISP_NAMESPACE

/*!
  The outline of a lamp that was seen before, fitted by vpOutlineFitter's model from where it is expected. It
  takes a fraction of vpOutlineFitter's time, and finds only a sharp ellipse that lies wholly in the picture
  and has about its former axes and blur.
*/
class VISP_EXPORT vpOutlineTracker
{
public:
  vpOutlineTracker();
  ~vpOutlineTracker();
  vpOutlineTracker(const vpOutlineTracker &) = delete;
  vpOutlineTracker &operator=(const vpOutlineTracker &) = delete;

  //! Whether an outline was seen well enough to be found in this way. \param blur px, of its edge.
  static bool suits(const vpLampOutline &outline, double blur);

  /*!
    \param expected Where the outline is expected, samples and lines of \e picture. \param blur px, that it
    had. \param shapeSigma As vpOutlineFitter::shapeSigma. \return Whether it is there; then fit() is the
    result.
  */
  bool find(const vpLinePicture &picture, const vpLineTiming &timing, const vpLampOutline &expected,
            double blur, double shapeSigma);

  const vpOutlineFit &fit() const { return m_fit; }

private:
  struct Memory;
  std::unique_ptr<Memory> m_memory; // kept from fit to fit
  vpOutlineFit m_fit;
};

END_VISP_NAMESPACE

#endif
