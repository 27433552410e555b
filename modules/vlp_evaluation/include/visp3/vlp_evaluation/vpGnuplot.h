/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpGnuplot_h
#define vpGnuplot_h

#include <string>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  gnuplot as a process of its own, started without a shell. A script reaches it as a file, and what it draws
  comes back by its stdout, so that no name of a file is ever part of a script.
*/
class VISP_EXPORT vpGnuplot
{
public:
  //! \throw vpException (ioError) with one line that says what to install where gnuplot cannot be run.
  static void check();

  /*!
    Runs a script that sets its terminal, and no output. \return The bytes drawn. \throw vpException (ioError)
    with one line where gnuplot cannot be run, or refuses the script.
  */
  static std::string draw(const std::string &script);

  /*!
    \e text (UTF-8) as a string of a script, in which nothing is special: in single quotes, those in it as the
    typographic ones, control characters as blanks. Markup is on in gnuplot unless the terminal is set
    `noenhanced`.
  */
  static std::string quoted(const std::string &text);
};

END_VISP_NAMESPACE

#endif
