/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpVideoSource_h
#define vpVideoSource_h

#include <memory>
#include <string>

#include <visp3/vlp_sensor/vpFrameSource.h>

BEGIN_VISP_NAMESPACE

/*!
  The frames of a video file, through OpenCV. Their times are the stream's own, from 0 on; where a stream has
  none they follow from its rate, and where it has no rate either they are the index. A rotation noted in the
  file is not applied. Lossy video blurs fine stripes: prefer pictures, or a lossless codec.
*/
class VISP_EXPORT vpVideoSource : public vpFrameSource
{
public:
  //! \throw vpException (ioError) with one line that names the file where it cannot be opened as a video.
  explicit vpVideoSource(const std::string &filename);
  ~vpVideoSource() override;

  bool next(vpVlpFrame &frame) override;

  //! As stated in the file's header, which for some containers is an estimate.
  size_t size() const override;

private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};

END_VISP_NAMESPACE

#endif
