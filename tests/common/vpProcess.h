/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpProcess_h
#define vpProcess_h

#include <csignal>
#include <stdexcept>
#include <string>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/vpTemporaryFolder.h"

/*!
  A program of this project (build/bin), run as a user runs it: without a terminal, its output kept.
  VLP_EMULATOR: the words before it where it is of another processor; else nothing.
*/
class vpProcess
{
public:
  explicit vpProcess(const std::string &program, const std::vector<std::string> &arguments = {},
                     const std::string &stdoutFile = "", const std::string &stdinFile = "/dev/null")
  {
    std::vector<std::string> words = {VLP_EMULATOR};
    words.push_back(std::string(VLP_BIN_DIR) + "/" + program);
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char *> pointers;
    for (std::string &word : words) {
      pointers.push_back(word.data());
    }
    pointers.push_back(nullptr);

    const std::string out = stdoutFile.empty() ? m_folder / "out" : stdoutFile, err = m_folder / "err";
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, stdinFile.c_str(), O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT, 0600);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT, 0600);
    posix_spawnattr_t attributes; // Ctrl-C works even where the tests run in the background
    posix_spawnattr_init(&attributes);
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    posix_spawnattr_setsigdefault(&attributes, &signals);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
    const int error = posix_spawnp(&m_id, words[0].c_str(), &actions, &attributes, pointers.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) {
      throw std::runtime_error(words[0] + " cannot be run");
    }
  }
  ~vpProcess()
  {
    if (!m_ended) {
      kill(m_id, SIGKILL);
      wait();
    }
  }
  vpProcess(const vpProcess &) = delete;
  vpProcess &operator=(const vpProcess &) = delete;

  void signal(int number) const { kill(m_id, number); }

  //! Waits for its end. \return Its exit code, or minus the signal that ended it.
  int wait()
  {
    if (!m_ended) {
      waitpid(m_id, &m_status, 0);
      m_ended = true;
    }
    return WIFEXITED(m_status) ? WEXITSTATUS(m_status) : -WTERMSIG(m_status);
  }

  //! Whether it has come to its end.
  bool ended()
  {
    m_ended = m_ended || waitpid(m_id, &m_status, WNOHANG) == m_id;
    return m_ended;
  }

  std::string out() const { return m_folder.read("out"); }
  std::string err() const { return m_folder.read("err"); }

private:
  vpTemporaryFolder m_folder;
  pid_t m_id = 0;
  int m_status = 0;
  bool m_ended = false;
};

#endif
