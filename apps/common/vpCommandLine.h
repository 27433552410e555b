/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpCommandLine_h
#define vpCommandLine_h

#include <cstdint>
#include <string>
#include <vector>

#include <visp3/vlp_core/vpVlpNamespace.h>

// Declared alone: CLI11's header is large.
namespace CLI
{
class App;
class Option;
} // namespace CLI

BEGIN_VISP_NAMESPACE

//! \throw vpException (badValue): what the user gave is no good, for \e problem.
[[noreturn]] void vpBadInput(const std::string &problem);

//! An option that takes a text which is not empty, as the name of a file.
void vpAddName(CLI::App &app, const std::string &option, std::string &name, const std::string &type,
               const std::string &help);

/*!
  An option that takes the name of a file or folder to read. A name that is not there is looked for in the
  data that was installed with the program: data/scenarios/servo.yaml is read wherever the program is called.
*/
void vpAddInput(CLI::App &app, const std::string &option, std::string &name, const std::string &type,
                const std::string &help);

//! An option that takes one such name, or \e several, one or more.
void vpAddInputs(CLI::App &app, const std::string &option, std::vector<std::string> &names, bool several,
                 const std::string &type, const std::string &help);

//! An option that takes one of a few words.
void vpAddChoice(CLI::App &app, const std::string &option, std::string &value,
                 const std::vector<std::string> &choices, const std::string &help);

//! An option that takes a whole number from 1 to \e most.
CLI::Option *vpAddCount(CLI::App &app, const std::string &option, size_t &count, const std::string &help,
                        size_t most = 1000000000);

//! An option that takes the seed of all that is left to chance.
void vpAddSeed(CLI::App &app, const std::string &option, std::uint64_t &seed, const std::string &help);

//! \e count finite numbers parted by commas. \throw vpException (badValue) that names \e option and \e
//! expected.
std::vector<double> vpNumbersOf(const std::string &option, const std::string &text, size_t count,
                                const std::string &expected);

END_VISP_NAMESPACE

#endif
