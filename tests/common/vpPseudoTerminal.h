/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPseudoTerminal_h
#define vpPseudoTerminal_h

#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

//! A serial device without hardware: what is written to its device comes out here, and the other way round.
class vpPseudoTerminal
{
public:
  vpPseudoTerminal() : m_file(posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK))
  {
    if (m_file < 0 || grantpt(m_file) != 0 || unlockpt(m_file) != 0) {
      throw std::runtime_error("no pseudo-terminal");
    }
    m_device = ptsname(m_file);
  }
  //! The one who has the device open sees it hang up.
  ~vpPseudoTerminal() { close(m_file); }
  vpPseudoTerminal(const vpPseudoTerminal &) = delete;
  vpPseudoTerminal &operator=(const vpPseudoTerminal &) = delete;

  const std::string &device() const { return m_device; }

  //! Whether nobody has the device open.
  bool hungUp() const
  {
    pollfd asked = {m_file, 0, 0};
    return poll(&asked, 1, 0) > 0 && (asked.revents & POLLHUP) != 0;
  }

  //! What is there after up to \e milliseconds of waiting for the first byte.
  std::vector<std::uint8_t> readSome(int milliseconds)
  {
    pollfd waited = {m_file, POLLIN, 0};
    std::vector<std::uint8_t> bytes;
    if (poll(&waited, 1, milliseconds) > 0) {
      bytes.resize(4096);
      const ssize_t size = ::read(m_file, bytes.data(), bytes.size());
      bytes.resize(size > 0 ? static_cast<size_t>(size) : 0);
    }
    return bytes;
  }

  //! \e size bytes, fewer where none came for a second.
  std::vector<std::uint8_t> read(size_t size)
  {
    std::vector<std::uint8_t> bytes;
    while (bytes.size() < size) {
      const std::vector<std::uint8_t> more = readSome(1000);
      if (more.empty()) {
        break;
      }
      bytes.insert(bytes.end(), more.begin(), more.end());
    }
    return bytes;
  }

  //! What nobody takes is lost.
  void write(const std::vector<std::uint8_t> &bytes)
  {
    [[maybe_unused]] const ssize_t written = ::write(m_file, bytes.data(), bytes.size());
  }

private:
  int m_file;
  std::string m_device;
};

#endif
