/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLampBoard_h
#define vpLampBoard_h

#include <memory>
#include <string>

#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_robot/vpByteTransport.h>

BEGIN_VISP_NAMESPACE

/*!
  A controller with the firmware of apps/lamp-firmware at the other end of a line: one line of text asks, one
  line answers.
*/
class vpLampBoard
{
public:
  /*!
    Waits until it answers: an Arduino starts anew when its port is opened. \throw vpException (ioError) where
    none does.
  */
  explicit vpLampBoard(std::unique_ptr<vpByteTransport> line);

  //! What it sends: `name=value`, parted by blanks. \throw vpException (ioError).
  std::string show();

  /*!
    Tells it to blink as a lamp of a map does, and reads that back. \return What it sends now. \throw
    vpException (ioError, badValue) where it refuses, or sends something else.
  */
  std::string set(const vpLamp &lamp);

  //! The line that tells it. \throw vpException (badValue) where the map does not say all.
  static std::string lineOf(const vpLamp &lamp);

  //! The number behind \e name in what it sends; NaN: none.
  static double valueOf(const std::string &sent, const std::string &name);

private:
  std::string ask(const std::string &line, double seconds);
  std::string answered(const std::string &line, double seconds);
  [[noreturn]] void fail(const std::string &what) const;

  std::unique_ptr<vpByteTransport> m_line;
};

END_VISP_NAMESPACE

#endif
