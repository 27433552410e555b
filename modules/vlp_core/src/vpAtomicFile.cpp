/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_core/vpAtomicFile.h>

#include <atomic>
#include <cerrno>
#include <filesystem>
#include <locale>
#include <system_error>

#ifdef _WIN32
#include <process.h>
#else
#include <unistd.h>
#endif

#include <visp3/core/vpException.h>

BEGIN_VISP_NAMESPACE

namespace
{
namespace fs = std::filesystem;

//! Differs between processes and between files of one process.
std::string temporarySuffix()
{
  static std::atomic<unsigned int> count{0};
#ifdef _WIN32
  const int process = _getpid();
#else
  const int process = static_cast<int>(getpid());
#endif
  return ".part-" + std::to_string(process) + "-" + std::to_string(count++);
}
} // namespace

vpAtomicFile::vpAtomicFile(const std::string &filename) : m_filename(filename), m_target(filename)
{
  std::error_code ignored;
  const fs::file_status status = fs::status(filename, ignored);
  if (fs::is_directory(status)) {
    fail(EISDIR);
  }
  if (fs::exists(status) && fs::is_symlink(fs::symlink_status(filename, ignored))) {
    const fs::path target = fs::canonical(filename, ignored);
    m_target = target.empty() ? filename : target.string();
  }
  const bool direct = fs::exists(status) && !fs::is_regular_file(status);
  m_written = direct ? m_target : m_target + temporarySuffix();
  errno = 0;
  m_stream.open(m_written, std::ios::binary | std::ios::trunc);
  if (!m_stream) {
    const int error = errno;
    m_written.clear();
    fail(error);
  }
  m_stream.imbue(std::locale::classic());
}

vpAtomicFile::~vpAtomicFile()
{
  if (!m_written.empty() && m_written != m_target) {
    m_stream.close();
    std::error_code ignored;
    fs::remove(m_written, ignored);
  }
}

void vpAtomicFile::commit()
{
  if (m_written.empty()) {
    throw vpException(vpException::fatalError, m_filename + ": committed twice");
  }
  errno = 0;
  m_stream.close();
  if (!m_stream) {
    fail(errno);
  }
  std::error_code error;
  if (m_written != m_target) {
    fs::rename(m_written, m_target, error);
  }
  if (error) {
    fail(error.value());
  }
  m_written.clear();
}

void vpAtomicFile::fail(int error)
{
  const std::string reason =
      error == 0 ? std::string("unknown error") : std::generic_category().message(error);
  throw vpException(vpException::ioError, m_filename + ": cannot be written: " + reason);
}

END_VISP_NAMESPACE
