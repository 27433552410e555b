/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_core/vpYamlNode.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>
#include <visp3/vlp_core/vpPrintable.h>
#include <visp3/vlp_core/vpReadFile.h>

BEGIN_VISP_NAMESPACE

namespace
{
struct Entry {
  YAML::Node value;
  int line = 0; // of the key
  bool asked = false;
};

[[noreturn]] void failAt(const std::string &filename, int line, const std::string &message)
{
  const std::string place = line > 0 ? ":" + std::to_string(line) : "";
  throw vpException(vpException::badValue, vpPrintable(filename) + place + ": " + message);
}

//! yaml-cpp counts lines from 0, and gives -1 where it knows none.
int lineOf(const YAML::Node &node)
{
  return node.Mark().line + 1;
}

//! yaml-cpp tags quoted text "!", plain text "?".
bool isQuoted(const YAML::Node &node)
{
  return node.IsScalar() && node.Tag() == "!";
}

//! What came, for a message.
std::string described(const YAML::Node &node)
{
  switch (node.Type()) {
  case YAML::NodeType::Scalar:
    return isQuoted(node) ? "\"" + vpShown(node.Scalar()) + "\"" : vpShown(node.Scalar());
  case YAML::NodeType::Sequence:
    return "a list of " + std::to_string(node.size());
  case YAML::NodeType::Map:
    return "a mapping";
  default:
    return "nothing";
  }
}

std::string expected(vpYamlNode::Range range)
{
  switch (range) {
  case vpYamlNode::Range::positive:
    return "a number above 0";
  case vpYamlNode::Range::notNegative:
    return "a number of 0 or more";
  case vpYamlNode::Range::openUnit:
    return "a number between 0 and 1 (both excluded)";
  case vpYamlNode::Range::any:
    break;
  }
  return "a finite number";
}

bool isWithin(double value, vpYamlNode::Range range)
{
  switch (range) {
  case vpYamlNode::Range::positive:
    return value > 0;
  case vpYamlNode::Range::notNegative:
    return value >= 0;
  case vpYamlNode::Range::openUnit:
    return value > 0 && value < 1;
  case vpYamlNode::Range::any:
    break;
  }
  return true;
}

//! Whether it can be written: all other bytes would become one and the same character.
bool isUtf8(const std::string &text)
{
  size_t i = 0;
  while (const size_t length = vpUtf8Length(text, i)) {
    i += length;
  }
  return i == text.size();
}

bool readNumber(const YAML::Node &node, vpYamlNode::Range range, double &value)
{
  return node.IsScalar() && !isQuoted(node) && vpParseNumber(node.Scalar(), value) && std::isfinite(value) &&
         isWithin(value, range);
}

/*!
  The lines at which a text's first two documents begin. yaml-cpp reads the first or all, of which it finds
  ever more where a comma stands in the place of one.
*/
struct DocumentLines : YAML::EventHandler {
  static DocumentLines of(const std::string &text)
  {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    DocumentLines documents;
    while (documents.lines.size() < 2 && parser.HandleNextDocument(documents)) {
    }
    return documents;
  }

  void OnDocumentStart(const YAML::Mark &mark) override { lines.push_back(mark.line + 1); }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark &, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark &, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark &, const std::string &, YAML::anchor_t, const std::string &) override {}
  void OnSequenceStart(const YAML::Mark &, const std::string &, YAML::anchor_t,
                       YAML::EmitterStyle::value) override
  {
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark &, const std::string &, YAML::anchor_t, YAML::EmitterStyle::value) override
  {
  }
  void OnMapEnd() override {}

  std::vector<int> lines;
};

std::string listed(const std::vector<std::string> &words)
{
  std::string text;
  for (const std::string &word : words) {
    text += (text.empty() ? "" : ", ") + word;
  }
  return text;
}
} // namespace

struct vpYamlNode::Impl {
  std::string filename;
  std::string path; // of the mapping in the file, empty at the top
  int line = 1;
  std::vector<std::pair<std::string, Entry>> entries; // in the file's order
  std::vector<std::string> known;                     // every key that somebody asked about

  //! A mapping at \e path. \e node is known to be one.
  static std::shared_ptr<Impl> of(const YAML::Node &node, const std::string &filename,
                                  const std::string &path)
  {
    auto impl = std::make_shared<Impl>();
    impl->filename = filename;
    impl->path = path;
    impl->line = std::max(lineOf(node), 1);
    for (const auto &pair : node) {
      if (!pair.first.IsScalar()) {
        failAt(filename, lineOf(pair.first),
               impl->field("") + described(pair.first) + " as a key, expected a name");
      }
      const std::string &key = pair.first.Scalar();
      if (impl->find(key)) {
        failAt(filename, lineOf(pair.first), impl->field(key) + "twice, expected once");
      }
      impl->entries.emplace_back(key, Entry{pair.second, lineOf(pair.first), false});
    }
    return impl;
  }

