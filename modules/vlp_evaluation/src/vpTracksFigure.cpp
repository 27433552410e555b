/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_evaluation/vpTracksFigure.h>

#include <array>

#include "vpFigureBox.h"
#include "vpFigureScript.h"

BEGIN_VISP_NAMESPACE

using namespace vpFigureScript;

vpFigure vpTracksFigure(const std::string &name, const std::string &caption, const vpNamedTrack &path,
                        const std::vector<vpNamedTrack> &tracks)
{
  vpFigureBox box;
  std::vector<const vpNamedTrack *> all = {&path};
  for (const vpNamedTrack &track : tracks) {
    all.push_back(&track);
  }
  for (const vpNamedTrack *track : all) {
    for (const Eigen::Vector2d &place : track->places) {
      box.hold(place);
    }
  }
  box.finish(0.01);
  const Unit unit = Unit::ofMap(box.size().maxCoeff());

  vpFigure figure;
  figure.name = name;
  figure.caption = caption;
  figure.height = box.figureHeight(figure.width);
  static const std::array<const char *, 4> colours = {blue, orange, red, dark};
  std::vector<std::string> plots;
  for (size_t i = 0; i < all.size(); ++i) {
    constexpr size_t most = 2000; // places
    const size_t stride = all[i]->places.size() / most + 1;
    std::string rows;
    for (size_t k = 0; k < all[i]->places.size(); k += stride) {
      rows += row({unit.perMetre * all[i]->places[k].x(), unit.perMetre * all[i]->places[k].y()});
    }
    const std::string data = "track" + std::to_string(i);
    figure.body += block(data, rows);
    plots.push_back("$" + data + " with lines lw " + (i == 0 ? "5" : "1.6") +
                    colour(i == 0 ? pale : colours[(i - 1) % colours.size()]) + title(all[i]->name));
  }
  figure.body += box.ranges(unit.perMetre) + axisLabel("x", std::string("x (") + unit.name + ")") +
                 axisLabel("y", std::string("y (") + unit.name + ")") + joined(plots);
  return figure;
}

END_VISP_NAMESPACE
