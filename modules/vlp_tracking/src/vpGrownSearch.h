/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpGrownSearch_h
#define vpGrownSearch_h

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <visp3/core/vpImage.h>
#include <visp3/core/vpRect.h>

#include "vpTargetModel.h"

BEGIN_VISP_NAMESPACE

/*!
  Where in a large window the target may be: the places whose windows hold most of the back projection. That
  is summed over cells of a quarter of the target's window, from a sixteenth of the pixels where the target is
  large. The pixels taken lie askew, so that no stripe's period meets only pixels of its dark.
*/
class vpGrownSearch
{
public:
  /*!
    At most \e count windows of the size of \e target, best first. Of equal ones the one nearer to the middle
    of \e target comes first.
  */
  template <class Pixel, class Bins>
  std::vector<vpRect> find(const vpImage<Pixel> &I, const Bins &binOf, const vpTargetModel::Weights &weights,
                           const vpRect &region, const vpRect &target, int count);

private:
  static constexpr int cellsPerWindow = 4;

  //! Lays the cells over the part of the region inside the picture.
  void lay(const vpRect &region, const vpRect &target, unsigned int width, unsigned int height);
  std::vector<vpRect> best(const vpRect &target, int count);

  int m_left = 0, m_top = 0, m_right = 0, m_bottom = 0; // px, right and bottom exclusive
  int m_cellWidth = 1, m_cellHeight = 1;                // px
  int m_columns = 0, m_rows = 0;                        // cells
  std::vector<std::uint32_t> m_cells;
  std::vector<double> m_sums; // over the cells of a window
};

template <class Pixel, class Bins>
std::vector<vpRect> vpGrownSearch::find(const vpImage<Pixel> &I, const Bins &binOf,
                                        const vpTargetModel::Weights &weights, const vpRect &region,
                                        const vpRect &target, int count)
{
  lay(region, target, I.getWidth(), I.getHeight());
  const int step = std::max(1, std::min(m_cellWidth, m_cellHeight) / 4);
  for (int y = m_top; y < m_bottom; ++y) {
    std::uint32_t *cells = m_cells.data() + (y - m_top) / m_cellHeight * m_columns;
    const Pixel *row = I[y];
    for (int x = m_left + y % step; x < m_right; x += step) {
      cells[(x - m_left) / m_cellWidth] += static_cast<std::uint32_t>(weights[binOf(row[x])]);
    }
  }
  return best(target, count);
}

END_VISP_NAMESPACE

#endif