  std::string pathOf(const std::string &key) const
  {
    return key.empty() ? path : (path.empty() ? "" : path + ".") + vpShown(key);
  }

  //! How an error message begins.
  std::string field(const std::string &key) const
  {
    const std::string name = pathOf(key);
    return name.empty() ? "" : name + ": ";
  }

  Entry *find(const std::string &key)
  {
    const auto found = std::find_if(entries.begin(), entries.end(),
                                    [&key](const auto &entry) { return entry.first == key; });
    return found == entries.end() ? nullptr : &found->second;
  }

  void know(const std::string &key)
  {
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      known.push_back(key);
    }
  }

  //! The value of \e key, or nullptr where it is left out.
  const YAML::Node *ask(const std::string &key)
  {
    know(key);
    Entry *entry = find(key);
    if (!entry) {
      return nullptr;
    }
    entry->asked = true;
    return &entry->value;
  }

  const YAML::Node &need(const std::string &key, const std::string &what)
  {
    const YAML::Node *node = ask(key);
    if (!node) {
      failAt(filename, line, field(key) + "missing, expected " + what);
    }
    return *node;
  }

  //! Line of a value of \e key; where it has none, as an empty one, the key's.
  int lineFor(const YAML::Node &node, const std::string &key)
  {
    const Entry *entry = find(key);
    const bool known = lineOf(node) > 0 && !node.IsNull();
    return known || !entry ? lineOf(node) : entry->line;
  }

  [[noreturn]] void wrong(const std::string &key, const YAML::Node &node, const std::string &what)
  {
    failAt(filename, lineFor(node, key), field(key) + described(node) + ", expected " + what);
  }
};

vpYamlNode::vpYamlNode(std::shared_ptr<Impl> impl) : m_impl(std::move(impl)) {}

vpYamlNode vpYamlNode::load(const std::string &filename)
{
  const std::string text = vpReadFile(filename);
  YAML::Node document;
  DocumentLines documents;
  try {
    documents = DocumentLines::of(text);
    document = YAML::Load(text);
  } catch (const YAML::Exception &error) {
    failAt(filename, error.mark.line + 1, "not YAML: " + vpShown(error.msg));
  }
  if (document.IsNull()) {
    failAt(filename, 1, "nothing, expected a mapping");
  }
  if (documents.lines.size() > 1) {
    failAt(filename, documents.lines[1], "a second document, expected one");
  }
  if (!document.IsMap()) {
    failAt(filename, lineOf(document), described(document) + ", expected a mapping");
  }
  return vpYamlNode(Impl::of(document, filename, ""));
}

bool vpYamlNode::has(const std::string &key) const
{
  m_impl->know(key);
  return m_impl->find(key) != nullptr;
}

double vpYamlNode::number(const std::string &key, Range range) const
{
  const YAML::Node &node = m_impl->need(key, expected(range));
  double value = 0;
  if (!readNumber(node, range, value)) {
    m_impl->wrong(key, node, expected(range));
  }
  return value;
}

double vpYamlNode::number(const std::string &key, Range range, double valueIfLeftOut) const
{
  return has(key) ? number(key, range) : valueIfLeftOut;
}

bool vpYamlNode::boolean(const std::string &key) const
{
  const YAML::Node &node = m_impl->need(key, "true or false");
  const bool isTrue = node.IsScalar() && !isQuoted(node) && node.Scalar() == "true";
  if (!isTrue && !(node.IsScalar() && !isQuoted(node) && node.Scalar() == "false")) {
    m_impl->wrong(key, node, "true or false");
  }
  return isTrue;
}

std::string vpYamlNode::text(const std::string &key) const
{
  const YAML::Node &node = m_impl->need(key, "text");
  if (!node.IsScalar() || node.Scalar().empty()) {
    m_impl->wrong(key, node, "text");
  }
  if (!isUtf8(node.Scalar())) {
    m_impl->wrong(key, node, "text in UTF-8");
  }
  return node.Scalar();
}

std::string vpYamlNode::text(const std::string &key, const std::string &valueIfLeftOut) const
{
  return has(key) ? text(key) : valueIfLeftOut;
}

size_t vpYamlNode::choice(const std::string &key, const std::vector<std::string> &choices) const
{
  const std::string what = (choices.size() > 1 ? "one of " : "") + listed(choices);
  const YAML::Node &node = m_impl->need(key, what);
  const auto found =
      node.IsScalar() ? std::find(choices.begin(), choices.end(), node.Scalar()) : choices.end();
  if (found == choices.end()) {
    m_impl->wrong(key, node, what);
  }
  return static_cast<size_t>(found - choices.begin());
}

