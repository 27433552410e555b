/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpServoDisplay.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include <spdlog/spdlog.h>
#include <visp3/core/vpException.h>
#include <visp3/gui/vpPlot.h>

#include "common/vpVlpDashboard.h"
#include "common/vpVlpWindow.h"

BEGIN_VISP_NAMESPACE

namespace
{
//! ViSP's curves of velocities and errors over time, below the picture and the map.
class Curves
{
public:
  Curves() : m_plot(2, 420, 1200, 0, 640, "vlp-servo")
  {
    m_plot.initGraph(0, 2);
    m_plot.setTitle(0, "Velocity");
    m_plot.setLegend(0, 0, "v, m/s");
    m_plot.setLegend(0, 1, "w, rad/s");
    m_plot.initGraph(1, 2);
    m_plot.setTitle(1, "Error of the estimated pose");
    m_plot.setLegend(1, 0, "across, cm");
    m_plot.setLegend(1, 1, "heading, deg");
  }

  void add(const vpServoStep &step)
  {
    m_start = m_start.value_or(step.time);
    const double time = step.time - *m_start;
    m_plot.plot(0, 0, time, step.told.v);
    m_plot.plot(0, 1, time, step.told.w);
    const double heading = step.reference.heading;
    const Eigen::Vector2d off = Eigen::Vector2d(step.wMb[0][3], step.wMb[1][3]) - step.reference.place;
    const double turned = std::atan2(step.wMb[1][0], step.wMb[0][0]) - heading;
    m_plot.plot(1, 0, time, 100 * (off.y() * std::cos(heading) - off.x() * std::sin(heading)));
    m_plot.plot(1, 1, time, std::remainder(turned, 2 * M_PI) * 180 / M_PI);
  }

private:
  vpPlot m_plot;
  std::optional<double> m_start; // s
};
} // namespace

/*!
  A thread of its own, so that drawing never delays a command; it alone speaks to the screen. It draws the
  newest of what it is given.
*/
struct vpServoDisplay::Impl {
  struct News {
    vpServoStep step;
    std::optional<vpLocatedPicture> picture;
    std::optional<vpHomogeneousMatrix> truth;
  };

  Impl(const vpPath &path, const vpLampMap &map) : path(path), map(map), thread([this] { run(); }) {}

  void run()
  {
    try {
      vpVlpDashboard dashboard(map);
      dashboard.map().setPath(placesOf(path));
      vpVlpWindow window([this] { return closed(); });
      Curves curves;
      while (const std::optional<News> news = wait()) {
        if (news->picture) {
          dashboard.map().setTruth(news->truth);
          window.show(dashboard.draw(*news->picture->I, news->picture->location, news->picture->compute),
                      "vlp-servo: a click ends the run");
          curves.add(news->step);
        }
        clicked = clicked || window.clicked();
      }
    } catch (const vpException &error) {
      spdlog::warn("--display: {}; going on without the window", error.getStringMessage());
    }
  }

  static std::vector<Eigen::Vector2d> placesOf(const vpPath &path)
  {
    constexpr int steps = 500;
    std::vector<Eigen::Vector2d> places;
    for (int i = 0; i <= steps; ++i) {
      places.push_back(path.at(i * path.length() / steps).place);
    }
    return places;
  }

  //! Nothing once all is over.
  std::optional<News> wait()
  {
    std::unique_lock<std::mutex> lock(mutex);
    arrived.wait(lock, [this] { return over || newest.has_value(); });
    return over ? std::nullopt : std::exchange(newest, std::nullopt);
  }

  //! The user has closed the window: Xlib would end the program at once, with the base still moving. This
  //! thread stays here while the loop ends as on a click.
  int closed()
  {
    lost = true;
    clicked = true;
    for (;;) {
      std::this_thread::sleep_for(std::chrono::seconds(1));
    }
  }

  vpPath path;
  vpLampMap map;
  std::atomic<bool> clicked{false}, lost{false};
  std::mutex mutex; // of these two
  std::optional<News> newest;
  bool over = false;
  std::condition_variable arrived;
  std::thread thread; // last: it uses all of the above
};

vpServoDisplay::vpServoDisplay(bool wanted, const vpPath &path, vpServoWorld &world) : m_truth(world.truth())
{
  if (!wanted) {
    return;
  }
  if (const std::string missing = vpVlpWindow::missing(); !missing.empty()) {
    spdlog::warn("--display: {}; going on without the window", missing);
    return;
  }
  m_impl = std::make_unique<Impl>(path, world.map());
}

vpServoDisplay::~vpServoDisplay()
{
  if (!m_impl) {
    return;
  }
  {
    const std::lock_guard<std::mutex> lock(m_impl->mutex);
    m_impl->over = true;
  }
  m_impl->arrived.notify_one();
  if (m_impl->lost) { // its thread never comes back, and needs all that it has
    m_impl->thread.detach();
    static_cast<void>(m_impl.release());
  } else {
    m_impl->thread.join();
  }
}

bool vpServoDisplay::show(const vpServoStep &step, const std::vector<vpLocatedPicture> &pictures)
{
  if (!m_impl || pictures.empty()) {
    return !m_impl || !m_impl->clicked;
  }
  {
    const std::lock_guard<std::mutex> lock(m_impl->mutex);
    m_impl->newest = {step, pictures.back(),
                      m_truth ? std::make_optional(m_truth(pictures.back().timestamp)) : std::nullopt};
  }
  m_impl->arrived.notify_one();
  return !m_impl->clicked;
}

END_VISP_NAMESPACE
