/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpExpectError_h
#define vpExpectError_h

#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  Expects that \e act throws a vpException with one line that holds all of \e parts, and prints nothing.
*/
inline void vpExpectError(const std::function<void()> &act, const std::vector<std::string> &parts)
{
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  std::string message, other;
  try {
    act();
    other = "nothing thrown";
  } catch (const vpException &error) {
    message = error.getStringMessage();
  } catch (const std::exception &error) {
    other = std::string("no vpException: ") + error.what();
  }
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(other, "");
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  for (const std::string &part : parts) {
    EXPECT_NE(message.find(part), std::string::npos) << "  message:  " << message << "\n  expected: " << part;
  }
}

END_VISP_NAMESPACE

#endif
