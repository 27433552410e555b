/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpProgram_h
#define vpProgram_h

#include <functional>
#include <string>

#include <visp3/vlp_core/vpVlpNamespace.h>

// Declared alone: CLI11's header is large, and only the files that add options need it.
namespace CLI
{
class App;
}

BEGIN_VISP_NAMESPACE

//! What the exit code of every program says.
enum class vpExitCode {
  done = 0,
  badInput = 2,    //!< bad usage too
  nothingFound = 3 //!< the input is good and holds no answer
};

/*!
  What main() returns: runs \e run with spdlog writing to stderr as `name: level: text`, always one line
  (vpPrintable). An exception is one there and exit code 2, and so is a stdout that takes nothing more.
*/
int vpRunProgram(const std::string &name, const std::function<vpExitCode()> &run);

//! The inner part of it: calls \e run and turns an exception into that line and exit code.
int vpExitStatus(const std::function<vpExitCode()> &run);

/*!
  \return False where `--help` or `--version` was asked for and is printed. \throw vpException (badValue) with
  one line where the usage is bad.
*/
bool vpParseCommandLine(CLI::App &app, int argc, char **argv);

//! What `--version` prints of a program: a line.
std::string vpVersionOf(const std::string &program);

END_VISP_NAMESPACE

#endif
