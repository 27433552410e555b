/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// The only file that knows libusb. Without it vpUsbTransportAbsent.cpp takes its place.
#include <visp3/vlp_robot/vpUsbTransport.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <libusb-1.0/libusb.h>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

BEGIN_VISP_NAMESPACE

namespace
{
// CDC-ACM: the control interface takes the line's settings, the data interface carries the bytes.
constexpr int controlInterface = 0, dataInterface = 1;
constexpr unsigned char bulkOut = 0x01, bulkIn = 0x81;
constexpr size_t packetSize = 64;          // bytes, full speed
constexpr std::uint8_t toInterface = 0x21; // class request from host to interface
constexpr std::uint8_t setLineCoding = 0x20, setControlLineState = 0x22;
constexpr std::uint16_t dtr = 1;
constexpr unsigned int controlTimeout = 500; // ms

[[noreturn]] void fail(const std::string &who, const std::string &what, int error)
{
  std::string hint;
  if (error == LIBUSB_ERROR_ACCESS) {
    hint = ", expected permission: a udev rule for 0483:5740, as ROBOTIS' 99-opencr-cdc.rules";
  }
  throw vpException(vpException::ioError, who + ": " + what + ": " + libusb_strerror(error) + hint);
}

void check(int result, const std::string &who, const std::string &what)
{
  if (result < 0) {
    fail(who, what, result);
  }
}

using Context = std::unique_ptr<libusb_context, void (*)(libusb_context *)>;
using Handle = std::unique_ptr<libusb_device_handle, void (*)(libusb_device_handle *)>;

Context makeContext()
{
  libusb_context *context = nullptr;
  check(libusb_init(&context), "opencr:usb", "USB cannot be used");
  return Context(context, libusb_exit);
}

Handle noHandle()
{
  return Handle(nullptr, libusb_close);
}

//! A device as boards() lists it, opened where that was possible.
struct Candidate {
  vpUsbBoard board;
  Handle handle = noHandle();
  int openError = 0;
};

Candidate examine(libusb_device *device, const libusb_device_descriptor &descriptor)
{
  Candidate candidate;
  candidate.board.bus = libusb_get_bus_number(device);
  candidate.board.address = libusb_get_device_address(device);
  libusb_device_handle *handle = nullptr;
  candidate.openError = libusb_open(device, &handle);
  if (candidate.openError != 0) {
    candidate.board.problem = libusb_strerror(candidate.openError);
    return candidate;
  }
  candidate.handle.reset(handle);
  std::array<unsigned char, 128> text;
  const int length =
      libusb_get_string_descriptor_ascii(handle, descriptor.iSerialNumber, text.data(), text.size());
  if (length > 0) {
    candidate.board.serial.assign(text.begin(), text.begin() + length);
  }
  return candidate;
}

//! All attached devices of the board's VID:PID.
std::vector<Candidate> candidates(libusb_context *context)
{
  libusb_device **devices = nullptr;
  const ssize_t count = libusb_get_device_list(context, &devices);
  check(static_cast<int>(count), "opencr:usb", "devices cannot be listed");
  const std::unique_ptr<libusb_device *, void (*)(libusb_device **)> list(
      devices, [](libusb_device **all) { libusb_free_device_list(all, 1); });
  std::vector<Candidate> found;
  for (ssize_t i = 0; i < count; ++i) {
    libusb_device_descriptor descriptor = {};
    if (libusb_get_device_descriptor(devices[i], &descriptor) == 0 &&
        descriptor.idVendor == vpUsbTransport::vendor && descriptor.idProduct == vpUsbTransport::product) {
      found.push_back(examine(devices[i], descriptor));
    }
  }
  return found;
}
//! Those of that serial number, or without one that could be asked; all where \e serial is empty.
std::vector<Candidate> matching(const std::string &serial, std::vector<Candidate> all)
{
  const auto keep = [&all](const std::function<bool(const Candidate &)> &wanted) {
    std::vector<Candidate> kept;
    for (Candidate &one : all) {
      if (wanted(one)) {
        kept.push_back(std::move(one));
      }
    }
    return kept;
  };
  std::vector<Candidate> exact = keep([&](const Candidate &one) {
    return one.openError == 0 && (serial.empty() || one.board.serial == serial);
  });
  return exact.empty() ? keep([](const Candidate &one) { return one.openError != 0; }) : std::move(exact);
}
} // namespace

class vpUsbTransport::Impl
{
public:
  explicit Impl(const std::string &serial) : m_serial(serial) { open(); }
  ~Impl() { close(); }

  void open();
  void close() noexcept;
  void discard();
  std::string name() const { return m_serial.empty() ? "opencr:usb" : "opencr:usb:" + vpShown(m_serial); }
  size_t transfer(unsigned char endpoint, std::uint8_t *bytes, size_t size, double seconds, const char *what);

  std::vector<std::uint8_t> unread; // of the last packet

private:
  void setLine();

  std::string m_serial; // of the device asked for, then of the one that was found
  Context m_context = Context(nullptr, libusb_exit);
  Handle m_handle = noHandle();
  int m_claimed = 0; // interfaces: of two the control interface is the first
};

