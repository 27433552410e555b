/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_core/vpAtomicFile.h>

#include <atomic>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <locale>
#include <system_error>

#ifdef _WIN32
#include <process.h>
#else
#include <unistd.h>
#endif

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpPrintable.h>

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

/*!
  Knows why the first write failed. A stream only knows that one did, and commit() may come long after it.
*/
class vpAtomicFile::Buffer : public std::filebuf
{
public:
  int error() const { return m_error; }

protected:
  int_type overflow(int_type c) override
  {
    errno = 0;
    const int_type written = std::filebuf::overflow(c);
    keepError(traits_type::eq_int_type(written, traits_type::eof()));
    return written;
  }

  std::streamsize xsputn(const char *bytes, std::streamsize count) override
  {
    errno = 0;
    const std::streamsize written = std::filebuf::xsputn(bytes, count);
    keepError(written < count);
    return written;
  }

private:
  void keepError(bool failed)
  {
    if (failed && m_error == 0) {
      m_error = errno;
    }
  }

  int m_error = 0; // errno
};

vpAtomicFile::vpAtomicFile(const std::string &filename)
    : m_filename(filename), m_target(filename), m_buffer(std::make_unique<Buffer>()), m_stream(m_buffer.get())
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
  if (m_buffer->open(m_written, std::ios::out | std::ios::binary | std::ios::trunc) == nullptr) {
    const int error = errno;
    m_written.clear();
    fail(error);
  }
  m_stream.imbue(std::locale::classic());
}

vpAtomicFile::~vpAtomicFile()
{
  if (!m_written.empty() && m_written != m_target) {
    m_buffer->close();
    std::error_code ignored;
    fs::remove(m_written, ignored);
  }
}

void vpAtomicFile::commit()
{
  if (m_written.empty()) {
    throw vpException(vpException::fatalError, vpPrintable(m_filename) + ": committed twice");
  }
  errno = 0;
  const bool closed = m_buffer->close() != nullptr;
  if (!closed || !m_stream) {
    fail(m_buffer->error() != 0 ? m_buffer->error() : errno);
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
  throw vpException(vpException::ioError, vpPrintable(m_filename) + ": cannot be written: " + reason);
}

END_VISP_NAMESPACE
