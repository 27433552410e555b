/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpGrownSearch.h"

BEGIN_VISP_NAMESPACE

void vpGrownSearch::lay(const vpRect &region, const vpRect &target, unsigned int width, unsigned int height)
{
  m_left = static_cast<int>(std::clamp(region.getLeft(), 0.0, double(width)));
  m_top = static_cast<int>(std::clamp(region.getTop(), 0.0, double(height)));
  m_right = static_cast<int>(std::clamp(region.getRight() + 1, 0.0, double(width)));
  m_bottom = static_cast<int>(std::clamp(region.getBottom() + 1, 0.0, double(height)));
  m_cellWidth = std::max(1, static_cast<int>(target.getWidth()) / cellsPerWindow);
  m_cellHeight = std::max(1, static_cast<int>(target.getHeight()) / cellsPerWindow);
  m_columns = (m_right - m_left + m_cellWidth - 1) / m_cellWidth;
  m_rows = (m_bottom - m_top + m_cellHeight - 1) / m_cellHeight;
  m_cells.assign(static_cast<size_t>(m_columns) * m_rows, 0);
}

std::vector<vpRect> vpGrownSearch::best(const vpRect &target, int count)
{
  static const double farther = 0.3; // of its sum that a window loses where it is farthest from the middle
  const int across = std::min(cellsPerWindow, m_columns), down = std::min(cellsPerWindow, m_rows);
  if (across == 0 || down == 0) {
    return {};
  }
  const int columns = m_columns - across + 1, rows = m_rows - down + 1;
  auto windowAt = [&](int column, int row) {
    vpRect window = target;
    window.moveCenter(m_left + (column + 0.5 * across) * m_cellWidth - 0.5,
                      m_top + (row + 0.5 * down) * m_cellHeight - 0.5);
    return window;
  };
  const double reach = std::hypot(m_right - m_left, m_bottom - m_top) / 2;
  m_sums.assign(static_cast<size_t>(columns) * rows, 0);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      double sum = 0;
      for (int y = row; y < row + down; ++y) {
        for (int x = column; x < column + across; ++x) {
          sum += m_cells[static_cast<size_t>(y) * m_columns + x];
        }
      }
      const double distance = vpImagePoint::distance(windowAt(column, row).getCenter(), target.getCenter());
      m_sums[static_cast<size_t>(row) * columns + column] =
          sum * (1 - farther * std::min(1.0, distance / reach));
    }
  }
  std::vector<vpRect> windows;
  while (static_cast<int>(windows.size()) < count) {
    const auto highest = std::max_element(m_sums.begin(), m_sums.end());
    if (*highest <= 0) {
      break;
    }
    const int at = static_cast<int>(highest - m_sums.begin());
    windows.push_back(windowAt(at % columns, at / columns));
    for (int row = std::max(0, at / columns - down + 1); row < std::min(rows, at / columns + down); ++row) {
      for (int column = std::max(0, at % columns - across + 1);
           column < std::min(columns, at % columns + across); ++column) {
        m_sums[static_cast<size_t>(row) * columns + column] = 0; // others overlap it
      }
    }
  }
  return windows;
}

END_VISP_NAMESPACE
