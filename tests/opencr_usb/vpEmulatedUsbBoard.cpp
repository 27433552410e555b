/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "opencr_usb/vpEmulatedUsbBoard.h"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <deque>
#include <stdexcept>
#include <vector>

#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <umockdev.h>

namespace
{
constexpr unsigned char bulkOut = 0x01, bulkIn = 0x81;
constexpr size_t packetSize = 64, setupSize = 8;

// CDC-ACM of VID:PID 0483:5740: device, configuration, control interface with its interrupt endpoint 0x82,
// data interface with bulk endpoints 0x01 and 0x81. The device descriptor's last byte but one is the serial's
// index.
const std::string deviceDescriptor = "12010002020000408304405700020102";
const std::string configuration = "090243000201 00C032"
                                  "0904000001020201 00"
                                  "0524001001 0524010001 04240202 0524060001"
                                  "07058203080010"
                                  "09040100020A000000"
                                  "07050102400000 07058102400000";

std::string withoutBlanks(std::string text)
{
  text.erase(std::remove(text.begin(), text.end(), ' '), text.end());
  return text;
}

struct Unref {
  void operator()(UMockdevIoctlData *data) const { umockdev_ioctl_data_unref(data); }
};
using Data = std::unique_ptr<UMockdevIoctlData, Unref>;

Data resolved(UMockdevIoctlData *data, size_t offset, size_t size)
{
  return Data(umockdev_ioctl_data_resolve(data, offset, size, nullptr));
}

template <class T>
T *contents(const Data &data)
{
  return reinterpret_cast<T *>(data->data);
}

//! The world of all boards that there are at a time: umockdev knows one for a process.
std::shared_ptr<UMockdevTestbed> testbed()
{
  static std::weak_ptr<UMockdevTestbed> world;
  std::shared_ptr<UMockdevTestbed> shared = world.lock();
  if (!shared) {
    shared.reset(umockdev_testbed_new(), [](UMockdevTestbed *one) { g_object_unref(one); });
    world = shared;
  }
  return shared;
}

//! A request on its way, in our copy.
struct Urb {
  Data data;
  Data buffer;
  std::uint64_t address = 0; // in the program
  usbdevfs_urb &get() const { return *contents<usbdevfs_urb>(data); }
  unsigned char *bytes() const { return buffer->data; }
};
} // namespace

class vpEmulatedUsbBoard::Impl
{
public:
  Impl(vpRealTimeBoard &board, const std::string &serial)
      : m_board(board), m_serial(serial), m_testbed(testbed()), m_handler(umockdev_ioctl_base_new())
  {
    g_signal_connect(m_handler, "handle-ioctl", G_CALLBACK(&Impl::handle), this);
  }
  ~Impl()
  {
    unplug();
    g_object_unref(m_handler);
  }

  void plug(int number);
  void unplug();

  mutable std::mutex mutex;
  State state;

private:
  struct Result {
    long value;
    int error;
  };

  static gboolean handle(UMockdevIoctlBase *, UMockdevIoctlClient *client, Impl *self);
  Result answer(unsigned long request, UMockdevIoctlData *argument);
  Result claim(unsigned int interface);
  Result release(unsigned int interface);
  Result connectDriver(UMockdevIoctlData *argument);
  Result submit(UMockdevIoctlData *argument);
  void control(Urb &urb);
  Result reap(UMockdevIoctlData *argument);
  Result discard(UMockdevIoctlData *argument);
  void finish(Urb urb, int status, int length);

  vpRealTimeBoard &m_board;
  std::string m_serial;
  std::shared_ptr<UMockdevTestbed> m_testbed;
  UMockdevIoctlBase *m_handler;
  std::string m_node;        // /dev/bus/usb/..., empty while unplugged
  std::string m_path;        // in sysfs
  std::deque<Urb> m_reading; // bulk in, waiting for the board
  std::deque<Urb> m_done;    // to be reaped
};

void vpEmulatedUsbBoard::Impl::plug(int number)
{
  unplug();
  char name[32];
  std::snprintf(name, sizeof(name), "bus/usb/001/%03d", number);
  {
    const std::lock_guard<std::mutex> lock(mutex);
    state = State();
    m_node = std::string("/dev/") + name;
    m_path = "/devices/pci0/usb1/1-" + std::to_string(number);
  }
  const std::string text =
      "P: " + m_path + "\nN: " + name + "\nE: SUBSYSTEM=usb\nE: DRIVER=usb\nE: BUSNUM=001\n" +
      "E: DEVNUM=" + (name + 12) + "\nE: DEVNAME=" + m_node +
      "\nE: DEVTYPE=usb_device\nA: bConfigurationValue=1\\n\nA: busnum=1\\n\nA: devnum=" +
      std::to_string(number) + "\\n\nA: speed=12\\n\nH: descriptors=" + withoutBlanks(deviceDescriptor) +
      (m_serial.empty() ? "00" : "03") + "01" + withoutBlanks(configuration) + "\n";
  if (!umockdev_testbed_attach_ioctl(m_testbed.get(), m_node.c_str(), m_handler, nullptr) ||
      !umockdev_testbed_add_from_string(m_testbed.get(), text.c_str(), nullptr)) {
    throw std::runtime_error("no emulated USB device; umockdev-wrapper?");
  }
}

