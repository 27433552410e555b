/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_core/vpReadFile.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpPrintable.h>

BEGIN_VISP_NAMESPACE

std::string vpReadFile(const std::string &filename)
{
  const auto fail = [&filename](const std::string &problem, int error) {
    throw vpException(vpException::ioError, vpPrintable(filename) + ": " + problem + ": " +
                                                (error == 0 ? std::string("unknown error")
                                                            : std::generic_category().message(error)));
  };
  std::error_code ignored;
  if (std::filesystem::is_directory(filename, ignored)) { // opens without complaint
    fail("cannot be read", EISDIR);
  }
  errno = 0;
  std::ifstream file(filename, std::ios::binary);
  if (!file) {
    fail("cannot be opened", errno);
  }
  std::string bytes;
  std::array<char, 65536>
      piece; // read() keeps an error of the disk for bad(); iterators would throw it, without errno
  do {
    file.read(piece.data(), piece.size());
    bytes.append(piece.data(), static_cast<size_t>(file.gcount()));
  } while (file);
  if (file.bad()) {
    fail("cannot be read", errno);
  }
  return bytes;
}

END_VISP_NAMESPACE
