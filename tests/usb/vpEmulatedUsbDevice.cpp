/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "usb/vpEmulatedUsbDevice.h"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <stdexcept>

#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>

namespace
{
constexpr size_t setupSize = 8;
constexpr unsigned int toHost = 0x80; // of an endpoint's address and a request's type

template <class T, class Data>
T *contents(const Data &data)
{
  return reinterpret_cast<T *>(data->data);
}

//! The world of all devices that there are at a time: umockdev knows one for a process.
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
} // namespace

//! A request on its way, in our copy.
struct vpEmulatedUsbDevice::Urb {
  Data data;
  Data buffer;
  const UMockdevIoctlClient *client = nullptr; // the open file that it came by and goes back by
  std::uint64_t address = 0;                   // in the program
  usbdevfs_urb &get() const { return *contents<usbdevfs_urb>(data); }
  unsigned char *bytes() const { return buffer->data; }
};

vpEmulatedUsbDevice::Data vpEmulatedUsbDevice::resolved(UMockdevIoctlData *data, size_t offset, size_t size)
{
  return Data(umockdev_ioctl_data_resolve(data, offset, size, nullptr));
}

vpEmulatedUsbDevice::vpEmulatedUsbDevice(const std::string &descriptors, const std::string &serial,
                                         int megabits)
    : m_descriptors(descriptors), m_serial(serial), m_megabits(megabits), m_testbed(testbed()),
      m_handler(umockdev_ioctl_base_new())
{
  m_descriptors.erase(std::remove(m_descriptors.begin(), m_descriptors.end(), ' '), m_descriptors.end());
  g_signal_connect(m_handler, "handle-ioctl", G_CALLBACK(&vpEmulatedUsbDevice::handle), this);
}

vpEmulatedUsbDevice::~vpEmulatedUsbDevice()
{
  unplug();
  for (const std::string &node : m_nodes) {
    umockdev_testbed_detach_ioctl(m_testbed.get(), node.c_str(), nullptr);
  }
  g_object_unref(m_handler);
  const std::lock_guard<std::mutex> lock(m_mutex); // waits for an answer that is on its way
}

void vpEmulatedUsbDevice::plug(int number)
{
  unplug();
  char name[32];
  std::snprintf(name, sizeof(name), "bus/usb/001/%03d", number);
  {
    const std::lock_guard<std::mutex> lock(m_mutex);
    m_gone = false;
    m_requestsLeft = 0;
    m_node = std::string("/dev/") + name;
    m_path = "/devices/pci0/usb1/1-" + std::to_string(number);
    plugged();
  }
  const std::string text =
      "P: " + m_path + "\nN: " + name + "\nE: SUBSYSTEM=usb\nE: DRIVER=usb\nE: BUSNUM=001\n" +
      "E: DEVNUM=" + (name + 12) + "\nE: DEVNAME=" + m_node +
      "\nE: DEVTYPE=usb_device\nA: bConfigurationValue=1\\n\nA: busnum=1\\n\nA: devnum=" +
      std::to_string(number) + "\\n\nA: speed=" + std::to_string(m_megabits) +
      "\\n\nH: descriptors=" + m_descriptors + "\n";
  const bool answers = m_nodes.count(m_node) > 0 ||
                       umockdev_testbed_attach_ioctl(m_testbed.get(), m_node.c_str(), m_handler, nullptr);
  m_nodes.insert(m_node);
  if (!answers || !umockdev_testbed_add_from_string(m_testbed.get(), text.c_str(), nullptr)) {
    throw std::runtime_error("no emulated USB device; umockdev-wrapper?");
  }
}

void vpEmulatedUsbDevice::unplug()
{
  if (m_node.empty()) {
    return;
  }
  {
    const std::lock_guard<std::mutex> lock(m_mutex);
    lose();
  }
  umockdev_testbed_uevent(m_testbed.get(), ("/sys" + m_path).c_str(), "remove");
  umockdev_testbed_remove_device(m_testbed.get(), ("/sys" + m_path).c_str());
  m_node.clear();
}

void vpEmulatedUsbDevice::lose()
{
  m_gone = true;
  while (!m_waiting.empty()) { // as the kernel ends what is on its way
    finish(std::move(m_waiting.front()), -ESHUTDOWN, 0);
    m_waiting.pop_front();
  }
}

void vpEmulatedUsbDevice::loseAt(int request)
{
  const std::lock_guard<std::mutex> lock(m_mutex);
  m_requestsLeft = request;
}

gboolean vpEmulatedUsbDevice::handle(UMockdevIoctlBase *, UMockdevIoctlClient *client,
                                     vpEmulatedUsbDevice *self)
{
  const std::lock_guard<std::mutex> lock(self->m_mutex);
  const Result result =
      self->answer(umockdev_ioctl_client_get_request(client), umockdev_ioctl_client_get_arg(client), client);
  umockdev_ioctl_client_complete(client, result.error == 0 ? result.value : -1, result.error);
  return TRUE;
}

