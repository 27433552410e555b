/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpNewFolder_h
#define vpNewFolder_h

#include <filesystem>
#include <string>
#include <vector>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  A folder that is filled under another name beside it, and gets its own by commit(); without it, it goes
  away, with the folders above that were made for it.
*/
class VISP_EXPORT vpNewFolder
{
public:
  //! \throw vpException (ioError) where there is something of that name already, unless it is an empty
  //! folder, or the folder cannot be made.
  explicit vpNewFolder(const std::string &name);
  ~vpNewFolder();
  vpNewFolder(const vpNewFolder &) = delete;
  vpNewFolder &operator=(const vpNewFolder &) = delete;

  //! Path of a file of it, to be written before commit().
  std::string file(const std::string &name) const { return (m_written / name).string(); }

  //! \throw vpException (ioError) where it cannot be given its name.
  void commit();

private:
  void removeParents() const;

  std::filesystem::path m_name, m_written;
  std::vector<std::filesystem::path> m_parents; // that were made for it, the innermost first
};

END_VISP_NAMESPACE

#endif
