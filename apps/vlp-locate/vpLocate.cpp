/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLocate.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <thread>
#include <utility>

#include <unistd.h>

#include <spdlog/spdlog.h>
#include <visp3/core/vpException.h>
#include <visp3/vlp_robot/vpOdometry.h>

#include "common/vpInterrupt.h"
#include "common/vpProgressBar.h"
#include "common/vpTextBlock.h"
#include "vpLocateOutputs.h"
#include "vpLocateSummary.h"

BEGIN_VISP_NAMESPACE

namespace
{
std::string sizeText(unsigned int width, unsigned int height)
{
  return std::to_string(width) + " x " + std::to_string(height) + " pixels";
}

//! The program's state, from its first frame to its exit code.
class Locate
{
public:
  explicit Locate(const vpLocateOptions &options)
      : m_options(options), m_rig(vpVlpRig::load(options.rigFile)), m_map(vpLampMap::load(options.lampsFile)),
        m_localizer(options.localizer(m_rig, m_map)),
        m_odometry(options.odometry.empty() ? std::vector<vpOdometry>() : vpReadOdometry(options.odometry)),
        m_source(std::move(options.frames.open(m_rig).front())),
        m_outputs(options, m_map, [this] { return windowClosed(); })
  {
  }

  vpExitCode run()
  {
    remarkOnFrames();
    // Where the poses appear on the same terminal, they are the progress.
    vpProgressBar progress(m_source->size(), !(m_options.posesToStdout() && isatty(STDOUT_FILENO) == 1));
    bool ended = false;
    for (vpLocatedFrame located; !vpInterrupt::requested() && !clicked(); ++located.index) {
      try {
        if (!m_source->next(located.frame)) {
          ended = !vpInterrupt::requested(); // which ends the wait for a camera's frame as well
          break;
        }
        locate(located);
      } catch (const vpException &error) {
        progress.clear();
        spdlog::error(error.getStringMessage());
        m_summary.addBad();
        continue;
      }
      if (located.location.fix.valid && located.location.relocated != m_relocated) {
        progress.clear();
        tellRelocation(located.location);
      }
      m_summary.add(located);
      m_outputs.write(located, m_localizer.tracker.detector);
      progress.show(located.index + 1);
    }
    progress.clear();
    m_code = finish(ended ? "" : "stopped");
    m_finished = true;
    if (ended) {
      waitForClick();
    }
    return m_code;
  }

private:
  void remarkOnFrames() const
  {
    if (const std::string remark = m_source->remark(); !remark.empty()) {
      spdlog::warn("{}; {}", remark,
                   m_options.noTrack
                       ? "each frame is located by itself all the same"
                       : "a frame that is up to a second late gives no position, at one that is later all "
                         "begins anew");
    }
  }

