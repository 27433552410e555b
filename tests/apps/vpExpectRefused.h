/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpExpectRefused_h
#define vpExpectRefused_h

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/vpProcess.h"

//! How a program ends.
namespace vpStatus
{
constexpr int done = 0, badInput = 2, nothingFound = 3;
}

/*!
  Runs a program and expects that it ends with \e code and one line on stderr, an error with all of \e parts.
  \return What it wrote to stdout.
*/
inline std::string vpExpectRefused(const std::string &program, const std::vector<std::string> &arguments,
                                   int code, const std::vector<std::string> &parts)
{
  SCOPED_TRACE(testing::PrintToString(arguments));
  vpProcess process(program, arguments);
  EXPECT_EQ(process.wait(), code);
  const std::string line = process.err();
  EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1) << line;
  EXPECT_EQ(line.rfind(program + ": error: ", 0), 0u) << line;
  for (const std::string &part : parts) {
    EXPECT_NE(line.find(part), std::string::npos) << "  line:     " << line << "  expected: " << part;
  }
  return process.out();
}

#endif
