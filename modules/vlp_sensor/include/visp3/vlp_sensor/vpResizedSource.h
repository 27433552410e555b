/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpResizedSource_h
#define vpResizedSource_h

#include <memory>

#include <visp3/vlp_core/vpVlpRig.h>
#include <visp3/vlp_sensor/vpFrameSource.h>

BEGIN_VISP_NAMESPACE

/*!
  The frames of a camera that takes the sensor's whole picture, made as small as the rig states that software
  made them (`resize` in a rig.yaml). Frames of another size than the sensor's are handed on as they are.
*/
class VISP_EXPORT vpResizedSource : public vpFrameSource
{
public:
  vpResizedSource(std::unique_ptr<vpFrameSource> source, const vpVlpRig &rig);

  bool next(vpVlpFrame &frame) override;
  size_t size() const override { return m_source->size(); }
  std::string remark() const override { return m_source->remark(); }

private:
  std::unique_ptr<vpFrameSource> m_source;
  vpPictureResize m_resize;
  unsigned int m_width, m_height; // pixels, as delivered
  vpVlpFrame m_taken;
};

END_VISP_NAMESPACE

#endif
