/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpFrameSource_h
#define vpFrameSource_h

#include <cstddef>
#include <string>

#include <visp3/vlp_core/vpVlpFrame.h>

BEGIN_VISP_NAMESPACE

/*!
  Where frames come from: pictures, a video, a camera, the simulator.

  \code
  vpVlpFrame frame;
  for (bool more = true; more;) {
    try {
      more = source.next(frame);
    } catch (const vpException &error) { // about one frame; the rest is still to come
      std::cerr << error.getStringMessage() << std::endl;
      continue;
    }
    ...
  }
  \endcode
*/
class VISP_EXPORT vpFrameSource
{
public:
  virtual ~vpFrameSource() = default;

  /*!
    Reads the next frame. \return False at the end; \e frame is then left alone.
    \throw vpException with one line that names the file where one frame cannot be read; the next call goes on
    with the frame after it.
  */
  virtual bool next(vpVlpFrame &frame) = 0;

  //! Number of frames in all, 0 where it is unknown.
  virtual size_t size() const { return 0; }

  //! One line on what is unexpected about all frames together, and no error. Empty where nothing is.
  virtual std::string remark() const { return ""; }
};

END_VISP_NAMESPACE

#endif
