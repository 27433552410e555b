/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpByteTransport_h
#define vpByteTransport_h

#include <cstddef>
#include <cstdint>
#include <string>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  An open line to a board, on which bytes go both ways: a serial device, a USB device, an emulated board.

  Deadlines are times on its clock, now(). A line that is gone (cable pulled, board off) throws vpException
  (ioError) at each use until reopen() has worked. One thread at a time.
*/
class VISP_EXPORT vpByteTransport
{
public:
  virtual ~vpByteTransport() = default;
  vpByteTransport() = default;
  vpByteTransport(const vpByteTransport &) = delete;
  vpByteTransport &operator=(const vpByteTransport &) = delete;

  //! s, of a clock that only goes forward: as it comes std::chrono::steady_clock.
  virtual double now() const;

  //! Sends all bytes. \return False where they were not all taken at \e deadline. \throw vpException
  //! (ioError).
  virtual bool write(const std::uint8_t *bytes, size_t size, double deadline) = 0;

  /*!
    Waits for bytes and takes up to \e most of them. \return How many, 0 where none had come at \e deadline.
    \throw vpException (ioError).
  */
  virtual size_t read(std::uint8_t *bytes, size_t most, double deadline) = 0;

  //! Throws away what has come and has not been read. \throw vpException (ioError).
  virtual void discard() = 0;

  //! Closes the line, if it is open, and opens the same one anew. \throw vpException (ioError).
  virtual void reopen() = 0;

  //! What messages call it: a device's file, a USB device's serial number.
  virtual std::string name() const = 0;
};

END_VISP_NAMESPACE

#endif
