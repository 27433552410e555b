/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLedDetector_h
#define vpLedDetector_h

#include <vector>

#include <visp3/detection/vpDetectorBase.h>
#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_core/vpLampObservation.h>
#include <visp3/vlp_core/vpVlpRig.h>
#include <visp3/vlp_detection/vpLedRoiDetector.h>
#include <visp3/vlp_detection/vpOutlineFitter.h>
#include <visp3/vlp_identification/vpExposureEvidence.h>
#include <visp3/vlp_identification/vpLedIdRecognizer.h>
#include <visp3/vlp_identification/vpStripeAnalyzer.h>

BEGIN_VISP_NAMESPACE

/*!
  LED-ID detection and recognition over a whole picture, the paper's section 2.1.1 and 2.1.2: LED-ROI,
  outline, stripe features, id. As every vpDetectorBase it gives each region's corners (of its bounding box,
  or the four of a quadrilateral) and its message (the lamp's id, empty where it is none of the map's).
  getCog() is the mean of the corners; the projection of the lamp's middle is the observation's `point`.

  \code
  vpLedDetector detector(rig, map);
  if (detector.detect(I)) {
    for (const vpLampObservation &lamp : detector.observations()) {
      ...
    }
  }
  \endcode
*/
class VISP_EXPORT vpLedDetector : public vpDetectorBase
{
public:
  vpLedRoiDetector roiDetector;
  vpOutlineFitter outlineFitter;
  vpStripeAnalyzer stripeAnalyzer;
  vpLedIdRecognizer recognizer;
  //! s, what shines on end for longer is steady light. By default as the map and the row time have it.
  double longestPeriod = 0;

  //! \throw vpException where the rig has no picture size.
  vpLedDetector(const vpVlpRig &rig, const vpLampMap &map);

  /*!
    \return True where there is any lamp-like region. Times of the observations count from the start of the
    frame. \throw vpException (dimensionError) where \e I has not the size that the rig states.
  */
  bool detect(const vpImage<unsigned char> &I) override;

  /*!
    The same inside windows only, pixels; those that overlap are looked at as one. A lamp that a window cuts
    is seen whole all the same, and so may be a neighbour. \param known Boxes of what is known already,
    pixels: regions inside are left out. \throw vpException (badValue) where a corner is not finite.
  */
  bool detect(const vpImage<unsigned char> &I, const std::vector<vpRect> &windows,
              const std::vector<vpRect> &known = {});

  /*!
    Finds a lamp again whose identity is known, in a fraction of detect()'s time: fits its outline from the
    expected place and compares its stripes with the known features. \param lamp In: the lamp as last seen,
    with `outline` at the place expected now and `features` of all frames so far. Out, if found: as seen now.
    \return False where it is not there, differs in any respect, or was not seen well enough before; then use
    detect().
  */
  bool reacquire(const vpImage<unsigned char> &I, vpLampObservation &lamp);

  //! \throw vpException (dimensionError) where \e I has not the size that the rig states.
  void check(const vpImage<unsigned char> &I) const;

  //! Every lamp-like region of the last picture, the one with the largest lit area first. Of one
  //! without stripes the outline is its box.
  const std::vector<vpLampObservation> &observations() const { return m_observations; }

  //! Error of the rig's row time, by the lamps of the last picture.
  const vpRowTimeError &rowTimeError() const { return m_rowTimeError; }

  //! Exposure, by the lamps of all pictures so far.
  const vpExposureEvidence &exposure() const { return m_exposure; }

  /*!
    The light inside a lamp's outline, line by line, with the exposure that is known by now: what an
    observation's features come from. Read by vpStripeProfile::along() or agreedByColumns(), whichever the
    features explain better; by along() where they have no phase. Empty where the outline has no line in the
    picture. \param lamp Of that picture. \throw vpException
    (dimensionError) where \e I has not the size that the rig states.
  */
  vpStripeProfile profile(const vpImage<unsigned char> &I, const vpLampObservation &lamp) const;

private:
  struct Region;
  bool observe(const vpLinePicture &picture, const std::vector<vpLedRoi> &rois);
  Region observe(const vpLinePicture &picture, vpLedRoi roi);
  Region observe(const vpLinePicture &picture, const vpLedRoi &roi, bool blinks);
  void read(const vpLinePicture &picture, Region &region) const;
  vpStripeAnalyzer analyzer() const;
  bool isSteady(const vpStripeProfile &profile) const;
  vpStripeFeatures analyzed(vpStripeProfile profile, bool unknownWords) const;
  vpStripeFeatures stripesOf(const vpLinePicture &picture, const vpOutlineFit &fit,
                             const vpLedRoi &roi) const;
  vpStripeFeatures agreedStripes(const vpLinePicture &picture, const vpOutlineFit &fit,
                                 const vpLedRoi &roi) const;
  void shareExposure(const vpLinePicture &picture, std::vector<Region> &regions);
  void recognise(std::vector<Region> &regions);
  double blinkingShare(const vpLinePicture &picture, const Region &region) const;
  void joinPieces(const vpLinePicture &picture, std::vector<Region> &regions);
  void takeApart(const vpLinePicture &picture, std::vector<Region> &regions);
  bool readAround(const vpLinePicture &picture, Region &region) const;
  void complete(const vpLinePicture &picture, std::vector<Region> &regions);
  void completeOne(const vpLinePicture &picture, std::vector<Region> &regions, size_t &i) const;
  void complete(const vpLinePicture &picture, const std::vector<float> &lit,
                const std::vector<cv::Rect> &others, Region &region) const;
  void locate(const vpLinePicture &picture, Region &region) const;
  void place(vpLampObservation &lamp, const vpOutlineFit &fit, bool transposed) const;

  vpVlpRig m_rig;
  vpLineTiming m_timing;
  std::vector<vpLampObservation> m_observations;
  vpRowTimeError m_rowTimeError;
  vpExposureEvidence m_exposure;
  double m_blur = 0; // px, of the latest outline: mostly that of the lens
};

END_VISP_NAMESPACE

#endif