void vpUsbTransport::Impl::open()
{
  close();
  m_context = makeContext(); // one that knows what is attached now
  std::vector<Candidate> found = matching(m_serial, candidates(m_context.get()));
  if (found.empty()) {
    throw vpException(vpException::ioError,
                      name() + ": no such device attached, expected one of VID:PID 0483:5740" +
                          (m_serial.empty() ? "" : " and that serial number"));
  }
  if (found.size() > 1) {
    std::string serials;
    for (const Candidate &one : found) {
      serials += " opencr:usb:" + vpShown(one.board.serial);
    }
    throw vpException(vpException::ioError, name() + ": " + std::to_string(found.size()) +
                                                " devices attached, expected one of:" + serials);
  }
  check(found[0].openError, name(), "cannot be opened");
  m_serial = found[0].board.serial;
  m_handle = std::move(found[0].handle);
  try {
    libusb_set_auto_detach_kernel_driver(m_handle.get(), 1);
    for (const int interface : {controlInterface, dataInterface}) {
      check(libusb_claim_interface(m_handle.get(), interface), name(), "is in use");
      ++m_claimed;
    }
    setLine();
    discard(); // answers to whoever had it before
  } catch (...) {
    close();
    throw;
  }
}

void vpUsbTransport::Impl::setLine()
{
  std::array<unsigned char, 7> coding = {0x40, 0x42, 0x0F, 0x00,
                                         0,    0,    8}; // 1 000 000, 1 stop bit, no parity, 8
  check(libusb_control_transfer(m_handle.get(), toInterface, setLineCoding, 0, controlInterface,
                                coding.data(), coding.size(), controlTimeout),
        name(), "does not take 1000000 baud");
  check(libusb_control_transfer(m_handle.get(), toInterface, setControlLineState, dtr, controlInterface,
                                nullptr, 0, controlTimeout),
        name(), "does not take DTR");
}

//! Gives the device back as it was. What fails here fails because it is gone.
void vpUsbTransport::Impl::close() noexcept
{
  unread.clear();
  if (m_claimed == 2) {
    libusb_control_transfer(m_handle.get(), toInterface, setControlLineState, 0, controlInterface, nullptr, 0,
                            controlTimeout);
    // The kernel's driver binds to the control interface and takes the data interface with it: that one must
    // be free by then.
    libusb_release_interface(m_handle.get(), dataInterface);
  }
  if (m_claimed > 0) {
    libusb_release_interface(m_handle.get(), controlInterface);
    libusb_attach_kernel_driver(m_handle.get(), controlInterface); // also where a killed process detached it
  }
  m_claimed = 0;
  m_handle.reset();
}

//! One bulk transfer. \return The bytes that went, 0 where none did within \e seconds.
size_t vpUsbTransport::Impl::transfer(unsigned char endpoint, std::uint8_t *bytes, size_t size,
                                      double seconds, const char *what)
{
  if (!m_handle) {
    throw vpException(vpException::ioError, name() + ": is not open, expected a device attached");
  }
  const unsigned int timeout =
      static_cast<unsigned int>(std::max(std::ceil(seconds * 1e3), 1.0)); // 0: for ever
  int done = 0;
  const int result =
      libusb_bulk_transfer(m_handle.get(), endpoint, bytes, static_cast<int>(size), &done, timeout);
  if (result < 0 && result != LIBUSB_ERROR_TIMEOUT && result != LIBUSB_ERROR_INTERRUPTED) {
    fail(name(), what, result);
  }
  return static_cast<size_t>(done);
}

void vpUsbTransport::Impl::discard()
{
  unread.clear();
  std::array<std::uint8_t, packetSize> packet;
  for (int most = 256; most > 0; --most) { // a device that never falls silent is none of ours
    if (transfer(bulkIn, packet.data(), packet.size(), 1e-3, "cannot be read from") == 0) {
      return;
    }
  }
}

vpUsbTransport::vpUsbTransport(const std::string &serial) : m_impl(std::make_unique<Impl>(serial)) {}

vpUsbTransport::~vpUsbTransport() = default;

std::vector<vpUsbBoard> vpUsbTransport::boards()
{
  const Context context = makeContext();
  std::vector<vpUsbBoard> boards;
  for (const Candidate &one : candidates(context.get())) {
    boards.push_back(one.board);
  }
  return boards;
}

bool vpUsbTransport::write(const std::uint8_t *bytes, size_t size, double deadline)
{
  std::vector<std::uint8_t> copy(bytes, bytes + size); // libusb takes no const
  for (size_t sent = 0; sent < size;) {
    const double left = deadline - now();
    const size_t done =
        m_impl->transfer(bulkOut, copy.data() + sent, size - sent, left, "cannot be written to");
    sent += done;
    if (sent < size && now() >= deadline) {
      return false;
    }
  }
  return true;
}

size_t vpUsbTransport::read(std::uint8_t *bytes, size_t most, double deadline)
{
  std::vector<std::uint8_t> &unread = m_impl->unread;
  while (unread.empty()) {
    // One packet at a time: a transfer of several would wait for more where the last one is full.
    unread.resize(packetSize);
    unread.resize(
        m_impl->transfer(bulkIn, unread.data(), packetSize, deadline - now(), "cannot be read from"));
    if (unread.empty() && now() >= deadline) {
      return 0;
    }
  }
  const size_t size = std::min(most, unread.size());
  std::copy_n(unread.begin(), size, bytes);
  unread.erase(unread.begin(), unread.begin() + static_cast<std::ptrdiff_t>(size));
  return size;
}

void vpUsbTransport::discard()
{
  m_impl->discard();
}

void vpUsbTransport::reopen()
{
  m_impl->open();
}

std::string vpUsbTransport::name() const
{
  return m_impl->name();
}

END_VISP_NAMESPACE
