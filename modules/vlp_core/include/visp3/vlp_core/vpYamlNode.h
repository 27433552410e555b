/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpYamlNode_h
#define vpYamlNode_h

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <visp3/vlp_core/vpVlpNamespace.h>

BEGIN_VISP_NAMESPACE

/*!
  Strict reading of a YAML mapping: each key is asked for once by name, and finish() refuses keys that were
  not asked for. Every error is a vpException whose one line names file, line, field, what came and what was
  expected.
*/
class VISP_EXPORT vpYamlNode
{
public:
  //! What a number may be. All are finite.
  enum class Range { any, positive, notNegative, openUnit };

  //! Parses \e filename, whose top must be a mapping.
  static vpYamlNode load(const std::string &filename);

  bool has(const std::string &key) const;
  double number(const std::string &key, Range range = Range::any) const;
  double number(const std::string &key, Range range, double valueIfLeftOut) const;
  bool boolean(const std::string &key) const;
  std::string text(const std::string &key) const;
  std::string text(const std::string &key, const std::string &valueIfLeftOut) const;
  //! Index of the value among \e choices.
  size_t choice(const std::string &key, const std::vector<std::string> &choices) const;
  //! Exactly \e count numbers.
  std::vector<double> numbers(const std::string &key, size_t count, Range range = Range::any) const;
  //! A list of lists of exactly \e count numbers each, as points are written.
  std::vector<std::vector<double>> numberLists(const std::string &key, size_t count) const;
  unsigned int wholeNumber(const std::string &key, unsigned int least = 0) const;
  vpYamlNode mapping(const std::string &key) const;
  std::vector<vpYamlNode> mappings(const std::string &key) const;

  //! Refuses keys that were never asked for.
  void finish() const;

  //! Throws the one-line error about \e key (or the mapping itself where key is empty): \e problem.
  [[noreturn]] void fail(const std::string &key, const std::string &problem) const;

  //! File that the node came from.
  const std::string &filename() const;

  //! \e text as a scalar that text() reads back, in quotes where YAML needs them.
  static std::string quoted(const std::string &text);

private:
  struct Impl;
  explicit vpYamlNode(std::shared_ptr<Impl> impl);
  std::shared_ptr<Impl> m_impl;
};

END_VISP_NAMESPACE

#endif
