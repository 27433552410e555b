/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_sensor/vpReadGreyPicture.h>

#include <limits>

#include <opencv2/imgcodecs.hpp>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpPrintable.h>
#include <visp3/vlp_core/vpReadFile.h>

#include "vpGreyOf.h"

BEGIN_VISP_NAMESPACE

namespace
{
unsigned int byteAt(const std::string &bytes, size_t i)
{
  return static_cast<unsigned char>(bytes[i]);
}

bool beginsWith(const std::string &bytes, const std::string &signature)
{
  return bytes.compare(0, signature.size(), signature) == 0;
}

const std::string jpegSignature("\xff\xd8\xff", 3);
const std::string pngSignature("\x89PNG\r\n\x1a\n", 8);

/*!
  Whether a JPEG has its end marker, behind the picture itself: an embedded preview has one too, and cameras
  append things behind theirs. ITU T.81, annex B.
*/
bool isWholeJpeg(const std::string &bytes)
{
  constexpr unsigned int stuffed = 0x00, temporary = 0x01, restart0 = 0xd0, startOfImage = 0xd8,
                         endOfImage = 0xd9, fill = 0xff;
  // What is not 0xff is coded data.
  for (size_t i = bytes.find('\xff', 2); i < bytes.size() - 1; i = bytes.find('\xff', i)) {
    const unsigned int marker = byteAt(bytes, i + 1);
    if (marker == stuffed || marker == fill) {
      ++i;
      continue;
    }
    if (marker == endOfImage) {
      return true;
    }
    i += 2;
    if (marker == temporary || (marker >= restart0 && marker <= startOfImage)) {
      continue; // these have no length
    }
    if (i + 1 >= bytes.size()) {
      return false;
    }
    i += byteAt(bytes, i) * 256 + byteAt(bytes, i + 1);
  }
  return false;
}

//! Whether a PNG's chunks reach its IEND. ISO/IEC 15948, clause 5.
bool isWholePng(const std::string &bytes)
{
  constexpr size_t frame = 12; // length, name and checksum of a chunk
  size_t i = pngSignature.size();
  while (i + frame <= bytes.size()) {
    if (bytes.compare(i + 4, 4, "IEND") == 0) {
      return true;
    }
    size_t length = 0;
    for (size_t k = 0; k < 4; ++k) {
      length = length * 256 + byteAt(bytes, i + k);
    }
    i += frame + length;
  }
  return false;
}

//! Whether OpenCV would give it to GDCM, which ends the program where it is damaged. DICOM PS3.10,
//! clause 7.1.
bool isDicom(const std::string &bytes)
{
  constexpr size_t preamble = 128;
  return bytes.size() > preamble && bytes.compare(preamble, 4, "DICM") == 0;
}

[[noreturn]] void fail(const std::string &filename, const std::string &problem)
{
  throw vpException(vpException::ioError, vpPrintable(filename) + ": " + problem);
}
} // namespace

void vpReadGreyPicture(const std::string &filename, vpImage<unsigned char> &I)
{
  const std::string bytes = vpReadFile(filename);
  if (bytes.empty()) {
    fail(filename, "an empty file, expected a picture");
  }
  if (bytes.size() > static_cast<size_t>(std::numeric_limits<int>::max())) {
    fail(filename, "a file of more than 2 GB, expected a picture");
  }
  if ((beginsWith(bytes, jpegSignature) && !isWholeJpeg(bytes)) ||
      (beginsWith(bytes, pngSignature) && !isWholePng(bytes))) {
    fail(filename, "the picture is cut short");
  }
  if (isDicom(bytes)) {
    fail(filename, "a DICOM file, expected a picture of another format, such as PNG or JPEG");
  }

  cv::Mat picture;
  try {
    const cv::Mat encoded(1, static_cast<int>(bytes.size()), CV_8UC1, const_cast<char *>(bytes.data()));
    picture = cv::imdecode(encoded, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception &error) {
    fail(filename, "the picture cannot be read: " + error.err);
  }
  if (picture.empty()) {
    fail(filename, "no picture that OpenCV can read, or a damaged one");
  }
  if (picture.depth() != CV_8U && picture.depth() != CV_16U) {
    fail(filename,
         "pixels of type " + cv::typeToString(picture.depth()) + ", expected 8 or 16 bits (CV_8U, CV_16U)");
  }
  vpGreyOf(picture, I);
}

END_VISP_NAMESPACE
