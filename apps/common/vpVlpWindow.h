/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpVlpWindow_h
#define vpVlpWindow_h

#include <functional>
#include <memory>
#include <string>

#include <opencv2/core.hpp>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

//! A window on the screen that shows one colour picture after the other.
class vpVlpWindow
{
public:
  //! Why no window can be shown here, in one line; empty where one can.
  static std::string missing();

  /*!
    \param closed What the user's closing the window brings about: X11 ends the program then, with the exit
    code that this function returns. It must not touch the window. \throw vpException where there is no
    display to show anything on.
  */
  explicit vpVlpWindow(std::function<int()> closed);
  ~vpVlpWindow();

  //! \e bgr: all pictures of one size.
  void show(const cv::Mat &bgr, const std::string &title);

  //! Whether somebody has clicked into the window.
  bool clicked();

private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};

END_VISP_NAMESPACE

#endif
