/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpRollingShutterRenderer_h
#define vpRollingShutterRenderer_h

#include <cstdint>
#include <functional>
#include <memory>

#include <opencv2/core.hpp>
#include <visp3/core/vpHomogeneousMatrix.h>
#include <visp3/core/vpImage.h>
#include <visp3/vlp_core/vpVlpRig.h>
#include <visp3/vlp_simulation/vpSimulatedScene.h>

BEGIN_VISP_NAMESPACE

//! A camera as it truly is. Pixels are those of the sensor, before any resize.
struct VISP_EXPORT vpSimulatedCamera {
  vpVlpRig rig;           // true parameters, shutter, resize and mount
  double blur = 0.7;      // px, standard deviation of the lens's blur
  double haloShare = 0;   // of a lamp's light that the lens scatters about it
  double haloRadius = 30; // px, standard deviation of that scatter
  double vignetting =
      0; // exponent n of cos^n(angle off the optical axis); 4: the natural one of a simple lens
  double readNoise = 1; // grey levels, standard deviation
  double photonsPerLevel =
      40; // electrons per grey level: their number varies by its square root. 0: no such noise
};

/*!
  Draws what a rolling-shutter camera sees of blinking lamps.

  Each line integrates each lamp's light over its own exposure window in closed form (vpLampLight) and sees
  the lamp from where the camera is at the mean time of that light. A lamp's share of a pixel is that of the
  pixel's square, blurred, on the lamp's own outline: its edge is taken as straight with its curvature as a
  correction of second order; of a disc of few pixels, or whose tips bend sharply, chords are summed. Glow of
  the ceiling and halo of the lens are smooth and interpolated between nodes. Photon noise is Gaussian of the
  same variance. Then come saturation, 8 bits and the resize that the rig states.
*/
class VISP_EXPORT vpRollingShutterRenderer
{
public:
  //! Camera in the map, wMc, at a time of the run, s.
  using Poses = std::function<vpHomogeneousMatrix(double)>;

  //! \throw vpException (badValue) with one line that names what is out of its range.
  explicit vpRollingShutterRenderer(const vpSimulatedCamera &camera);
  ~vpRollingShutterRenderer();
  vpRollingShutterRenderer(const vpRollingShutterRenderer &) = delete;
  vpRollingShutterRenderer &operator=(const vpRollingShutterRenderer &) = delete;

  /*!
    The picture whose sensor's first line begins its exposure at \e timestamp, s. \param seed Of the noise;
    the same seed gives the same bytes. \throw vpException (badValue) where a lamp's size is unknown or a
    person has no path.
  */
  void render(const vpSimulatedScene &scene, const Poses &wMc, double timestamp, std::uint64_t seed,
              vpImage<unsigned char> &I) const;

  //! The same before noise, saturation and rounding, grey values.
  cv::Mat_<float> exact(const vpSimulatedScene &scene, const Poses &wMc, double timestamp) const;

private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};

END_VISP_NAMESPACE

#endif
