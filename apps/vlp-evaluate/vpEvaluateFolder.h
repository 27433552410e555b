/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpEvaluateFolder_h
#define vpEvaluateFolder_h

#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpAtomicFile.h>

BEGIN_VISP_NAMESPACE

//! Files of a folder, made in memory first, so that a failure leaves none of them.
class vpEvaluateFolder
{
public:
  //! Makes the folder where there is none, and tries whether a file can be written there.
  explicit vpEvaluateFolder(std::string folder) : m_folder(std::move(folder))
  {
    std::error_code error;
    m_made = std::filesystem::create_directories(m_folder, error);
    if (error) {
      throw vpException(vpException::ioError, m_folder + ": the folder cannot be made: " + error.message());
    }
    const vpAtomicFile probe(path("report.html")); // gone again, since it is not committed
  }

  //! A folder that was made for nothing goes again.
  ~vpEvaluateFolder()
  {
    std::error_code notEmpty;
    if (m_made) {
      std::filesystem::remove(m_folder, notEmpty);
    }
  }
  vpEvaluateFolder(const vpEvaluateFolder &) = delete;
  vpEvaluateFolder &operator=(const vpEvaluateFolder &) = delete;

  void add(const std::string &name, std::string bytes) { m_files.emplace_back(name, std::move(bytes)); }

  void write() const
  {
    for (const auto &[name, bytes] : m_files) {
      vpAtomicFile file(path(name));
      file.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
      file.commit();
    }
  }

private:
  std::string path(const std::string &name) const
  {
    return (std::filesystem::path(m_folder) / name).string();
  }

  std::string m_folder;
  bool m_made = false;
  std::vector<std::pair<std::string, std::string>> m_files;
};

END_VISP_NAMESPACE

#endif
