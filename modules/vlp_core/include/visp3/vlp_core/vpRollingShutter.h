/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpRollingShutter_h
#define vpRollingShutter_h

#include <cmath>
#include <vector>

#include <visp3/core/vpCameraParameters.h>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! How the sensor exposes and reads out its lines. A line is a row or a column of the picture, as `readout`
//! says.
struct VISP_EXPORT vpRollingShutter {
  enum class Readout { rows, rowsReversed, columns, columnsReversed };

  double rowTime = 0;       // s from the start of one sensor line to that of the next
  double rowTimeSigma = 0;  // s, standard deviation of rowTime
  double exposure = 0;      // s, of each line
  double exposureSigma = 0; // s, how far it may be off: a share r of it is a factor of 1 + r
  Readout readout = Readout::rows;

  //! Standard deviation of the exposure's logarithm.
  double logExposureSigma() const { return exposure > 0 ? std::log1p(exposureSigma / exposure) : 0; }

  bool alongColumns() const { return readout == Readout::columns || readout == Readout::columnsReversed; }
  bool reversed() const { return readout == Readout::rowsReversed || readout == Readout::columnsReversed; }
};

/*!
  The software that made the delivered picture out of the sensor's: `nearest` as OpenCV's INTER_NEAREST
  (delivered pixel k is sensor pixel floor(k s), s the ratio of the sizes), `area` the mean over s x s sensor
  pixels. All rules for pixel positions under a resize are here.
*/
struct VISP_EXPORT vpPictureResize {
  enum class Method { none, nearest, area };

  Method method = Method::none;
  unsigned int sourceWidth = 0; // pixels of the sensor's picture; unused where method is none
  unsigned int sourceHeight = 0;

  /*!
    Sensor coordinate (pixels, centres at integers) at which delivered pixel \e k of \e delivered in all takes
    its value; \e source is the sensor's number of pixels along the same axis.
  */
  double sensorPosition(unsigned int k, unsigned int delivered, unsigned int source) const;

  /*!
    The affine rule sensor = scale * delivered + offset that a camera model needs. Nearest neighbour has no
    exact one: its uneven steps average to this.
  */
  void sensorAxis(unsigned int delivered, unsigned int source, double &scale, double &offset) const;

  /*!
    Camera parameters of the delivered picture from those of the sensor's full picture: px, py by the scale,
    u0, v0 by the resize's own pixel-centre rule. Distortion coefficients are in normalised units and stay.
  */
  vpCameraParameters delivered(const vpCameraParameters &sensor, unsigned int width,
                               unsigned int height) const;
  //! The way back: those of the sensor's full picture from those of the picture as delivered.
  vpCameraParameters sensor(const vpCameraParameters &delivered, unsigned int width,
                            unsigned int height) const;

  //! A camera with these axes (pixels) and the distortion of \e camera.
  static vpCameraParameters withAxes(vpCameraParameters camera, double px, double py, double u0, double v0);
};

/*!
  When each line of a delivered picture was exposed, and where on the sensor its pixels really are.
  Times are seconds after the frame's time stamp, which is the start of exposure of the sensor's first line.
*/
class VISP_EXPORT vpLineTiming
{
public:
  vpLineTiming() = default;
  //! \e width and \e height are those of the delivered picture, pixels.
  vpLineTiming(const vpRollingShutter &shutter, const vpPictureResize &resize, unsigned int width,
               unsigned int height);

  //! Number of lines: the picture's height, or its width where the readout runs along columns.
  unsigned int lines() const { return static_cast<unsigned int>(m_middle.size()); }

  //! Middle of the exposure of line \e k, k being the row or column number in the picture.
  double middle(unsigned int k) const { return m_middle[k]; }

  //! The same at a sub-pixel line, interpolated; outside the picture, extrapolated.
  double middleAt(double line) const;

  //! Mean time between neighbouring lines of the delivered picture, negative where the readout is reversed.
  double meanLineTime() const;

  //! Exposure of one sensor line, s.
  double exposure() const { return m_exposure; }

  //! Standard deviation of its logarithm.
  double logExposureSigma() const { return m_logExposureSigma; }

  //! Further averaging by an area resize over s sensor lines: length of a box of the same variance,
  //! row time * sqrt(s^2 - 1), s; 0 where there is none.
  double averaging() const { return m_averaging; }

  /*!
    True position of pixel \e k across (`lines`) or along (`samples`) the lines, in delivered pixels: it
    differs from k by up to half a pixel after a nearest-neighbour resize, by less than a tenth after an area
    resize by a ratio that is no whole number, and is k otherwise.
  */
  const std::vector<double> &linePositions() const { return m_linePosition; }
  const std::vector<double> &samplePositions() const { return m_samplePosition; }
  //! Whether each sample lies at its own number.
  bool samplesAligned() const { return m_aligned; }

private:
  std::vector<double> m_middle;
  std::vector<double> m_linePosition;
  std::vector<double> m_samplePosition;
  bool m_aligned = true;
  double m_exposure = 0;
  double m_logExposureSigma = 0;
  double m_lineTime = 0;
  double m_averaging = 0;
};

END_VISP_NAMESPACE

#endif
