/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpSerialTransport_h
#define vpSerialTransport_h

#include <visp3/vlp_robot/vpByteTransport.h>

BEGIN_VISP_NAMESPACE

/*!
  A serial device, 8N1, raw, no flow control, for this process alone. For an OpenCR board on USB it is the
  kernel's /dev/ttyACM0, which sets DTR and RTS as it opens the line; RTS is cleared at once, for it arms the
  board's jump into its bootloader.
*/
class VISP_EXPORT vpSerialTransport : public vpByteTransport
{
public:
  //! \param baud One of termios' speeds. \throw vpException (ioError) where the device cannot be opened, is
  //! none, or is in use.
  explicit vpSerialTransport(const std::string &device, unsigned int baud = 1000000);
  ~vpSerialTransport() override;

  bool write(const std::uint8_t *bytes, size_t size, double deadline) override;
  size_t read(std::uint8_t *bytes, size_t most, double deadline) override;
  void discard() override;
  void reopen() override;
  std::string name() const override { return m_device; }

private:
  void open();
  void setRaw();
  void close() noexcept;
  bool wait(short events, double deadline) const;
  [[noreturn]] void fail(const std::string &what, int error) const;

  std::string m_device;
  unsigned int m_baud;
  int m_file = -1;
};

END_VISP_NAMESPACE

#endif
