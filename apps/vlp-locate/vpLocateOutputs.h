/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLocateOutputs_h
#define vpLocateOutputs_h

#include <memory>
#include <optional>

#include <visp3/vlp_core/vpAtomicFile.h>

#include "common/vpVlpDashboard.h"
#include "common/vpVlpWindow.h"
#include "vpLocateOptions.h"

BEGIN_VISP_NAMESPACE

//! A frame and what became of it.
struct vpLocatedFrame {
  size_t index = 0; // 0 is the first of the source, whether it could be read or not
  vpVlpFrame frame;
  vpVlpLocation location;
  double compute = 0; // s, from frame to pose, without reading and writing
};

//! The files, folder and window that were asked for.
class vpLocateOutputs
{
public:
  /*!
    \param closed As of vpVlpWindow. \throw vpException where one of them cannot be written: before any work
    is done.
  */
  vpLocateOutputs(const vpLocateOptions &options, const vpLampMap &map, std::function<int()> closed);

  //! \param detector Which saw that frame last.
  void write(const vpLocatedFrame &located, const vpLedDetector &detector);

  //! Gives the files their names.
  void commit();

  //! Positions that have no row, since their time is not after that of the row above.
  size_t posesLeftOut() const { return m_posesLeftOut; }

  //! The window, or nullptr.
  vpVlpWindow *window() { return m_window.get(); }

private:
  std::ostream *poses();
  void writePose(const vpVlpLocation &location);
  void writeFix(const vpLocatedFrame &located);
  void writeSeen(const vpLocatedFrame &located);
  void draw(const vpLocatedFrame &located, const vpLedDetector &detector);

  bool m_posesToStdout;
  std::string m_overlay; // folder, or empty
  std::unique_ptr<vpAtomicFile> m_poses;
  std::unique_ptr<vpAtomicFile> m_fixes;
  std::unique_ptr<vpAtomicFile> m_seen;
  vpVlpDashboard m_dashboard;
  std::unique_ptr<vpVlpWindow> m_window;
  std::optional<double> m_lastPose; // s, of the last row
  size_t m_posesLeftOut = 0;
};

END_VISP_NAMESPACE

#endif