vpEmulatedUsbDevice::Result vpEmulatedUsbDevice::answer(unsigned long request, UMockdevIoctlData *argument,
                                                        const UMockdevIoctlClient *client)
{
  const auto number = [argument] {
    return *contents<unsigned int>(resolved(argument, 0, sizeof(unsigned int)));
  };
  if (m_requestsLeft > 0 && --m_requestsLeft == 0) {
    lose();
  }
  if (request == USBDEVFS_REAPURB || request == USBDEVFS_REAPURBNDELAY) {
    return reap(argument, client);
  }
  if (m_gone) {
    return {-1, ENODEV};
  }
  switch (request) {
  case USBDEVFS_GET_CAPABILITIES: {
    const Data data = resolved(argument, 0, sizeof(std::uint32_t));
    *contents<std::uint32_t>(data) = USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
    return {0, 0};
  }
  case USBDEVFS_CLAIMINTERFACE:
    return claim(number());
  case USBDEVFS_DISCONNECT_CLAIM:
    return disconnectAndClaim(
        contents<usbdevfs_disconnect_claim>(resolved(argument, 0, sizeof(usbdevfs_disconnect_claim)))
            ->interface);
  case USBDEVFS_RELEASEINTERFACE:
    return release(number());
  case USBDEVFS_IOCTL:
    return ofDriver(argument);
  case USBDEVFS_SUBMITURB:
    return submit(argument, client);
  case USBDEVFS_DISCARDURB:
    return discard(argument);
  default:
    return {-1, ENOTTY};
  }
}

vpEmulatedUsbDevice::Result vpEmulatedUsbDevice::ofDriver(UMockdevIoctlData *argument)
{
  const Data data = resolved(argument, 0, sizeof(usbdevfs_ioctl));
  const usbdevfs_ioctl &asked = *contents<usbdevfs_ioctl>(data);
  return static_cast<unsigned long>(asked.ioctl_code) == USBDEVFS_CONNECT
             ? connectDriver(static_cast<unsigned int>(asked.ifno))
             : Result{-1, ENODATA};
}

vpEmulatedUsbDevice::Result vpEmulatedUsbDevice::connectDriver(unsigned int)
{
  return {0, 0};
}

vpEmulatedUsbDevice::Result vpEmulatedUsbDevice::submit(UMockdevIoctlData *argument,
                                                        const UMockdevIoctlClient *client)
{
  Urb urb;
  urb.client = client;
  urb.data = resolved(argument, 0, sizeof(usbdevfs_urb));
  urb.address = urb.data->client_addr;
  urb.buffer =
      resolved(urb.data.get(), offsetof(usbdevfs_urb, buffer), static_cast<size_t>(urb.get().buffer_length));
  if (urb.get().type == USBDEVFS_URB_TYPE_CONTROL) {
    answerControl(urb);
    return {0, 0};
  }
  if (!mayTransfer() || urb.get().type != USBDEVFS_URB_TYPE_BULK) {
    return {-1, EINVAL};
  }
  const int length = urb.get().buffer_length;
  if ((urb.get().endpoint & toHost) != 0 || !receive({urb.bytes(), urb.bytes() + length})) {
    m_waiting.push_back(std::move(urb));
  } else {
    finish(std::move(urb), 0, length);
  }
  return {0, 0};
}

void vpEmulatedUsbDevice::answerControl(Urb &urb)
{
  const unsigned char *const bytes = urb.bytes();
  const Setup setup = {bytes[0], bytes[1], bytes[2] + 256u * bytes[3], bytes[4] + 256u * bytes[5]};
  const size_t room = static_cast<size_t>(urb.get().buffer_length) - setupSize;
  unsigned char *const body = urb.bytes() + setupSize;
  std::vector<std::uint8_t> data(body, body + room);
  if (setup.type == 0x80 && setup.request == 6 && setup.value == 0x0300) { // string 0: languages
    data = {4, 3, 0x09, 0x04};
  } else if (setup.type == 0x80 && setup.request == 6 && setup.value == 0x0303) {
    data = {static_cast<std::uint8_t>(2 + 2 * m_serial.size()), 3};
    for (const char letter : m_serial) { // UTF-16
      data.insert(data.end(), {static_cast<std::uint8_t>(letter), 0});
    }
  } else if (!control(setup, data)) {
    return finish(std::move(urb), -EPIPE, 0);
  }
  const size_t size = std::min(room, data.size());
  if ((setup.type & toHost) != 0) {
    std::copy_n(data.begin(), size, body);
  }
  finish(std::move(urb), 0, static_cast<int>(size));
}

void vpEmulatedUsbDevice::finish(Urb urb, int status, int length)
{
  urb.get().status = status;
  urb.get().actual_length = length;
  m_done.push_back(std::move(urb));
}

vpEmulatedUsbDevice::Result vpEmulatedUsbDevice::reap(UMockdevIoctlData *argument,
                                                      const UMockdevIoctlClient *client)
{
  const auto reading = std::find_if(m_waiting.begin(), m_waiting.end(), [client](const Urb &urb) {
    return urb.client == client && (urb.get().endpoint & toHost) != 0;
  });
  if (reading != m_waiting.end()) {
    const std::vector<std::uint8_t> packet = send(static_cast<size_t>(reading->get().buffer_length));
    if (!packet.empty()) {
      std::copy(packet.begin(), packet.end(), reading->bytes());
      finish(std::move(*reading), 0, static_cast<int>(packet.size()));
      m_waiting.erase(reading);
    }
  }
  const auto done =
      std::find_if(m_done.begin(), m_done.end(), [client](const Urb &urb) { return urb.client == client; });
  if (done == m_done.end()) {
    return {-1, m_gone ? ENODEV : EAGAIN};
  }
  const Data pointer = resolved(argument, 0, sizeof(void *));
  umockdev_ioctl_data_set_ptr(pointer.get(), 0, done->data.get());
  m_done.erase(done);
  return {0, 0};
}

vpEmulatedUsbDevice::Result vpEmulatedUsbDevice::discard(UMockdevIoctlData *argument)
{
  std::uint64_t address = 0;
  std::memcpy(&address, argument->data, sizeof(void *));
  for (auto urb = m_waiting.begin(); urb != m_waiting.end(); ++urb) {
    if (urb->address == address) {
      finish(std::move(*urb), -ENOENT, 0);
      m_waiting.erase(urb);
      return {0, 0};
    }
  }
  return {-1, EINVAL};
}
