/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpTargetTracker_h
#define vpTargetTracker_h

#include <memory>
#include <optional>

#include <visp3/core/vpColor.h>
#include <visp3/core/vpImage.h>
#include <visp3/core/vpImagePoint.h>
#include <visp3/core/vpRGBa.h>
#include <visp3/core/vpRect.h>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  Follows one target from picture to picture, whatever the method.

  Pixel centres lie at integers, as everywhere in ViSP: a window with left 10 and width 4 holds the columns 10
  to 13, and its middle is 11.5. The unit of time is one frame.
*/
class VISP_EXPORT vpTargetTracker
{
public:
  enum class Method {
    camshiftKalman, // vpCamshiftKalmanTracker
    dot2,           // vpDot2Tracker
    meEllipse       // vpMeEllipseTracker
  };

  //! A tracker of that kind with its default settings.
  static std::unique_ptr<vpTargetTracker> make(Method method);

  virtual ~vpTargetTracker() = default;

  /*!
    Begins with the target that fills \e window.
    \throw vpException badValue: the window is smaller than 4x4 px, reaches out of the picture, or shows
    nothing that this method can follow.
  */
  void initTracking(const vpImage<unsigned char> &I, const vpRect &window);
  void initTracking(const vpImage<vpRGBa> &I, const vpRect &window);

  /*!
    Goes on to the next picture. Returns whether the target was seen in it.
    \throw vpException notInitialized: before initTracking(); dimensionError: a picture of another size than
    that of initTracking(); badValue: a grey picture where that one was of colours, or the other way around,
    where the method minds.
  */
  bool track(const vpImage<unsigned char> &I);
  bool track(const vpImage<vpRGBa> &I);

  /*!
    Corrects the target's place in the picture last given to track(): another detector found that it fills
    \e window there. Its motion so far is kept where the method knows it.
    \throw vpException as initTracking() and track().
  */
  void correct(const vpImage<unsigned char> &I, const vpRect &window);

  /*!
    Goes on to the next picture without processing it: another detector found that the target fills
    \e window there. False where the method cannot do so; then call track() with the picture.
    \throw vpException notInitialized: before initTracking().
  */
  bool goOn(const vpRect &window);

  //! The part inside the picture of the estimated window; predicted where the target was not seen. Its width
  //! and height are 0 where nothing of it is inside.
  vpRect window() const;

  //! The middle of the whole estimated window, which lies outside the picture where most of the window does.
  vpImagePoint center() const { return m_estimate.getCenter(); }

  //! Similarity of the best candidate in the last picture to the target: 0 (none) to 1.
  double similarity() const { return m_similarity; }

  void display(const vpImage<unsigned char> &I, const vpColor &color, unsigned int thickness = 1) const;
  void display(const vpImage<vpRGBa> &I, const vpColor &color, unsigned int thickness = 1) const;

protected:
  //! Result of a method for one picture.
  struct Sighting {
    vpRect window; // whole, in the picture or not
    double similarity = 0;
    bool seen = false;
  };

  vpTargetTracker() = default;
  vpTargetTracker(const vpTargetTracker &) = default;
  vpTargetTracker &operator=(const vpTargetTracker &) = default;

  // A method that knows no colours sees the grey values of a colour picture.
  virtual Sighting begin(const vpImage<unsigned char> &I, const vpRect &window) = 0;
  virtual Sighting begin(const vpImage<vpRGBa> &I, const vpRect &window);
  virtual Sighting setRight(const vpImage<unsigned char> &I, const vpRect &window)
  {
    return begin(I, window);
  }
  virtual std::optional<Sighting> seenAt(const vpRect &) { return std::nullopt; }
  virtual Sighting follow(const vpImage<unsigned char> &I) = 0;
  virtual Sighting follow(const vpImage<vpRGBa> &I);

private:
  void checkBegun() const;
  template <class Pixel>
  void checkTracked(const vpImage<Pixel> &I) const;
  template <class Pixel>
  void beginChecked(const vpImage<Pixel> &I, const vpRect &window);
  template <class Pixel>
  bool followChecked(const vpImage<Pixel> &I);

  vpImage<unsigned char> m_grey; // of a colour picture
  unsigned int m_width = 0;      // px, of the pictures; 0 before initTracking()
  unsigned int m_height = 0;     // px
  vpRect m_estimate;
  double m_similarity = 0;
};

END_VISP_NAMESPACE

#endif
