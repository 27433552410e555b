/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpFrameOptions_h
#define vpFrameOptions_h

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <visp3/vlp_sensor/vpFrameSource.h>

#include "common/vpCameraOptions.h"

BEGIN_VISP_NAMESPACE

//! Where a program takes its frames from: run folders, numbered pictures, single pictures, a video, a camera.
struct vpFrameOptions {
  std::vector<std::string> runs; // folders
  std::string pattern;
  std::vector<std::string> files;
  std::string video;
  vpCameraOptions camera;
  size_t most = 0;       // frames of each source; 0: all there are, of a camera `ofCamera`
  size_t ofCamera = 100; // likewise; 0: until somebody ends it
  bool manyRuns = true;

  void add(CLI::App &app);

  //! \throw vpException (badValue) unless there is exactly one kind of source.
  void check() const;

  //! One for each run, else one. \param rig What a camera is set to; as it comes, the camera is left as it
  //! is.
  std::vector<std::unique_ptr<vpFrameSource>> open(const vpVlpRig &rig = {}) const;

  //! For messages.
  std::string name() const;
};

/*!
  Hands every frame to \e use, with a progress bar. A frame that cannot be read is a warning.
  \throw vpException (fatalError) on Ctrl-C; (badValue) where not one could be read, naming \e name.
*/
void vpForEachFrame(vpFrameSource &source, const std::string &name,
                    const std::function<void(const vpVlpFrame &)> &use);

END_VISP_NAMESPACE

#endif
