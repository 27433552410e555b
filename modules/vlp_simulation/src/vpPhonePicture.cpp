/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpPhonePicture.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

BEGIN_VISP_NAMESPACE

namespace
{
constexpr float white = 255;

void expectField(const char *field, double came, double least, double most)
{
  if (!(came >= least && came <= most)) {
    throw vpException(vpException::badValue, std::string("simulated camera: ") + field + ": " +
                                                 vpNumberText(came) + ", expected a number from " +
                                                 vpNumberText(least) + " to " + vpNumberText(most));
  }
}

/*!
  Noise of standard deviation 1 whose correlation is a Gaussian of sqrt(2) times \e width (px): such is colour
  that a demosaic spread over the cells of its mosaic, two pixels wide.
*/
cv::Mat_<float> sharedNoise(const cv::Size &size, std::uint64_t seed)
{
  static const double width = 1.5;
  cv::RNG random(seed * 0x9e3779b97f4a7c15ULL + 0x2545f4914f6cdd1dULL); // another than that of the readout
  cv::Mat_<float> noise(size);
  random.fill(noise, cv::RNG::NORMAL, 0, 1);
  const cv::Mat kernel = cv::getGaussianKernel(9, width, CV_32F);
  cv::sepFilter2D(noise, noise, CV_32F, kernel, kernel);
  return noise / kernel.dot(kernel); // what is left of the standard deviation
}
} // namespace

vpPhonePicture::vpPhonePicture(const vpSimulatedCamera &camera)
    : m_chromaNoise(camera.chromaNoise), m_clipped(camera.clippedChannels), m_gamma(camera.toneCurve),
      m_sharpening(camera.sharpening), m_jpegQuality(camera.jpegQuality)
{
  expectField("chroma noise, grey levels", m_chromaNoise, 0, 255);
  expectField("clipped channels", m_clipped, 0, 0.3);
  expectField("tone curve", m_gamma, 0.2, 5);
  expectField("sharpening", m_sharpening, 0, 10);
  expectField("JPEG quality", m_jpegQuality, 0, 100);
}

/*!
  Clipping and tone curve. Grey is 0.587 green and 0.413 of the others. Green that clips by a share c earlier
  is grey / (1 - c), the others are what is left of the grey value; each ends at white.
*/
float vpPhonePicture::toned(float grey) const
{
  static const double green = 0.587; // of luma, ITU-R BT.601
  const double light = std::max(0.f, grey);
  const double strong = light / (1 - m_clipped), weak = (light - green * strong) / (1 - green);
  const double clipped =
      green * std::min<double>(white, strong) + (1 - green) * std::min<double>(white, weak);
  return static_cast<float>(m_gamma == 1 ? clipped : white * std::pow(clipped / white, 1 / m_gamma));
}

cv::Mat_<unsigned char> vpPhonePicture::of(cv::Mat_<float> picture, std::uint64_t seed) const
{
  if (m_chromaNoise > 0) {
    picture += m_chromaNoise * sharedNoise(picture.size(), seed);
  }
  if (m_clipped > 0 || m_gamma != 1 || m_sharpening > 0) {
    for (float &value : picture) {
      value = toned(value);
    }
  }
  if (m_sharpening > 0) {
    cv::Mat_<float> soft;
    cv::GaussianBlur(picture, soft, cv::Size(), 1);
    picture += m_sharpening * (picture - soft);
  }
  cv::Mat_<unsigned char> rounded;
  picture.convertTo(rounded, CV_8U);
  if (m_jpegQuality > 0) {
    std::vector<unsigned char> file;
    cv::imencode(".jpg", rounded, file, {cv::IMWRITE_JPEG_QUALITY, m_jpegQuality});
    cv::imdecode(file, cv::IMREAD_GRAYSCALE).copyTo(rounded);
  }
  return rounded;
}

END_VISP_NAMESPACE
