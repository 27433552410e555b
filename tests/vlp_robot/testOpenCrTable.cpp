/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <gtest/gtest.h>
#include <visp3/vlp_robot/vpOpenCrTable.h>

#include "common/vpExpectError.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

using Table = vpOpenCrTable;

TEST(OpenCrTable, NumbersAreLittleEndian)
{
  vpControlBlock block(136, 8);
  block.set(Table::positionLeft, -131073);
  block.set(Table::positionRight, 0x01020304);
  EXPECT_EQ(block.bytes(), (std::vector<std::uint8_t>{0xFF, 0xFF, 0xFD, 0xFF, 4, 3, 2, 1}));
  EXPECT_EQ(block.get(Table::positionLeft), -131073);
  EXPECT_EQ(block.get(Table::positionRight), 0x01020304);

  const vpControlBlock gyro(68, {0x00, 0x00, 0xC0, 0xBF});
  EXPECT_EQ(gyro.get(Table::gyroZ), -1.5f);
  const vpControlBlock status(18, {0xFF, 0xFF});
  EXPECT_EQ(status.get(Table::deviceStatus), -1);
  EXPECT_EQ(status.get(Table::heartbeat), 255);
}

TEST(OpenCrTable, SnapshotHoldsWhatIsReadFromIt)
{
  const vpControlBlock block(Table::snapshotAddress, Table::snapshotLength);
  EXPECT_EQ(block.bytes().size(), 172u);
  EXPECT_EQ(block.get(Table::millis), 0u);
  EXPECT_EQ(block.get(Table::profileRight), 0u);
  vpExpectError([&] { block.get(Table::firmwareVersion); },
                {"control table: 1 bytes at 6, expected between 10 and 182"});
  vpControlBlock half(150, 2);
  vpExpectError([&] { half.set(Table::commandV, 1); }, {"4 bytes at 150, expected between 150 and 152"});
}
