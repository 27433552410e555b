/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpCameraSource_h
#define vpCameraSource_h

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <visp3/vlp_sensor/vpCameraDriver.h>
#include <visp3/vlp_sensor/vpFrameSource.h>

BEGIN_VISP_NAMESPACE

//! A camera that could be opened.
struct VISP_EXPORT vpCameraDescription {
  std::string uri;
  std::string name;      // maker, model, serial number
  std::string abilities; // what can be set, with its range, as text; or why it could not be asked
};

/*!
  The frames of a camera, live, 8-bit grey.

  | URI | camera | needs at build time |
  |---|---|---|
  | `aravis://NAME` | GigE Vision and USB3 Vision; NAME: id, serial number or address, empty: the first |
  Aravis | | `v4l2:///dev/video0` | what Linux drives: most USB cameras, a Raspberry Pi's | - | |
  `uvc://VID:PID` or `uvc://VID:PID/SERIAL` | USB Video Class without the kernel's driver | libuvc | |
  `mindvision://` or `mindvision://SERIAL` | MindVision, the paper's, through the maker's libMVSDK.so where
  that is installed | - |

  The loss of a camera is reported once, as an exception of next(). Later calls wait until it is back, with
  the settings that were requested. No frame is ever repeated or invented.

  \code
  vpCameraSettings settings;
  settings.exposure = rig.shutter.exposure;
  vpCameraSource camera("aravis://", settings);
  vpVlpFrame frame;
  while (camera.next(frame)) {
    ...
  }
  \endcode
*/
class VISP_EXPORT vpCameraSource : public vpFrameSource
{
public:
  //! Connects to the camera. Called again where it was lost. \throw vpException (ioError, badValue).
  using Opener = std::function<std::unique_ptr<vpCameraDriver>(const vpCameraSettings &)>;

  /*!
    \throw vpException (badValue) where \e uri is none of the above, \e settings cannot be met or the build
    lacks this kind of camera; (ioError) where the camera cannot be opened.
  */
  vpCameraSource(const std::string &uri, const vpCameraSettings &settings,
                 const vpCameraPatience &patience = {});
  //! A camera of the caller's own kind; \e name for messages.
  vpCameraSource(const std::string &name, Opener opener, const vpCameraSettings &settings,
                 const vpCameraPatience &patience = {});
  ~vpCameraSource() override;

  /*!
    Waits for the next frame, the newest one there is. \return False only where vpCameraPatience::stop ended
    the wait. \throw vpException (ioError) once where the camera is lost; the next call waits for its return.
  */
  bool next(vpVlpFrame &frame) override;

  //! What became of the frames.
  std::string remark() const override { return m_counters.text(); }
  const vpCameraCounters &counters() const { return m_counters; }

  //! Changes what is given, now and after each reconnection. \throw vpException as vpCameraDriver::set().
  void set(const vpCameraSettings &settings);

  //! Settings in force, as the camera reports them; empty while it is lost.
  vpCameraSettings settings() const;

  //! Whether it is connected.
  bool connected() const { return m_driver != nullptr; }

  //! Whether \e text begins like the URI of a camera.
  static bool isUri(const std::string &text);

  //! All cameras that can be found, each asked what it can do; and a line on each kind that this build or
  //! this machine lacks, in \e missing.
  static std::vector<vpCameraDescription> list(std::vector<std::string> &missing);

private:
  void connect();
  void begin();
  bool reconnect();
  [[noreturn]] void lose(const std::string &reason);
  bool stopped() const { return m_patience.stop && m_patience.stop(); }

  std::string m_name;
  Opener m_opener;
  vpCameraSettings m_asked;
  vpCameraPatience m_patience;
  vpCameraCounters m_counters;
  std::unique_ptr<vpCameraDriver> m_driver;
  double m_period = 0;    // s, from frame to frame, where the camera tells
  double m_lastFrame = 0; // s, on m_patience.clock: when the last one came, or the camera
  double m_lastTry = 0;   // s, likewise: to find it again
};

END_VISP_NAMESPACE

#endif
