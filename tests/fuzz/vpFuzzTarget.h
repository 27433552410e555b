/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpFuzzTarget_h
#define vpFuzzTarget_h

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <visp3/core/vpException.h>

#include "common/vpTemporaryFolder.h"

#ifdef ENABLE_VISP_NAMESPACE
using namespace VISP_NAMESPACE_NAME;
#endif

/*!
  A function that takes any bytes, and ends the process where they break something: with libFuzzer in
  fuzz_<name>, with what it has found so far in the test FuzzFindings.

  \code
  VLP_FUZZ_TARGET(path)
  {
    const std::string file = vpFuzzFile("path.yaml", data, size);
    vpFuzzReads([&] { vpPath::load(file); });
  }
  \endcode
*/
struct vpFuzzTarget {
  using Function = void (*)(const std::uint8_t *data, size_t size);

  std::string name;
  Function function;

  //! Those of this program.
  static std::vector<vpFuzzTarget> &all()
  {
    static std::vector<vpFuzzTarget> targets;
    return targets;
  }
  static bool add(const char *name, Function function)
  {
    all().push_back({name, function});
    return true;
  }
};

#define VLP_FUZZ_TARGET(name)                                                                                \
  static void vpFuzz_##name(const std::uint8_t *data, size_t size);                                          \
  static const bool vpFuzzAdded_##name = vpFuzzTarget::add(#name, vpFuzz_##name);                            \
  static void vpFuzz_##name(const std::uint8_t *data, size_t size)

//! Ends the process where that does not hold.
inline void vpFuzzExpect(bool holds, const std::string &what)
{
  if (!holds) {
    std::fprintf(stderr, "fuzz target: expected %s\n", what.c_str());
    std::abort();
  }
}

//! A file with these bytes, in a folder that is gone at the end of the process. \return Its path.
inline std::string vpFuzzFile(const std::string &name, const void *data, size_t size)
{
  static const vpTemporaryFolder folder;
  return folder.write(name, std::string(static_cast<const char *>(data), size));
}

/*!
  Calls \e read. Nothing but a vpException may come of it, and that says in one line what is wrong.
  \return Whether none came.
*/
template <class Read>
bool vpFuzzReads(Read read)
{
  try {
    read();
    return true;
  } catch (const vpException &error) {
    const std::string line = error.getStringMessage();
    vpFuzzExpect(!line.empty() && std::none_of(line.begin(), line.end(),
                                               [](char c) { return static_cast<unsigned char>(c) < 0x20; }),
                 "one line of text in place of: " + line);
    return false;
  }
}

/*!
  What was read can be written, and read again, and is the same then. \param load Reads a file and returns
  what can save() itself. \param ending Of the files' names. \param exact To the last bit.
*/
template <class Load>
void vpFuzzReadsBack(const std::string &file, const std::string &ending, Load load, bool exact = true)
{
  vpFuzzReads([&] {
    const auto read = load(file);
    const std::string once = vpFuzzFile("once" + ending, "", 0), twice = vpFuzzFile("twice" + ending, "", 0);
    const auto bytes = [](const std::string &name) {
      std::ifstream stream(name, std::ios::binary);
      return std::string{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
    };
    std::remove(once.c_str());
    std::remove(twice.c_str());
    read.save(once);
    bool again = false;
    std::string problem;
    try {
      load(once).save(twice);
      again = true;
    } catch (const vpException &error) {
      problem = error.getStringMessage();
    }
    vpFuzzExpect(again, "to read what was written: " + problem);
    vpFuzzExpect(!exact || bytes(once) == bytes(twice), "the same file once more");
  });
}

#endif
