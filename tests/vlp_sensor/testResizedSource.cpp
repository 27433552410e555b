/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <memory>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <visp3/vlp_sensor/vpResizedSource.h>

#include "common/vpAllocatedMemory.h"
#include "common/vpUpwardRig.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

namespace
{
//! Pictures of one grey value each, their number.
class Numbers : public vpFrameSource
{
public:
  Numbers(unsigned int width, unsigned int height) : m_width(width), m_height(height) {}

  bool next(vpVlpFrame &frame) override
  {
    frame.I.resize(m_height, m_width);
    frame.I = static_cast<unsigned char>(m_number);
    frame.timestamp = m_number;
    frame.name = std::to_string(m_number++);
    return true;
  }

private:
  unsigned int m_width, m_height;
  int m_number = 0;
};
} // namespace

// Once with pictures that a frame keeps, once with such as are taken from it, as a feed does it.
TEST(ResizedSource, PicturesThatAreHandedOnAreFreed)
{
  for (const bool taken : {false, true}) {
    const vpVlpRig rig = vpUpwardRig(800, 600);
    vpResizedSource source(std::make_unique<Numbers>(800, 600), rig);
    const double before = vpAllocatedMemory();
    for (int k = 0; k < 100; ++k) {
      vpVlpFrame frame;
      ASSERT_TRUE(source.next(frame));
      EXPECT_EQ(frame.I[599][799], k);
      EXPECT_EQ(frame.timestamp, k);
      EXPECT_EQ(frame.name, std::to_string(k));
      if (taken) {
        std::make_shared<vpImage<unsigned char>>(std::move(frame.I));
      }
    }
    EXPECT_LT(vpAllocatedMemory() - before, 5) << taken; // of 46
  }
}

TEST(ResizedSource, PicturesOfTheSensorsSizeAreMadeAsSmallAsTheRigSays)
{
  vpVlpRig rig = vpUpwardRig(400, 300);
  rig.resize.method = vpPictureResize::Method::nearest;
  rig.resize.sourceWidth = 800;
  rig.resize.sourceHeight = 600;
  vpResizedSource source(std::make_unique<Numbers>(800, 600), rig);
  vpVlpFrame frame;
  for (int k = 0; k < 3; ++k) {
    ASSERT_TRUE(source.next(frame));
    EXPECT_EQ(frame.I.getWidth(), 400u);
    EXPECT_EQ(frame.I.getHeight(), 300u);
    EXPECT_EQ(frame.I[299][399], k);
    EXPECT_EQ(frame.name, std::to_string(k));
  }
}
