/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpEmulatedUsbDevice_h
#define vpEmulatedUsbDevice_h

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include <umockdev.h>

/*!
  A USB device under umockdev: what the kernel's usbfs would answer, as far as libusb asks for it. Its hooks
  are called with the mutex held, from a thread of umockdev's. The program has to run under umockdev-wrapper.
*/
class vpEmulatedUsbDevice
{
public:
  virtual ~vpEmulatedUsbDevice();

  //! As device \e number of bus 1.
  void plug(int number);
  void unplug();
  //! It is gone from the program's request of that number on, the next one being 1, before anybody is told.
  void loseAt(int request);

protected:
  //! Not plugged in. \param descriptors Device and configuration, hexadecimal with blanks, the strings'
  //! indices 1, 2 and (serial number; 0 where \e serial is empty) 3. \param megabits Of its speed.
  vpEmulatedUsbDevice(const std::string &descriptors, const std::string &serial, int megabits);

  //! What an ioctl returns, or its errno.
  struct Result {
    long value;
    int error;
  };
  struct Setup {
    unsigned int type, request, value, index;
  };

  virtual void plugged() {}
  virtual Result claim(unsigned int interface) = 0;
  //! Without a look at whom it belongs to.
  virtual Result disconnectAndClaim(unsigned int interface) { return claim(interface); }
  virtual Result release(unsigned int interface) = 0;
  //! The kernel's driver may have the interface again. \return value 1 where there is one.
  virtual Result connectDriver(unsigned int interface);
  //! \param data What came, or as long as what may go, to be replaced. \return False: stalled.
  virtual bool control(const Setup &setup, std::vector<std::uint8_t> &data) = 0;
  virtual bool mayTransfer() const = 0; // the interface of the bulk endpoints is claimed
  //! \return False: the device does not take it now.
  virtual bool receive(const std::vector<std::uint8_t> &data) = 0;
  //! Bulk in, \e room at most; empty where there is nothing yet.
  virtual std::vector<std::uint8_t> send(size_t room) = 0;

  mutable std::mutex m_mutex;

private:
  struct Unref {
    void operator()(UMockdevIoctlData *data) const { umockdev_ioctl_data_unref(data); }
  };
  using Data = std::unique_ptr<UMockdevIoctlData, Unref>;
  struct Urb;

  static gboolean handle(UMockdevIoctlBase *, UMockdevIoctlClient *client, vpEmulatedUsbDevice *self);
  static Data resolved(UMockdevIoctlData *data, size_t offset, size_t size);
  void lose();
  Result answer(unsigned long request, UMockdevIoctlData *argument, const UMockdevIoctlClient *client);
  Result ofDriver(UMockdevIoctlData *argument);
  Result submit(UMockdevIoctlData *argument, const UMockdevIoctlClient *client);
  void answerControl(Urb &urb);
  Result reap(UMockdevIoctlData *argument, const UMockdevIoctlClient *client);
  Result discard(UMockdevIoctlData *argument);
  void finish(Urb urb, int status, int length);

  std::string m_descriptors;
  std::string m_serial;
  int m_megabits;
  std::shared_ptr<UMockdevTestbed> m_testbed;
  UMockdevIoctlBase *m_handler;
  std::string m_node;            // /dev/bus/usb/..., empty while unplugged
  std::string m_path;            // in sysfs
  std::set<std::string> m_nodes; // whose ioctls are answered: programs may still hold one that is gone
  bool m_gone = true;
  int m_requestsLeft = 0;    // until it is lost; 0: it is not
  std::deque<Urb> m_waiting; // bulk, for the device
  std::deque<Urb> m_done;    // to be reaped
};

#endif
