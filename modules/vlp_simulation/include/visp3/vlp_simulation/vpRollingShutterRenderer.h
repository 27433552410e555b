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

  // What a phone in a hand does, nothing as it comes; vpRollingShutterRenderer has the order.
  double handBlur = 0;        // px, length of the straight smear; its direction is drawn for each frame
  double chromaNoise = 0;     // grey levels, standard deviation of noise that neighbouring pixels share
  double clippedChannels = 0; // share by which green clips before the grey value is white, 0 to 0.3
  double toneCurve = 1;       // gamma: the grey value is 255 (light / 255)^(1 / gamma), 0.2 to 5
  double sharpening = 0;      // strength of an unsharp mask: times what a blur of 1 px takes away
  int jpegQuality = 0;        // 1 to 100; 0: no compression
};

/*!
  Draws what a rolling-shutter camera sees of blinking lamps.

  Each line integrates each lamp's light over its own exposure window in closed form (vpLampLight) and sees
  the lamp from where the camera is at the mean time of that light. A lamp's share of a pixel is that of the
  pixel's square, blurred, on the lamp's own outline: its edge is taken as straight with its curvature as a
  correction of second order; of a disc of few pixels, or whose tips bend sharply, chords are summed. Glow of
  the ceiling and halo of the lens are smooth and interpolated between nodes. Photon noise is Gaussian of the
  same variance. Then come saturation, 8 bits and the resize that the rig states.

  An emission pattern that is not even is the mean of its brightness over 89 points of the pixel's blurred
  square, those inside the outline; its error is 3 % of a jump in brightness at most, and a grey level or less
  where the pattern is smooth over a few pixels.

  A phone's picture comes of these steps, in this order: blur of lens and hand; exposure; noise of photons,
  readout and chroma; clipping of the channels; tone curve; sharpening; rounding to 8 bits; JPEG; the resize
  that the rig states. The hand smears what the lens shows, not the stripes, which come of time: each line is
  the mean of what cameras turned by up to half the smear either way see with that line's own exposure. Steps
  that know neighbours (chroma noise, sharpening, JPEG) have those of the pixels that are drawn: after a
  nearest-neighbour resize the pixels that remain.
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

  //! The same before noise, saturation and all that follows, grey values; without the blur of the hand.
  cv::Mat_<float> exact(const vpSimulatedScene &scene, const Poses &wMc, double timestamp) const;

private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};

END_VISP_NAMESPACE

#endif
