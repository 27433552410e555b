/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpReadGreyPicture_h
#define vpReadGreyPicture_h

#include <string>

#include <visp3/core/vpImage.h>
#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  Reads a picture (PNG, JPEG, BMP, PGM, TIFF and what else OpenCV knows) as 8-bit grey. Its pixels stay where
  the sensor had them: a rotation in the EXIF data is not applied. 8-bit grey is taken as it is, colour is
  converted to grey (0.299 R + 0.587 G + 0.114 B), 16 bits are scaled to 8 (divided by 257, rounded), an alpha
  channel is left out.

  \throw vpException (ioError) with one line that names the file where there is none, it is no picture, it has
  another depth, or it is cut short. OpenCV reads the rest of a JPEG that was cut short as if it were grey,
  without a warning.
*/
VISP_EXPORT void vpReadGreyPicture(const std::string &filename, vpImage<unsigned char> &I);

END_VISP_NAMESPACE

#endif
