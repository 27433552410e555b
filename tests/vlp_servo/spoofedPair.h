/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef spoofedPair_h
#define spoofedPair_h

#include <optional>

#include <visp3/vlp_servo/vpPictureFeed.h>
#include <visp3/vlp_simulation/vpScenario.h>

namespace spoofedPair
{
#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

//! A world of four lamps with the second and the last alone; from \e from on, s, they are dark, and two
//! others with their frequencies shine 36 cm beside.
inline vpScenario spoofed(vpScenario scenario, double from)
{
  constexpr double always = 1e9, aside = 0.36; // s, m
  for (const size_t unused : {0, 2}) {
    scenario.lamps[unused].dark.emplace_back(-1, always);
  }
  for (const size_t lamp : {1, 3}) {
    vpScenario::Lamp copy = scenario.lamps[lamp];
    copy.shift.y() = aside;
    copy.dark.emplace_back(-1, from);
    scenario.lamps[lamp].dark.emplace_back(from, always);
    scenario.lamps.push_back(copy);
  }
  return scenario;
}

//! The localizer gets no odometry.
class NoOdometry : public vpPictureFeed
{
public:
  explicit NoOdometry(vpPictureFeed &feed) : m_feed(feed) {}
  void addOdometry(const vpOdometry &) override {}
  std::optional<vpLocatedPicture> next(double now) override { return m_feed.next(now); }

private:
  vpPictureFeed &m_feed;
};
} // namespace spoofedPair

#endif
