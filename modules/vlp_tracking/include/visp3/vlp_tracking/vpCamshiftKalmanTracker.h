/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpCamshiftKalmanTracker_h
#define vpCamshiftKalmanTracker_h

#include <memory>
#include <optional>

#include <visp3/vlp_tracking/vpTargetTracker.h>

BEGIN_VISP_NAMESPACE

/*!
  The improved Camshift-Kalman tracker of section 2.1.2 of the paper: Camshift measures where the target is in
  a picture. The Bhattacharyya coefficient of that window and the target sets the measurement noise. A Kalman
  filter of constant velocity makes the estimate of both.

  A target is known by its histogram: of grey values in grey pictures, of hue and saturation in colour
  pictures. Values that are as frequent in its surroundings do not count. In each picture:
  1. The Kalman filter predicts the window.
  2. Mean shift moves it over the back projection of the histogram until it converges.
  3. The Bhattacharyya coefficient rho compares its content with the target. Below \e threshold the eight
     windows around the prediction are tried, and the best one counts. Then comes a search window as large
     as the prediction's uncertainty, which grows from frame to frame while the target is not seen.
  4. Seen, the coefficient becomes the measurement noise, measurementSigma(), of the Kalman filter's
     correction; the window adapts to the size of its content. Where the sighting is as expected, the
     histogram is refreshed slowly. Not seen, the prediction stands, and its variance grows with each frame.

  The paper leaves the process noise open. Here it follows the target: an innovation beyond the variances of
  prediction and measurement raises it, and it decays while there is none. The measurement noise grows, beyond
  rho, where a part seems to be hidden or another target near (vpExpectedAppearance in the sources). So half a
  target at an obstacle's edge, or a similar one that passes, does not pull the estimate along.

  The unit of time is one frame: with a frame dropped, the target seems to jump, which the search covers. A
  target that has left the picture is searched for where it left, half a window outside.

  A target whose histogram is that of its surroundings cannot be told from them; the window then stays about
  where it is, and similarity() means little. Pictures of colours and grey ones are not to be mixed. A window
  that grows or shrinks to more than three times, or less than a third of, its first size stays there.
*/
class VISP_EXPORT vpCamshiftKalmanTracker : public vpTargetTracker
{
public:
  double searchMargin = 0.15;   // on each side of the window, as a share of it, for mean shift
  double convergence = 0.004;   // share of the window, the move at which mean shift stops; 0.2 px at least
  int maxIterations = 15;       // of mean shift
  double threshold = 0.6;       // Bhattacharyya coefficient below which the target is not seen
  double regainThreshold = 0.7; // the same for what is found elsewhere, or after the target was not seen
  double searchGrowth = 1.15;   // of the search window's sides, from frame to frame while not seen
  double noiseFloor = 0.5;      // px, measurement sigma of a perfect likeness
  double noiseScale = 4;        // window sizes, measurement sigma where rho is one half
  double startVelocity = 1;     // window sizes per frame, standard deviation where velocity is not known yet
  double steadiness = 0.005;    // window sizes per frame^2, smallest change of velocity reckoned with
  double sizeRate = 0.2;        // share of a change of size followed in one frame
  double maxSizeChange = 0.05;  // of the window's sides, in one frame
  double refreshThreshold = 0.85; // coefficient, and plausibility, from which the model is refreshed
  double refreshRate = 0.2;       // share of the model replaced at each refresh
  int refreshInterval = 5;        // frames above refreshThreshold

  vpCamshiftKalmanTracker();
  ~vpCamshiftKalmanTracker() override;

  /*!
    Standard deviation of a measured position, px, from the coefficient: ours, since the paper does not give
    its function.
    \f[ \sigma(\rho) = noiseFloor + noiseScale \; s \; \frac{1 - \rho}{\rho} \f]
    with the window's size s, the root of its area; infinite (no correction) below \e threshold. In a
    correction rho is taken relative to its running mean.
  */
  double measurementSigma(double rho) const;

  //! Both \throw vpException notInitialized before initTracking().
  vpImagePoint velocity() const; // px per frame, as estimated
  double positionSigma() const;  // px, of the estimated position

protected:
  Sighting begin(const vpImage<unsigned char> &I, const vpRect &window) override;
  Sighting begin(const vpImage<vpRGBa> &I, const vpRect &window) override;
  Sighting setRight(const vpImage<unsigned char> &I, const vpRect &window) override;
  std::optional<Sighting> seenAt(const vpRect &window) override;
  Sighting follow(const vpImage<unsigned char> &I) override;
  Sighting follow(const vpImage<vpRGBa> &I) override;

private:
  struct Candidate;
  struct Impl;

  template <class Pixel>
  Sighting beginWith(const vpImage<Pixel> &I, const vpRect &window);
  template <class Pixel>
  Sighting followIn(const vpImage<Pixel> &I);

  vpRect predictWindow();
  template <class Pixel>
  Candidate meanShift(const vpImage<Pixel> &I, const vpRect &start);
  template <class Pixel>
  Candidate bestOfEightNeighbours(const vpImage<Pixel> &I, const vpRect &window);
  template <class Pixel>
  Candidate bestOfGrownWindow(const vpImage<Pixel> &I, const vpRect &window);
  void correctBy(const Candidate &seen);
  void correctBy(const vpImagePoint &measured, double sigma);
  void adaptSize(const Candidate &seen);
  template <class Pixel>
  void refreshModel(const vpImage<Pixel> &I, const Candidate &seen);

  std::unique_ptr<Impl> m_impl;
};

END_VISP_NAMESPACE

#endif
