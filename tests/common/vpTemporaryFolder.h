/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpTemporaryFolder_h
#define vpTemporaryFolder_h

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

//! A new, empty folder that is gone with everything in it at the end of the test.
class vpTemporaryFolder
{
public:
  vpTemporaryFolder()
  {
    static std::atomic<unsigned int> count{0};
    const auto now = std::chrono::steady_clock::now().time_since_epoch().count(); // tests run side by side
    do {
      m_path = std::filesystem::temp_directory_path() /
               ("vlp-test-" + std::to_string(now) + "-" + std::to_string(count++));
    } while (!std::filesystem::create_directory(m_path));
  }
  ~vpTemporaryFolder()
  {
    std::error_code ignored;
    std::filesystem::remove_all(m_path, ignored);
  }
  vpTemporaryFolder(const vpTemporaryFolder &) = delete;
  vpTemporaryFolder &operator=(const vpTemporaryFolder &) = delete;

  std::string path() const { return m_path.string(); }
  std::string operator/(const std::string &name) const { return (m_path / name).string(); }

  //! Writes a file of the folder and returns its path.
  std::string write(const std::string &name, const std::string &bytes) const
  {
    std::ofstream(m_path / name, std::ios::binary) << bytes;
    return *this / name;
  }

  //! Bytes of a file of the folder.
  std::string read(const std::string &name) const
  {
    std::ifstream file(m_path / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  //! Number of files and folders in it.
  size_t count() const
  {
    return static_cast<size_t>(std::distance(std::filesystem::directory_iterator(m_path), {}));
  }

private:
  std::filesystem::path m_path;
};

#endif