void vpEmulatedUsbBoard::Impl::unplug()
{
  if (m_node.empty()) {
    return;
  }
  {
    const std::lock_guard<std::mutex> lock(mutex);
    state.unplugged = true;
    while (!m_reading.empty()) { // as the kernel ends what is on its way
      finish(std::move(m_reading.front()), -ESHUTDOWN, 0);
      m_reading.pop_front();
    }
  }
  umockdev_testbed_uevent(m_testbed.get(), ("/sys" + m_path).c_str(), "remove");
  umockdev_testbed_remove_device(m_testbed.get(), ("/sys" + m_path).c_str());
  umockdev_testbed_detach_ioctl(m_testbed.get(), m_node.c_str(), nullptr);
  m_node.clear();
}

gboolean vpEmulatedUsbBoard::Impl::handle(UMockdevIoctlBase *, UMockdevIoctlClient *client, Impl *self)
{
  const std::lock_guard<std::mutex> lock(self->mutex);
  const Result result =
      self->answer(umockdev_ioctl_client_get_request(client), umockdev_ioctl_client_get_arg(client));
  umockdev_ioctl_client_complete(client, result.error == 0 ? result.value : -1, result.error);
  return TRUE;
}

vpEmulatedUsbBoard::Impl::Result vpEmulatedUsbBoard::Impl::answer(unsigned long request,
                                                                  UMockdevIoctlData *argument)
{
  const auto number = [argument] {
    return *contents<unsigned int>(resolved(argument, 0, sizeof(unsigned int)));
  };
  if (request == USBDEVFS_REAPURB || request == USBDEVFS_REAPURBNDELAY) {
    return reap(argument);
  }
  if (state.unplugged) {
    return {-1, ENODEV};
  }
  switch (request) {
  case USBDEVFS_GET_CAPABILITIES: {
    const Data data = resolved(argument, 0, sizeof(std::uint32_t));
    *contents<std::uint32_t>(data) = USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
    return {0, 0};
  }
  case USBDEVFS_CLAIMINTERFACE:
    return state.owner[number() & 1] == Owner::nobody ? claim(number()) : Result{-1, EBUSY};
  case USBDEVFS_DISCONNECT_CLAIM:
    return claim(contents<usbdevfs_disconnect_claim>(resolved(argument, 0, sizeof(usbdevfs_disconnect_claim)))
                     ->interface);
  case USBDEVFS_RELEASEINTERFACE:
    return release(number());
  case USBDEVFS_IOCTL:
    return connectDriver(argument);
  case USBDEVFS_SUBMITURB:
    return submit(argument);
  case USBDEVFS_DISCARDURB:
    return discard(argument);
  default:
    return {-1, ENOTTY};
  }
}

//! cdc_acm has both interfaces or none: without the one it lets go of the other.
vpEmulatedUsbBoard::Impl::Result vpEmulatedUsbBoard::Impl::claim(unsigned int interface)
{
  if (interface > 1) {
    return {-1, EINVAL};
  }
  if (state.owner[interface] == Owner::program) {
    return {-1, EBUSY};
  }
  if (state.owner[interface] == Owner::kernel) {
    state.owner = {Owner::nobody, Owner::nobody};
  }
  state.owner[interface] = Owner::program;
  ++state.claims;
  return {0, 0};
}

vpEmulatedUsbBoard::Impl::Result vpEmulatedUsbBoard::Impl::release(unsigned int interface)
{
  if (interface > 1 || state.owner[interface] != Owner::program) {
    return {-1, EINVAL};
  }
  state.owner[interface] = Owner::nobody;
  return {0, 0};
}

//! USBDEVFS_CONNECT has the kernel look for a driver: cdc_acm takes the control interface, and the other with
//! it.
vpEmulatedUsbBoard::Impl::Result vpEmulatedUsbBoard::Impl::connectDriver(UMockdevIoctlData *argument)
{
  const Data data = resolved(argument, 0, sizeof(usbdevfs_ioctl));
  const usbdevfs_ioctl &asked = *contents<usbdevfs_ioctl>(data);
  if (static_cast<unsigned long>(asked.ioctl_code) != USBDEVFS_CONNECT || asked.ifno > 1) {
    return {-1, EINVAL};
  }
  if (state.owner[static_cast<size_t>(asked.ifno)] != Owner::nobody) {
    return {-1, EBUSY};
  }
  if (asked.ifno == 1 || state.owner[1] != Owner::nobody) {
    return {0, 0}; // no driver took it
  }
  state.owner = {Owner::kernel, Owner::kernel};
  return {1, 0};
}

