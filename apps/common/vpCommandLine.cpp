/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "common/vpCommandLine.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <system_error>

#include <CLI/CLI.hpp>
#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_core/vpPrintable.h>

BEGIN_VISP_NAMESPACE

namespace
{
std::string notEmpty(const std::string &text)
{
  return text.empty() ? "an empty name" : "";
}

//! A name that is not there, in the data that was installed with this program, if it is there.
std::string installed(const std::string &name)
{
  namespace fs = std::filesystem;
  std::error_code failure;
  const fs::path program = fs::read_symlink("/proc/self/exe", failure),
                 there = program.parent_path().parent_path() / VLP_INSTALLED_DATA / name;
  const bool here = fs::exists(name, failure) || fs::path(name).is_absolute();
  return !here && fs::exists(there, failure) ? there.string() : name;
}

//! What takes a whole number; CLI11 wraps -1 around and takes the largest for what is too large.
auto wholeNumber(std::uint64_t least, std::uint64_t most, const std::string &expected)
{
  return [least, most, expected](const std::string &text) {
    std::uint64_t number = 0;
    const char *const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, number);
    const bool good = end == last && error == std::errc() && number >= least && number <= most;
    return good ? std::string() : vpShown(text) + ", expected a whole number " + expected;
  };
}
} // namespace

void vpBadInput(const std::string &problem)
{
  throw vpException(vpException::badValue, problem);
}

void vpAddName(CLI::App &app, const std::string &option, std::string &name, const std::string &type,
               const std::string &help)
{
  app.add_option(option, name, help)->type_name(type)->check(notEmpty);
}

void vpAddInput(CLI::App &app, const std::string &option, std::string &name, const std::string &type,
                const std::string &help)
{
  app.add_option(option, name, help)->type_name(type)->check(notEmpty)->transform(installed);
}

void vpAddInputs(CLI::App &app, const std::string &option, std::vector<std::string> &names, bool several,
                 const std::string &type, const std::string &help)
{
  app.add_option(option, names, help)
      ->type_name(type)
      ->expected(several ? -1 : 1)
      ->check(notEmpty)
      ->transform(installed);
}

void vpAddChoice(CLI::App &app, const std::string &option, std::string &value,
                 const std::vector<std::string> &choices, const std::string &help)
{
  std::string names;
  for (const std::string &choice : choices) {
    names += (names.empty() ? "" : "|") + choice;
  }
  app.add_option(option, value, help)->type_name(names)->check([choices, names](const std::string &text) {
    const bool known = std::find(choices.begin(), choices.end(), text) != choices.end();
    return known ? std::string() : vpPrintable(text) + ", expected " + names;
  });
}

CLI::Option *vpAddCount(CLI::App &app, const std::string &option, size_t &count, const std::string &help,
                        size_t most)
{
  return app.add_option(option, count, help)
      ->type_name("N")
      ->check(wholeNumber(1, most, "from 1 to " + std::to_string(most)));
}

void vpAddSeed(CLI::App &app, const std::string &option, std::uint64_t &seed, const std::string &help)
{
  app.add_option(option, seed, help)
      ->type_name("N")
      ->check(wholeNumber(0, std::numeric_limits<std::uint64_t>::max(), "from 0 to 2^64 - 1"));
}

std::vector<double> vpNumbersOf(const std::string &option, const std::string &text, size_t count,
                                const std::string &expected)
{
  std::vector<double> values;
  bool good = true;
  for (size_t begin = 0; good && begin <= text.size();) {
    const size_t end = std::min(text.find(',', begin), text.size());
    double value = 0;
    good = vpParseNumber(text.substr(begin, end - begin), value) && std::isfinite(value);
    values.push_back(value);
    begin = end + 1;
  }
  if (!good || values.size() != count) {
    throw vpException(vpException::badValue, option + ": " + vpShown(text) + ", expected " + expected);
  }
  return values;
}

END_VISP_NAMESPACE
