/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpMarkup_h
#define vpMarkup_h

#include <algorithm>
#include <cctype>
#include <set>
#include <string>
#include <vector>

/*!
  What is wrong with a page of HTML that claims to be well-formed as XML too, and to need no other file; empty
  where nothing is. It knows elements, attributes in quotes, entities and comments.
*/
inline std::string vpMarkupProblem(const std::string &page)
{
  std::vector<std::string> open;
  std::set<std::string> ids, wanted;
  for (size_t i = 0; i < page.size();) {
    if (page[i] == '&') {
      const size_t end = page.find(';', i);
      if (end == std::string::npos || end - i > 8) {
        return "a bare & at " + page.substr(i, 40);
      }
    }
    if (page[i] != '<') {
      ++i;
      continue;
    }
    size_t end = i + 1;
    for (char quote = 0; end < page.size() && (page[end] != '>' || quote != 0); ++end) {
      if (page[end] == '<') {
        return "a bare < in " + page.substr(i, 80);
      }
      quote = quote == page[end]
                  ? 0
                  : (quote == 0 && (page[end] == '"' || page[end] == '\'') ? page[end] : quote);
    }
    const std::string tag = page.substr(i + 1, end - i - 1);
    i = end + 1;
    const size_t blank = std::min(tag.find_first_of(" \t\r\n/", 1), tag.size());
    const std::string name = tag.substr(0, blank);
    if (tag[0] == '!') {
      continue; // the document type
    }
    if (tag[0] == '/') {
      if (open.empty() || open.back() != tag.substr(1)) {
        return "<" + tag + "> closes " + (open.empty() ? "nothing" : "<" + open.back() + ">");
      }
      open.pop_back();
      continue;
    }
    if (std::isalpha(static_cast<unsigned char>(tag[0])) == 0) {
      return "no element: <" + tag + ">";
    }
    if (tag.back() != '/') {
      open.push_back(name);
    }
    if (name == "script" || name == "link" || name == "iframe" || name == "img") {
      return "an element that can load another file: <" + tag + ">";
    }
    for (const std::string attribute : {" id=", "href=", " src="}) {
      const size_t at = tag.find(attribute);
      if (at == std::string::npos) {
        continue;
      }
      const size_t begin = at + attribute.size() + 1;
      const std::string value = tag.substr(begin, tag.find(tag[begin - 1], begin) - begin);
      if (attribute == " id=" && !ids.insert(value).second) {
        return "the id " + value + " twice";
      }
      if (attribute != " id=" && (value.empty() || value[0] != '#')) {
        return "a reference to another file: <" + tag + ">";
      }
      if (attribute == "href=") {
        wanted.insert(value.substr(1));
      }
    }
  }
  for (const std::string &id : wanted) {
    if (ids.count(id) == 0) {
      return "a reference to #" + id + ", which there is not";
    }
  }
  for (const std::string part : {"@import", "url(h", "url('h", "url(\"h", "url(/"}) {
    if (page.find(part) != std::string::npos) {
      return "a style that loads another file: " + part;
    }
  }
  return open.empty() ? "" : "<" + open.back() + "> stays open";
}

#endif
