/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpCameraDriver_h
#define vpCameraDriver_h

#include <visp3/vlp_core/vpVlpFrame.h>
#include <visp3/vlp_sensor/vpCameraSettings.h>

BEGIN_VISP_NAMESPACE

/*!
  A camera that is connected and takes pictures: what each kind of camera has to do for vpCameraSource, which
  counts, waits and connects anew. Constructed with the settings in force; destroyed, it lets go of the
  camera.
*/
class VISP_EXPORT vpCameraDriver
{
public:
  virtual ~vpCameraDriver() = default;

  /*!
    Waits for the newest frame; its time stamp is the start of exposure of its first line on \e clock, as far
    as the camera tells. Frames that it passes over are counted in \e counters.
    \param patience s, about. \return False where none came.
    \throw vpException (ioError) with one line where the camera is gone.
  */
  virtual bool grab(double patience, const std::function<double()> &clock, vpVlpFrame &frame,
                    vpCameraCounters &counters) = 0;

  //! Changes what is given while pictures go on. The region cannot be. \throw vpException (badValue) where
  //! the camera cannot do it, with what it can; (ioError) where it is gone.
  virtual void set(const vpCameraSettings &settings) = 0;

  //! Settings in force, read back; left out what this camera does not report.
  virtual vpCameraSettings settings() const = 0;
};

END_VISP_NAMESPACE

#endif
