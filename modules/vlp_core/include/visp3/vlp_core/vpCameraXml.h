/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpCameraXml_h
#define vpCameraXml_h

#include <string>

#include <visp3/core/vpCameraParameters.h>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  One camera of a ViSP camera XML, the files that vpXmlParserCamera reads and writes. That class prints on
  stdout even without an error, reports errors on stderr without file or line, and reads a malformed number
  as 0. This one prints nothing and throws.
*/
struct VISP_EXPORT vpCameraXml {
  std::string name;
  vpCameraParameters camera; // perspective with or without distortion, or Kannala-Brandt
  unsigned int width = 0;    // pixels of the picture that the parameters are for
  unsigned int height = 0;

  /*!
    Reads the camera \e name, which must be there once, with one projection model.
    \throw vpException with one line that names file, line, field, what came and what was expected.
  */
  static vpCameraXml load(const std::string &filename, const std::string &name);

  /*!
    Writes a file with this camera alone, to a temporary name first. Where the file exists and holds just
    this, it stays as it is. \throw vpException where the file exists and holds anything else than one camera
    of this name.
  */
  void save(const std::string &filename) const;
};

END_VISP_NAMESPACE

#endif
