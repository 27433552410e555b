/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_sensor/vpWritePicture.h>

#include <filesystem>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpAtomicFile.h>

BEGIN_VISP_NAMESPACE

void vpWritePicture(const std::string &name, const cv::Mat &picture)
{
  std::vector<unsigned char> bytes;
  bool encoded = false;
  try {
    encoded = cv::imencode(std::filesystem::path(name).extension().string(), picture, bytes);
  } catch (const cv::Exception &error) {
    if (error.code == cv::Error::StsNoMem) {
      throw;
    }
  }
  if (!encoded) {
    throw vpException(vpException::ioError, name + ": the picture cannot be encoded");
  }
  vpAtomicFile file(name);
  file.stream().write(reinterpret_cast<const char *>(bytes.data()),
                      static_cast<std::streamsize>(bytes.size()));
  file.commit();
}

END_VISP_NAMESPACE