vpEmulatedUsbBoard::Impl::Result vpEmulatedUsbBoard::Impl::submit(UMockdevIoctlData *argument)
{
  Urb urb;
  urb.data = resolved(argument, 0, sizeof(usbdevfs_urb));
  urb.address = urb.data->client_addr;
  urb.buffer =
      resolved(urb.data.get(), offsetof(usbdevfs_urb, buffer), static_cast<size_t>(urb.get().buffer_length));
  if (urb.get().type == USBDEVFS_URB_TYPE_CONTROL) {
    control(urb);
    return {0, 0};
  }
  if (state.owner[1] != Owner::program || urb.get().type != USBDEVFS_URB_TYPE_BULK) {
    return {-1, EINVAL};
  }
  if (urb.get().endpoint == bulkIn || state.stalled) {
    m_reading.push_back(std::move(urb));
  } else {
    const int length = urb.get().buffer_length;
    m_board.receive({urb.bytes(), urb.bytes() + length});
    finish(std::move(urb), 0, length);
  }
  return {0, 0};
}

void vpEmulatedUsbBoard::Impl::control(Urb &urb)
{
  const unsigned char *const setup = urb.bytes();
  unsigned char *const data = urb.bytes() + setupSize;
  const unsigned int type = setup[0], request = setup[1], value = setup[2] + 256u * setup[3];
  const size_t room = static_cast<size_t>(urb.get().buffer_length) - setupSize;
  std::vector<unsigned char> reply;
  if (type == 0x80 && request == 6 && value == 0x0300) { // string descriptor 0: languages
    reply = {4, 3, 0x09, 0x04};
  } else if (type == 0x80 && request == 6 && value == 0x0303) {
    reply = {static_cast<unsigned char>(2 + 2 * m_serial.size()), 3};
    for (const char letter : m_serial) { // UTF-16
      reply.insert(reply.end(), {static_cast<unsigned char>(letter), 0});
    }
  } else if (type == 0x21 && request == 0x20 && room == state.lineCoding.size()) {
    std::copy_n(data, room, state.lineCoding.begin());
    return finish(std::move(urb), 0, static_cast<int>(room));
  } else if (type == 0x21 && request == 0x22) {
    state.dtr = (value & 1) != 0;
    state.rts = (value & 2) != 0;
    state.rtsRaised += state.rts;
    return finish(std::move(urb), 0, 0);
  } else {
    return finish(std::move(urb), -EPIPE, 0);
  }
  const size_t size = std::min(room, reply.size());
  std::copy_n(reply.begin(), size, data);
  finish(std::move(urb), 0, static_cast<int>(size));
}

void vpEmulatedUsbBoard::Impl::finish(Urb urb, int status, int length)
{
  urb.get().status = status;
  urb.get().actual_length = length;
  m_done.push_back(std::move(urb));
}

vpEmulatedUsbBoard::Impl::Result vpEmulatedUsbBoard::Impl::reap(UMockdevIoctlData *argument)
{
  if (!m_reading.empty() && state.dtr && !state.stalled) { // nothing leaves the board without DTR
    const std::vector<std::uint8_t> packet =
        m_board.send(std::min(packetSize, static_cast<size_t>(m_reading.front().get().buffer_length)));
    if (!packet.empty()) {
      std::copy(packet.begin(), packet.end(), m_reading.front().bytes());
      finish(std::move(m_reading.front()), 0, static_cast<int>(packet.size()));
      m_reading.pop_front();
    }
  }
  if (m_done.empty()) {
    return {-1, state.unplugged ? ENODEV : EAGAIN};
  }
  const Data pointer = resolved(argument, 0, sizeof(void *));
  umockdev_ioctl_data_set_ptr(pointer.get(), 0, m_done.front().data.get());
  m_done.pop_front();
  return {0, 0};
}

vpEmulatedUsbBoard::Impl::Result vpEmulatedUsbBoard::Impl::discard(UMockdevIoctlData *argument)
{
  std::uint64_t address = 0;
  std::memcpy(&address, argument->data, sizeof(void *));
  for (auto urb = m_reading.begin(); urb != m_reading.end(); ++urb) {
    if (urb->address == address) {
      finish(std::move(*urb), -ENOENT, 0);
      m_reading.erase(urb);
      return {0, 0};
    }
  }
  return {-1, EINVAL};
}

vpEmulatedUsbBoard::vpEmulatedUsbBoard(vpRealTimeBoard &board, const std::string &serial)
    : m_impl(std::make_unique<Impl>(board, serial))
{
}

vpEmulatedUsbBoard::~vpEmulatedUsbBoard() = default;

void vpEmulatedUsbBoard::plug(int number)
{
  m_impl->plug(number);
}

void vpEmulatedUsbBoard::unplug()
{
  m_impl->unplug();
}

vpEmulatedUsbBoard::State vpEmulatedUsbBoard::state() const
{
  const std::lock_guard<std::mutex> lock(m_impl->mutex);
  return m_impl->state;
}

void vpEmulatedUsbBoard::setState(const State &state)
{
  const std::lock_guard<std::mutex> lock(m_impl->mutex);
  m_impl->state = state;
}
