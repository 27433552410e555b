/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampObservation_h
#define vpLampObservation_h

#include <array>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <visp3/core/vpCameraParameters.h>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  The outline of a lamp in the picture, pixels. Ellipse: the points
  (u, v) = centre + cos(t) a (cos angle, sin angle) + sin(t) b (-sin angle, cos angle), a >= b.
  Quadrilateral: four corners in order around it. Region: nothing but a bounding box was found.
*/
struct VISP_EXPORT vpLampOutline {
  enum class Shape { region, ellipse, quadrilateral };

  Shape shape = Shape::region;
  Eigen::Vector2d centre =
      Eigen::Vector2d::Zero(); // of the ellipse; crossing of the diagonals; middle of the box
  double a = 0;                // semi-axes; of a region half its longer and shorter side
  double b = 0;
  double angle = 0; // rad, from u to the major axis, towards v
  std::array<Eigen::Vector2d, 4> corners{{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero(),
                                          Eigen::Vector2d::Zero(),
                                          Eigen::Vector2d::Zero()}}; // quadrilateral and region
  Eigen::Matrix2d centreCovariance = Eigen::Matrix2d::Zero();        // px^2
  double residual = 0;     // px, root mean square of edge points about the outline
  double otherShape = 0.5; // probability of being the other of ellipse and quadrilateral; 0.5: not compared

  //! Mean diameter of an ellipse, mean side of a quadrilateral or region, pixels.
  double diameter() const;
  //! Bounding box: left, top, right, bottom, pixels.
  Eigen::Vector4d box() const;

  /*!
    Projection of the lamp's middle, in pixels. For an ellipse its own middle is not that point: the lamp's
    circle, in a plane of normal \e cNormal (camera frame, any length), has its middle at the pole of the
    plane's vanishing line with respect to the conic, c = C^-1 n in normalised coordinates. A quadrilateral's
    is the crossing of its diagonals. Distortion: both are worked out on undistorted outline points, and the
    pixel is the one that vpPixelMeterConversion takes to the middle's ray (ViSP's kud and kdu are no exact
    inverses of each other). A region, a plane seen edge-on and a degenerate outline give the centre.
  */
  Eigen::Vector2d middle(const vpCameraParameters &camera, const Eigen::Vector3d &cNormal) const;
};

//! What of each line of the picture lies inside an outline, which has to outlast it.
class VISP_EXPORT vpOutlineLines
{
public:
  explicit vpOutlineLines(const vpLampOutline &outline);
  //! The part of the line v = \e v that lies inside, from \e first to \e last, px. False: none.
  bool stretch(double v, double &first, double &last) const;

private:
  const vpLampOutline &m_outline;
  // Of an ellipse: how far the stretch's middle moves from line to line, and the square of its half length on
  // the line of the centre, and what it loses with the square of the distance from there.
  double m_slope = 0, m_square = 0, m_loss = 0;
};

//! A lamp's frequency under the assumption of one duty.
struct VISP_EXPORT vpDutySlice {
  double duty = 0;
  double frequency = 0;      // Hz
  double frequencySigma = 0; // Hz, with that duty
  double chiSquare = 0;      // of the stripes with that duty, beyond the least
};

//! Features measured from the stripes of one lamp: those of the paper, and the frequency itself.
struct VISP_EXPORT vpStripeFeatures {
  //! coded: strongly modulated, yet neither pwm nor twoPulse explains the stripes: a word.
  enum class Signal { unmodulated, pwm, twoPulse, coded };

  Signal signal = Signal::unmodulated;
  unsigned int stripes = 0;                                         // bright stripes
  double area = 0;                                                  // px of the lamp's region
  double frequency = std::numeric_limits<double>::quiet_NaN();      // Hz, at which the signal repeats
  double frequencySigma = std::numeric_limits<double>::quiet_NaN(); // Hz, standard deviation of the estimate
                                                                    // alone, row time exact
  double frequencyBound =
      std::numeric_limits<double>::quiet_NaN(); // Hz, frequencySigma if no edge fell between two exposures
  double frequencyNoise =
      std::numeric_limits<double>::quiet_NaN(); // Hz, the part of frequencySigma that is noise, independent
                                                // in each frame; NaN: all of it
  double duty = std::numeric_limits<double>::quiet_NaN(); // lit share of the period
  double dutySigma = std::numeric_limits<double>::quiet_NaN();
  double dutyClipped = 0; // the part of it that lines at the grey scale's end leave, alike in all frames
  /*!
    Frequencies by duty, the shortest first, where they are known together only: near simple fractions of the
    rate of lines a short pulse may stay within one line over the whole lamp. Empty elsewhere.
  */
  std::vector<vpDutySlice> alongDuty;
  double phaseDifference = std::numeric_limits<double>::quiet_NaN(); // periods, twoPulse only
  double phaseDifferenceSigma = std::numeric_limits<double>::quiet_NaN();
  double phase = std::numeric_limits<double>::quiet_NaN(); // periods, from the start of a pulse (twoPulse:
                                                           // the first) to that of the frame; not of a word
  double exposure = std::numeric_limits<double>::quiet_NaN(); // s, by the softness of the stripes' edges
  double exposureSigma = std::numeric_limits<double>::quiet_NaN();
  /*!
    Of a coded signal that was seen for one whole repetition or more: its chips, '1' lit, in the order of
    time, of all rotations the lexicographically greatest (the stripes do not show where the word begins). One
    chip lasts 1 / (frequency * chips.size()). Empty where the word is not known.
  */
  std::string chips;
  double chipsConfidence = 0; // probability that all of them are right
  double modulation = 0;      // depth of the stripes, 0 to 1
  double misfit = 0;          // share of the stripes' power that the chosen signal leaves unexplained
};

//! An identifier of the map that a lamp-like region may show.
struct VISP_EXPORT vpLedIdCandidate {
  size_t identifier = 0;  // index into vpLampMap::identifiers()
  double probability = 0; // that the region is a lamp of it
};

/*!
  One lamp-like region of one frame: the interface between detection and localization.
*/
struct VISP_EXPORT vpLampObservation {
  vpLampOutline outline;
  Eigen::Vector2d point = Eigen::Vector2d::Zero();      // px, projection of the lamp's middle
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero(); // px^2, of point
  double time = 0;  // s, on the frame's clock: middle of the exposure of the line through point
  bool cut = false; // the picture's border cuts the lamp
  double blur = 0;  // px, standard deviation of the spread of its edge; 0: it has none
  double noise = 0; // grey levels, of pixels about its edge, standard deviation
  double blinking =
      1; // share of the light inside its outline that has the modulation of its features; 0: none
  vpStripeFeatures features;
  std::vector<vpLedIdCandidate> candidates; // the likeliest first
  std::string id;                           // of the map's lamp; empty: none of them, or more than one
  double confidence = 0;  // probability of that id; without an id, of being none of the map's lamps
  unsigned int track = 0; // number of the lamp that was followed from frame to frame; 0: none
  bool accepted = false;  // counts for the position
  std::string remark;     // why it has no id or does not count; else empty
};

END_VISP_NAMESPACE

#endif
