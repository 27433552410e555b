/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// What all programs have in common.

#include <string>

#include <gtest/gtest.h>

#include "common/vpProcess.h"

namespace
{
class Programs : public testing::TestWithParam<std::string>
{
};
} // namespace

TEST_P(Programs, SayTheirVersion)
{
  vpProcess program(GetParam(), {"--version"});
  EXPECT_EQ(program.wait(), 0);
  EXPECT_EQ(program.out(), GetParam() + " (visp_vlp) " VLP_VERSION "\n");
}

INSTANTIATE_TEST_SUITE_P(All, Programs,
                         testing::Values("vlp-calibrate", "vlp-evaluate", "vlp-lamp", "vlp-locate",
                                         "vlp-plan", "vlp-servo", "vlp-simulate"));