  void locate(vpLocatedFrame &located)
  {
    const vpVlpFrame &frame = located.frame;
    if (frame.I.getWidth() != m_rig.width || frame.I.getHeight() != m_rig.height) {
      throw vpException(vpException::dimensionError,
                        frame.name + ": " + sizeText(frame.I.getWidth(), frame.I.getHeight()) +
                            ", expected " + sizeText(m_rig.width, m_rig.height) + ", the size of camera " +
                            m_rig.cameraName + " in " + m_options.rigFile);
    }
    followOdometry(frame.timestamp);
    const auto start = std::chrono::steady_clock::now();
    try {
      m_localizer.process(frame, located.location);
    } catch (const vpException &error) { // knows no file
      throw vpException(error.getCode(), frame.name + ": " + error.getStringMessage());
    }
    located.compute = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  //! Where it begins and where it ends.
  void tellRelocation(const vpVlpLocation &location)
  {
    m_relocated = location.relocated;
    const vpVlpFix &fix = location.fix;
    const std::string place =
        vpFormat("%.3f s: x %.3f, y %.3f m", location.timestamp, fix.wMb[0][3], fix.wMb[1][3]);
    if (m_relocated) {
      spdlog::warn("{}: relocated: no motion leads there, and no third lamp bears it out yet", place);
    } else if (constexpr size_t enough = 3; fix.lamps.size() >= enough) {
      spdlog::info("{}: borne out by {} lamps", place, fix.lamps.size());
    } else {
      spdlog::info("{}: no longer relocated", place);
    }
  }

  //! Hands on what the base says up to when a frame's last line was read: by then it is known.
  void followOdometry(double timestamp)
  {
    const vpLineTiming timing = m_rig.lineTiming();
    const double read = timestamp + std::max(timing.middle(0), timing.middle(timing.lines() - 1));
    static const double setBack = 1; // s: the frames' clock, behind one wild time stamp as well
    if (timestamp < m_lastTime - setBack) {
      m_odometryUsed = 0;
    }
    m_lastTime = timestamp;
    for (; m_odometryUsed < m_odometry.size(); ++m_odometryUsed) {
      m_localizer.filter.addOdometry(m_odometry[m_odometryUsed]);
      if (m_odometry[m_odometryUsed].timestamp > read) {
        ++m_odometryUsed;
        break;
      }
    }
  }

  //! Gives the outputs their names and says what was done. \e stopped: why before the last frame, or empty.
  vpExitCode finish(const std::string &stopped)
  {
    const size_t frames = m_summary.used() + m_summary.bad();
    if (m_summary.used() == 0 && stopped.empty()) { // nothing to write: the outputs stay away
      if (frames != 1) {                            // of one, its own line says all
        spdlog::error(m_options.frames.name() +
                      (frames == 0 ? ": no frames, expected one or more"
                                   : ": none of the " + std::to_string(frames) + " frames could be used"));
      }
      return vpExitCode::badInput;
    }
    m_outputs.commit();
    if (!stopped.empty()) {
      const size_t total = m_source->size();
      spdlog::warn("{} after {}{}; what was done so far is kept", stopped, total == 0 ? "frame " : "",
                   std::to_string(frames) + (total == 0 ? "" : " of " + std::to_string(total) + " frames"));
    }
    m_summary.log();
    remarkOnClaims();
    if (const std::string remark = m_source->remark();
        !m_options.frames.camera.uri.empty() && !remark.empty()) {
      spdlog::warn(remark); // what became of the frames is known by now
    }
    if (const size_t left = m_outputs.posesLeftOut(); left > 0) {
      spdlog::info("{} not among the poses, whose times rise from row to row (--fixes has every frame)",
                   left == 1 ? "1 position is" : std::to_string(left) + " positions are");
    }
    return m_summary.positions() > 0 ? vpExitCode::done : vpExitCode::nothingFound;
  }

  //! What the stripes contradict; and who states no uncertainty of map and mount reads standard deviations
  //! without it.
  void remarkOnClaims() const
  {
    const vpExposureEvidence &exposure = m_localizer.tracker.detector.exposure();
    if (exposure.contradicts()) {
      spdlog::warn(
          "{}: shutter.exposure_s: {} s, expected about {} s: so soft are the stripes' edges, and lamps were "
          "read with that",
          m_options.rigFile, vpFormat("%.2g", m_rig.shutter.exposure), vpFormat("%.2g", exposure.exposure()));
    }
    const bool mapStatesSigma = std::any_of(m_map.lamps.begin(), m_map.lamps.end(),
                                            [](const vpLamp &lamp) { return lamp.positionSigma > 0; });
    if (m_summary.positions() > 0 && !mapStatesSigma && m_rig.rotationSigma.isZero(0) &&
        m_rig.translationSigma.isZero(0)) {
      spdlog::info(
          "{} and {} state no position_sigma_m, rotation_sigma_deg or translation_sigma_m: positions "
          "are told as certain as where lamps and camera are known exactly",
          m_options.lampsFile, m_options.rigFile);
    }
  }

  bool clicked() { return m_outputs.window() != nullptr && m_outputs.window()->clicked(); }

  //! The last picture stays until somebody has seen it.
  void waitForClick()
  {
    if (m_outputs.window() != nullptr && m_summary.used() > 0) {
      spdlog::info("click in the window to end");
      while (!vpInterrupt::requested() && !clicked()) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
      }
    }
  }

  //! Called from within Xlib, through which no exception passes.
  int windowClosed()
  {
    return vpExitStatus([this] { return m_finished ? m_code : finish("window closed"); });
  }

  vpLocateOptions m_options;
  vpVlpRig m_rig;
  vpLampMap m_map;
  vpVlpLocalizer m_localizer;
  std::vector<vpOdometry> m_odometry;
  size_t m_odometryUsed = 0;
  double m_lastTime = -std::numeric_limits<double>::infinity(); // s, of the last frame
  std::unique_ptr<vpFrameSource> m_source;
  vpLocateSummary m_summary;
  bool m_relocated = false; // told
  bool m_finished = false;
  vpExitCode m_code = vpExitCode::badInput; // once finished
  vpLocateOutputs m_outputs;                // last: its window speaks to all of the above
};
} // namespace

vpExitCode vpLocate(const vpLocateOptions &asked)
{
  vpInterrupt::install();
  if (asked.listCameras) {
    return vpCameraOptions::list();
  }
  vpLocateOptions options = asked;
  if (options.display) {
    const std::string missing = vpVlpWindow::missing();
    if (!missing.empty()) {
      spdlog::warn("--display: {}; going on without the window", missing);
      options.display = false;
    }
  }
  return Locate(options).run();
}

END_VISP_NAMESPACE
