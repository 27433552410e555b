/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLedIdEvidence_h
#define vpLedIdEvidence_h

#include <visp3/vlp_core/vpLampObservation.h>

BEGIN_VISP_NAMESPACE

/*!
  Features of one lamp over several frames: evidence adds up over a track, so that frames decide what one of
  them leaves undecided.

  Lamp and camera share no clock, so each frame measures frequency, duty and phase difference anew, with
  errors of its own: their mean, weighted by inverse variance, is the estimate of all frames. But where edges
  fall between the exposures of lines, this may repeat in frames at a steady rate: the phase
  of a lamp advances by nearly the same share of a line from frame to frame. The frequency error that comes of
  this (all but vpStripeFeatures::frequencyNoise) is taken as common to all frames, the worst case. Errors
  that frames share (the row time's, the oscillator's, the systematic one of a duty) do not shrink by
  repetition; the recogniser adds them, once. A word that frames agree on is wrong only where all of them are.

  \code
  vpLedIdEvidence evidence;               // of one track
  for (vpLampObservation &seen : track) { // one a frame
    evidence.add(seen.features);
    seen.features = evidence.features();
    recognizer.recognize(seen);
  }
  \endcode
*/
class VISP_EXPORT vpLedIdEvidence
{
public:
  double gate = 5; // standard deviations; a frame farther off shows another lamp, and evidence starts again

  //! Whether features have information about an id: not without stripes, of a word not seen whole, with too
  //! few stripes for a frequency.
  static bool tells(const vpStripeFeatures &seen);

  /*!
    \param seen One frame's. Features without information on an id count as no frame.
    \return False where it contradicts what came before, which is then forgotten.
  */
  bool add(const vpStripeFeatures &seen);

  //! Whether a frame may show the lamp that the frames before showed; so may one without such information.
  bool agrees(const vpStripeFeatures &seen) const;

  //! Of all frames together; the last frame's where none had any.
  const vpStripeFeatures &features() const { return m_features; }

  //! Frames that the features rest on.
  unsigned int frames() const { return m_frames; }

  void clear();

private:
  vpStripeFeatures m_features;
  unsigned int m_frames = 0;
  double m_weight = 0; // 1/Hz^2, of the frequencies so far
};

END_VISP_NAMESPACE

#endif
