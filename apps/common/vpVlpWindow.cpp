/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "common/vpVlpWindow.h"

#include <visp3/core/vpException.h>

#ifdef VISP_HAVE_X11

#include <algorithm>
#include <cstdlib>

#include <opencv2/imgproc.hpp>
#include <visp3/core/vpImageConvert.h>
#include <visp3/gui/vpDisplayX.h>

#include <X11/Xlib.h> // last: it defines None, Status and other words as macros

BEGIN_VISP_NAMESPACE

namespace
{
std::function<int()> whenClosed; // Xlib's handler has no argument of its own

//! A window manager that closes a vpDisplayX cuts its connection; Xlib then ends the program when this
//! returns.
int connectionLost(Display *)
{
  std::_Exit(whenClosed());
}

std::string noServer()
{
  const char *const name = std::getenv("DISPLAY");
  return name == nullptr || *name == '\0' ? "the environment variable DISPLAY is not set"
                                          : std::string("no X11 display ") + name;
}
} // namespace

struct vpVlpWindow::Impl {
  Display *probe = nullptr; // a server that nobody is connected to may reset: stays open
  vpImage<vpRGBa> picture;
  std::unique_ptr<vpDisplayX> window;

  //! vpDisplay's own scaling leaves out rows and columns, and with them the strokes of letters.
  cv::Mat fitted(const cv::Mat &bgr) const
  {
    const int screen = DefaultScreen(probe);
    const double share = 0.9; // room for the desktop's own bars
    const double scale = std::min(share * DisplayWidth(probe, screen) / bgr.cols,
                                  share * DisplayHeight(probe, screen) / bgr.rows);
    cv::Mat smaller = bgr;
    if (scale < 1) {
      cv::resize(bgr, smaller, cv::Size(), scale, scale, cv::INTER_AREA);
    }
    return smaller;
  }
};

std::string vpVlpWindow::missing()
{
  Display *const probe = XOpenDisplay(nullptr);
  if (probe == nullptr) {
    return noServer();
  }
  XCloseDisplay(probe);
  return "";
}

vpVlpWindow::vpVlpWindow(std::function<int()> closed) : m_impl(std::make_unique<Impl>())
{
  m_impl->probe = XOpenDisplay(nullptr); // vpDisplayX would print lines of its own
  if (m_impl->probe == nullptr) {
    throw vpException(vpException::ioError, "display: " + noServer());
  }
  whenClosed = std::move(closed);
  XSetIOErrorHandler(connectionLost);
}

vpVlpWindow::~vpVlpWindow()
{
  m_impl->window.reset();
  XCloseDisplay(m_impl->probe);
}

void vpVlpWindow::show(const cv::Mat &bgr, const std::string &title)
{
  vpImageConvert::convert(m_impl->fitted(bgr), m_impl->picture);
  if (!m_impl->window) {
    m_impl->window = std::make_unique<vpDisplayX>(m_impl->picture);
  }
  vpDisplay::setTitle(m_impl->picture, title);
  vpDisplay::display(m_impl->picture);
  vpDisplay::flush(m_impl->picture);
}

bool vpVlpWindow::clicked()
{
  return m_impl->window && vpDisplay::getClick(m_impl->picture, false);
}

END_VISP_NAMESPACE

#else

BEGIN_VISP_NAMESPACE

struct vpVlpWindow::Impl {
};

std::string vpVlpWindow::missing()
{
  return "this ViSP was built without X11";
}

vpVlpWindow::vpVlpWindow(std::function<int()>)
{
  throw vpException(vpException::notImplementedError, "display: " + missing());
}

vpVlpWindow::~vpVlpWindow() = default;

void vpVlpWindow::show(const cv::Mat &, const std::string &) {}

bool vpVlpWindow::clicked()
{
  return false;
}

END_VISP_NAMESPACE

#endif
