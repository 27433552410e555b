/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "common/vpProgram.h"

#include <cstdlib>
#include <exception>
#include <iostream>
#include <memory>
#include <new>
#include <utility>

#include <CLI/CLI.hpp>
#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpPrintable.h>

BEGIN_VISP_NAMESPACE

namespace
{
//! What goes wrong in OpenCV and FFmpeg comes back as an error with a line of our own.
void silenceLibraries()
{
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
#ifndef _WIN32
  constexpr int keepWhatTheUserSet = 0;
  setenv("OPENCV_FFMPEG_LOGLEVEL", "-8", keepWhatTheUserSet); // AV_LOG_QUIET
#endif
}

//! A message as one line, whatever is in the names that it tells.
class PrintableMessage : public spdlog::custom_flag_formatter
{
public:
  void format(const spdlog::details::log_msg &message, const std::tm &, spdlog::memory_buf_t &line) override
  {
    const std::string text = vpPrintable(std::string(message.payload.data(), message.payload.size()));
    line.append(text.data(), text.data() + text.size());
  }

  std::unique_ptr<custom_flag_formatter> clone() const override
  {
    return std::make_unique<PrintableMessage>();
  }
};

int failed(const std::string &problem)
{
  spdlog::error(problem);
  return static_cast<int>(vpExitCode::badInput);
}

int outOfMemory()
{
  return failed("not enough memory");
}
} // namespace

int vpRunProgram(const std::string &name, const std::function<vpExitCode()> &run)
{
  spdlog::set_default_logger(spdlog::stderr_color_mt(name));
  auto formatter = std::make_unique<spdlog::pattern_formatter>();
  formatter->add_flag<PrintableMessage>('*').set_pattern("%n: %^%l%$: %*");
  spdlog::set_formatter(std::move(formatter));
  silenceLibraries();
  return vpExitStatus(run);
}

int vpExitStatus(const std::function<vpExitCode()> &run)
{
  try {
    const vpExitCode code = run();
    return std::cout.flush() ? static_cast<int>(code) : failed("stdout: cannot be written");
  } catch (const vpException &error) {
    const bool memory = error.getCode() == vpException::memoryAllocationError;
    return memory ? outOfMemory() : failed(error.getStringMessage());
  } catch (const cv::Exception &error) {
    return error.code == cv::Error::StsNoMem ? outOfMemory() : failed("unexpected: " + error.err);
  } catch (const std::bad_alloc &) {
    return outOfMemory();
  } catch (const std::exception &error) {
    return failed(std::string("unexpected: ") + error.what());
  }
}

bool vpParseCommandLine(CLI::App &app, int argc, char **argv)
{
  app.set_version_flag("--version", vpVersionOf(app.get_name()), "Print the version and exit");
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp &) {
    std::cout << app.help();
    return false;
  } catch (const CLI::CallForVersion &version) {
    std::cout << version.what() << "\n";
    return false;
  } catch (const CLI::ParseError &error) {
    throw vpException(vpException::badValue, std::string(error.what()) + " (--help explains the options)");
  }
  return true;
}

std::string vpVersionOf(const std::string &program)
{
  return program + " (visp_vlp) " VLP_VERSION;
}

END_VISP_NAMESPACE
