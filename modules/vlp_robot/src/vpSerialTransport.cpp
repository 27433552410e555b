/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_robot/vpSerialTransport.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <ctime>

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

BEGIN_VISP_NAMESPACE

vpSerialTransport::vpSerialTransport(const std::string &device, unsigned int baud)
    : m_device(device), m_baud(baud)
{
  open();
}

vpSerialTransport::~vpSerialTransport()
{
  close();
}

void vpSerialTransport::open()
{
  m_file = ::open(m_device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (m_file < 0) {
    fail("cannot be opened", errno);
  }
  try {
    setRaw();
  } catch (...) {
    close();
    throw;
  }
}

void vpSerialTransport::setRaw()
{
  if (!isatty(m_file)) {
    fail("is no serial device", 0);
  }
  // The lock keeps out other programs that take one, those of root too; TIOCEXCL all others.
  if (flock(m_file, LOCK_EX | LOCK_NB) != 0 || ioctl(m_file, TIOCEXCL) != 0) {
    fail("is in use by another program", errno == EWOULDBLOCK ? 0 : errno);
  }
  termios settings = {};
  if (tcgetattr(m_file, &settings) != 0) {
    fail("gives no settings", errno);
  }
  cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(CRTSCTS | CSTOPB);
  settings.c_cc[VMIN] = 0;
  settings.c_cc[VTIME] = 0;
  if (cfsetspeed(&settings, m_baud) != 0 || tcsetattr(m_file, TCSANOW, &settings) != 0) {
    fail("does not take " + std::to_string(m_baud) + " baud", errno);
  }
  const int rts = TIOCM_RTS;
  ioctl(m_file, TIOCMBIC, &rts); // a pseudo-terminal has no such line
  tcflush(m_file, TCIOFLUSH);
}

void vpSerialTransport::close() noexcept
{
  if (m_file >= 0) {
    ioctl(m_file, TIOCNXCL); // else who holds it open beside us would keep it from us
    ::close(m_file);
    m_file = -1;
  }
}

void vpSerialTransport::reopen()
{
  close();
  open();
}

bool vpSerialTransport::write(const std::uint8_t *bytes, size_t size, double deadline)
{
  while (size > 0) {
    if (!wait(POLLOUT, deadline)) {
      return false;
    }
    const ssize_t written = ::write(m_file, bytes, size);
    if (written < 0 && errno != EAGAIN && errno != EINTR) {
      fail("cannot be written to", errno);
    }
    if (written <= 0 && now() >= deadline) { // though it was said to be ready
      return false;
    }
    const size_t taken = static_cast<size_t>(std::max<ssize_t>(written, 0));
    bytes += taken;
    size -= taken;
  }
  return true;
}

size_t vpSerialTransport::read(std::uint8_t *bytes, size_t most, double deadline)
{
  while (wait(POLLIN, deadline)) {
    const ssize_t size = ::read(m_file, bytes, most);
    if (size > 0) {
      return static_cast<size_t>(size);
    }
    if (size == 0) { // though it was said to be ready
      fail("is gone", 0);
    }
    if (errno != EAGAIN && errno != EINTR) {
      fail("is gone", errno);
    }
    if (now() >= deadline) { // though it was said to be ready
      break;
    }
  }
  return 0;
}

void vpSerialTransport::discard()
{
  if (m_file < 0 || tcflush(m_file, TCIFLUSH) != 0) {
    fail("is gone", m_file < 0 ? 0 : errno);
  }
}

//! Whether it is ready for \e events before \e deadline.
bool vpSerialTransport::wait(short events, double deadline) const
{
  if (m_file < 0) {
    fail("is not open", 0);
  }
  for (;;) {
    const double left = std::max(deadline - now(), 0.0);
    const double seconds = std::floor(left);
    const timespec timeout = {static_cast<time_t>(seconds), static_cast<long>((left - seconds) * 1e9)};
    pollfd waited = {m_file, events, 0};
    const int ready = ppoll(&waited, 1, &timeout, nullptr);
    if (ready < 0 && errno != EINTR) {
      fail("cannot be waited for", errno);
    }
    if (ready > 0 && (waited.revents & events) == 0) { // it hung up
      fail("is gone", 0);
    }
    if (ready > 0) {
      return true;
    }
    if (ready == 0) {
      return false;
    }
  }
}

void vpSerialTransport::fail(const std::string &what, int error) const
{
  throw vpException(vpException::ioError,
                    vpShown(m_device) + ": " + what +
                        (error != 0 ? std::string(" (") + std::strerror(error) + ")" : std::string()) +
                        ", expected a serial device with a board on it");
}

END_VISP_NAMESPACE
