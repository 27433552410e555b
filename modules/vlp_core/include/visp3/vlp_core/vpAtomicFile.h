/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpAtomicFile_h
#define vpAtomicFile_h

#include <memory>
#include <ostream>
#include <string>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  A text file that appears whole or not at all: written under a temporary name in the same folder, renamed by
  commit(), removed where it is destroyed uncommitted. A name that exists and is no regular file (/dev/stdout,
  a pipe) is written directly, a symbolic link is followed.

  \code
  vpAtomicFile file("poses.tum");
  file.stream() << vpNumberText(timestamp) << "\n";
  file.commit();
  \endcode
*/
class VISP_EXPORT vpAtomicFile
{
public:
  //! \throw vpException (ioError) with one line that names the file where it cannot be written.
  explicit vpAtomicFile(const std::string &filename);
  ~vpAtomicFile();
  vpAtomicFile(const vpAtomicFile &) = delete;
  vpAtomicFile &operator=(const vpAtomicFile &) = delete;

  //! In the classic locale.
  std::ostream &stream() { return m_stream; }

  //! Closes the file and gives it its name. \throw vpException (ioError) where anything of it could not be
  //! written.
  void commit();

private:
  class Buffer;

  [[noreturn]] void fail(int error);

  std::string m_filename; // as given, for messages
  std::string m_target;   // where links lead
  std::string m_written;  // name under which it is being written; empty once committed
  std::unique_ptr<Buffer> m_buffer;
  std::ostream m_stream; // into the buffer
};

END_VISP_NAMESPACE

#endif
