/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// In place of vpUsbTransport.cpp where libusb is missing.
#include <visp3/vlp_robot/vpUsbTransport.h>

#include <visp3/core/vpException.h>

BEGIN_VISP_NAMESPACE

namespace
{
[[noreturn]] void refuse()
{
  throw vpException(vpException::ioError,
                    "opencr:usb: this build has no libusb; install libusb-1.0-0-dev and "
                    "build anew, or use opencr:/dev/ttyACM0");
}
} // namespace

class vpUsbTransport::Impl
{
};

vpUsbTransport::vpUsbTransport(const std::string &)
{
  refuse();
}

vpUsbTransport::~vpUsbTransport() = default;

std::vector<vpUsbBoard> vpUsbTransport::boards()
{
  refuse();
}

bool vpUsbTransport::write(const std::uint8_t *, size_t, double)
{
  refuse();
}

size_t vpUsbTransport::read(std::uint8_t *, size_t, double)
{
  refuse();
}

void vpUsbTransport::discard()
{
  refuse();
}

void vpUsbTransport::reopen()
{
  refuse();
}

std::string vpUsbTransport::name() const
{
  return "opencr:usb";
}

END_VISP_NAMESPACE
