/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_evaluation/vpGnuplot.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#ifndef _WIN32
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#endif

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_core/vpReadFile.h>

BEGIN_VISP_NAMESPACE

namespace
{
namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string &problem)
{
  throw vpException(vpException::ioError, "gnuplot: " + problem);
}

#ifdef _WIN32
std::string run(const std::string &)
{
  fail("cannot be run by this build, which is for Windows; figures need Linux or macOS");
}
#else
//! A new folder that is gone at the end.
class WorkFolder
{
public:
  WorkFolder()
  {
    std::error_code error;
    const fs::path parent = fs::temp_directory_path(error);
    std::string pattern = ((error ? fs::path("/tmp") : parent) / "vlp-gnuplot-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) {
      fail("no folder for its files: " + pattern + ": " + std::generic_category().message(errno));
    }
    m_path = pattern;
  }
  ~WorkFolder()
  {
    std::error_code ignored;
    fs::remove_all(m_path, ignored);
  }
  WorkFolder(const WorkFolder &) = delete;
  WorkFolder &operator=(const WorkFolder &) = delete;

  std::string operator/(const char *name) const { return (m_path / name).string(); }

private:
  fs::path m_path;
};

//! Starts gnuplot and waits for its end. \return As waitpid gives it.
int statusOf(const std::string &script, const std::string &out, const std::string &err)
{
  // Without the user's own settings, that figures look alike everywhere.
  std::vector<std::string> words = {"gnuplot", "--default-settings", script};
  std::vector<char *> pointers;
  for (std::string &word : words) {
    pointers.push_back(word.data());
  }
  pointers.push_back(nullptr);

  constexpr int create = O_WRONLY | O_CREAT | O_TRUNC;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), create, 0600);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), create, 0600);
  pid_t id = 0;
  const int error = posix_spawnp(&id, "gnuplot", &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    fail("cannot be run: " + std::generic_category().message(error) +
         "; it draws the figures, install it (Debian: gnuplot-nox)");
  }
  int status = 0;
  while (waitpid(id, &status, 0) < 0) {
    if (errno != EINTR) {
      fail("cannot be waited for: " + std::generic_category().message(errno));
    }
  }
  return status;
}

//! The line of gnuplot's complaint that says what is wrong: the last that is not blank.
std::string lastLine(const std::string &text)
{
  const size_t end = text.find_last_not_of(" \t\r\n");
  if (end == std::string::npos) {
    return "no message";
  }
  const size_t before = text.find_last_of('\n', end);
  const size_t begin = before == std::string::npos ? 0 : before + 1;
  return vpShown(text.substr(begin, end + 1 - begin));
}

std::string run(const std::string &script)
{
  const WorkFolder folder;
  const std::string name = folder / "script", out = folder / "out", err = folder / "err";
  std::ofstream file(name, std::ios::binary);
  file << script;
  file.close();
  if (!file) {
    fail(name + ": the script cannot be written");
  }
  const int status = statusOf(name, out, err);
  if (WIFSIGNALED(status)) {
    fail("ended by signal " + std::to_string(WTERMSIG(status)));
  }
  if (WEXITSTATUS(status) != 0) {
    fail("exit code " + std::to_string(WEXITSTATUS(status)) + ": " + lastLine(vpReadFile(err)));
  }
  return vpReadFile(out);
}
#endif
} // namespace

void vpGnuplot::check()
{
  run("");
}

std::string vpGnuplot::draw(const std::string &script)
{
  std::string bytes = run(script);
  if (bytes.empty()) {
    fail("it drew nothing");
  }
  return bytes;
}

std::string vpGnuplot::quoted(const std::string &text)
{
  std::string string = "'";
  for (const char c : text) {
    const bool control = static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
    // gnuplot's own way, two quotes for one, fails at the beginning of a string.
    string += c == '\'' ? std::string("\xE2\x80\x99") : std::string(1, control ? ' ' : c);
  }
  return string + "'";
}

END_VISP_NAMESPACE
