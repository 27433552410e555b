/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_robot/vpOpenCrTable.h>

#include <algorithm>
#include <string>

#include <visp3/core/vpException.h>

BEGIN_VISP_NAMESPACE

size_t vpControlBlock::offset(std::uint16_t address, size_t length) const
{
  if (address < m_address || address + length > m_address + m_bytes.size()) {
    throw vpException(vpException::dimensionError, "control table: " + std::to_string(length) + " bytes at " +
                                                       std::to_string(address) + ", expected between " +
                                                       std::to_string(m_address) + " and " +
                                                       std::to_string(m_address + m_bytes.size()));
  }
  return static_cast<size_t>(address - m_address);
}

void vpControlBlock::copy(std::uint16_t address, std::uint8_t *out, size_t length) const
{
  std::copy_n(m_bytes.begin() + static_cast<std::ptrdiff_t>(offset(address, length)), length, out);
}

END_VISP_NAMESPACE