std::vector<double> vpYamlNode::numbers(const std::string &key, size_t count, Range range) const
{
  const std::string what = std::to_string(count) + " numbers";
  const YAML::Node &node = m_impl->need(key, what);
  if (!node.IsSequence() || node.size() != count) {
    m_impl->wrong(key, node, what);
  }
  std::vector<double> values(count);
  for (size_t i = 0; i < count; ++i) {
    if (!readNumber(node[i], range, values[i])) {
      failAt(m_impl->filename, m_impl->lineFor(node[i], key),
             m_impl->pathOf(key) + "[" + std::to_string(i) + "]: " + described(node[i]) + ", expected " +
                 expected(range));
    }
  }
  return values;
}

std::vector<std::vector<double>> vpYamlNode::numberLists(const std::string &key, size_t count) const
{
  const std::string what = "a list of " + std::to_string(count) + " numbers";
  const YAML::Node &node = m_impl->need(key, "a list, each entry of it " + what);
  if (!node.IsSequence()) {
    m_impl->wrong(key, node, "a list, each entry of it " + what);
  }
  std::vector<std::vector<double>> lists(node.size(), std::vector<double>(count));
  for (size_t i = 0; i < node.size(); ++i) {
    bool good = node[i].IsSequence() && node[i].size() == count;
    for (size_t k = 0; good && k < count; ++k) {
      good = readNumber(node[i][k], Range::any, lists[i][k]);
    }
    if (!good) {
      failAt(m_impl->filename, m_impl->lineFor(node[i], key),
             m_impl->pathOf(key) + "[" + std::to_string(i) + "]: " + described(node[i]) + ", expected " +
                 what);
    }
  }
  return lists;
}

unsigned int vpYamlNode::wholeNumber(const std::string &key, unsigned int least) const
{
  const std::string what = "a whole number of " + std::to_string(least) + " or more";
  const YAML::Node &node = m_impl->need(key, what);
  double value = 0;
  if (!readNumber(node, Range::any, value) || value != std::floor(value) || value < least ||
      value > std::numeric_limits<unsigned int>::max()) {
    m_impl->wrong(key, node, what);
  }
  return static_cast<unsigned int>(value);
}

vpYamlNode vpYamlNode::mapping(const std::string &key) const
{
  const YAML::Node &node = m_impl->need(key, "a mapping");
  if (!node.IsMap()) {
    m_impl->wrong(key, node, "a mapping");
  }
  return vpYamlNode(Impl::of(node, m_impl->filename, m_impl->pathOf(key)));
}

std::vector<vpYamlNode> vpYamlNode::mappings(const std::string &key) const
{
  const std::string what = "a list of mappings";
  const YAML::Node &node = m_impl->need(key, what);
  if (!node.IsSequence()) {
    m_impl->wrong(key, node, what);
  }
  std::vector<vpYamlNode> nodes;
  for (size_t i = 0; i < node.size(); ++i) {
    const std::string path = m_impl->pathOf(key) + "[" + std::to_string(i) + "]";
    if (!node[i].IsMap()) {
      failAt(m_impl->filename, m_impl->lineFor(node[i], key),
             path + ": " + described(node[i]) + ", expected a mapping");
    }
    nodes.push_back(vpYamlNode(Impl::of(node[i], m_impl->filename, path)));
  }
  return nodes;
}

void vpYamlNode::finish() const
{
  for (const auto &[key, entry] : m_impl->entries) {
    if (!entry.asked) {
      failAt(m_impl->filename, entry.line,
             m_impl->field(key) + "unknown key, expected one of " + listed(m_impl->known));
    }
  }
}

void vpYamlNode::fail(const std::string &key, const std::string &problem) const
{
  const Entry *entry = key.empty() ? nullptr : m_impl->find(key);
  int line = m_impl->line;
  if (entry) {
    line = m_impl->lineFor(entry->value, key);
  }
  failAt(m_impl->filename, line, m_impl->field(key) + problem);
}

const std::string &vpYamlNode::filename() const
{
  return m_impl->filename;
}

std::string vpYamlNode::quoted(const std::string &text)
{
  const auto isLetter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const auto isPlain = [&isLetter](char c) {
    return isLetter(c) || (c >= '0' && c <= '9') || c == '.' || c == '/' || c == '-';
  };
  if (!text.empty() && isLetter(text[0]) && std::all_of(text.begin(), text.end(), isPlain)) {
    std::string lower = text;
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    const std::vector<std::string> reserved = {"null", "true", "false", "yes", "no", "on", "off", "y", "n"};
    if (std::find(reserved.begin(), reserved.end(), lower) == reserved.end()) {
      return text;
    }
  }
  std::ostringstream stream;
  YAML::Emitter emitter(stream);
  emitter << YAML::DoubleQuoted << text;
  return stream.str();
}

END_VISP_NAMESPACE
