#!/bin/sh
# A public header as Doxygen reads it: all of it belongs to its module's group, and a comment behind a member,
# `double height; // m`, is its documentation.
module=$(basename "$(dirname "$1")")
sed -E -e 's,;[[:space:]]*// ,; //!< ,' -e "s,^BEGIN_VISP_NAMESPACE,/*! \\\\addtogroup $module */ /*! \\\\{ */," \
  -e 's,^END_VISP_NAMESPACE,/*! \\} */,' "$1"
