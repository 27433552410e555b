/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_core/vpNewFolder.h>

#include <system_error>

#include <unistd.h>

#include <visp3/core/vpException.h>

BEGIN_VISP_NAMESPACE

namespace fs = std::filesystem;

vpNewFolder::vpNewFolder(const std::string &name)
{
  std::error_code error;
  m_name = fs::weakly_canonical(fs::path(name), error); // no name can be given to a link or to "."
  if (error) {
    throw vpException(vpException::ioError, name + ": the folder cannot be made: " + error.message());
  }
  if (!m_name.has_filename()) { // a/b/
    m_name = m_name.parent_path();
  }
  if (fs::exists(m_name, error) && !(fs::is_directory(m_name, error) && fs::is_empty(m_name, error))) {
    throw vpException(vpException::ioError, name + ": exists, expected a new or empty folder");
  }
  m_written = m_name;
  m_written += ".part-" + std::to_string(getpid());
  for (fs::path parent = m_name.parent_path(); !parent.empty() && !fs::exists(parent, error);
       parent = parent.parent_path()) {
    m_parents.push_back(parent);
  }
  if (!fs::create_directories(m_written, error) && !error) {
    error = std::make_error_code(std::errc::file_exists); // of a program that was killed
  }
  if (error) {
    removeParents();
    throw vpException(vpException::ioError, name + ": the folder cannot be made: " + error.message());
  }
}

vpNewFolder::~vpNewFolder()
{
  if (!m_written.empty()) {
    std::error_code ignored;
    fs::remove_all(m_written, ignored);
    removeParents();
  }
}

void vpNewFolder::commit()
{
  std::error_code error;
  fs::rename(m_written, m_name, error); // takes the place of an empty folder
  if (error) {
    throw vpException(vpException::ioError,
                      m_name.string() + ": the folder cannot be made: " + error.message());
  }
  m_written.clear();
}

void vpNewFolder::removeParents() const
{
  for (const fs::path &parent : m_parents) {
    std::error_code ignored; // somebody else may have put something there
    fs::remove(parent, ignored);
  }
}

END_VISP_NAMESPACE
