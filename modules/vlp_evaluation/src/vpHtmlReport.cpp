/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_evaluation/vpHtmlReport.h>

#include <array>
#include <cstdio>
#include <utility>

#include <visp3/vlp_core/vpPrintable.h>
#include <visp3/vlp_evaluation/vpReportTable.h>

BEGIN_VISP_NAMESPACE

namespace
{
const char *const style = R"(
:root { color-scheme: light; --ink: #2b2f36; --soft: #626a76; --line: #dfe3e8; --accent: #2563a8; }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 68rem; padding: 1.25rem 1rem 3rem; color: var(--ink); background: #ffffff;
       font: 1rem/1.5 system-ui, "DejaVu Sans", Helvetica, Arial, sans-serif; }
header { border-bottom: 3px solid var(--accent); margin-bottom: 1.25rem; padding-bottom: 0.75rem; }
h1 { font-size: 1.6rem; line-height: 1.25; margin: 0 0 0.25rem; overflow-wrap: anywhere; }
h2 { font-size: 1.25rem; margin: 1.75rem 0 0.75rem; }
p { margin: 0.35rem 0; }
.source, figcaption, .note { color: var(--soft); font-size: 0.875rem; overflow-wrap: anywhere; }
.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(9rem, 1fr)); gap: 0.75rem; }
.tile { border: 1px solid var(--line); border-radius: 0.5rem; padding: 0.6rem 0.8rem; break-inside: avoid; }
.tile b { display: block; font-size: 1.45rem; line-height: 1.2; color: var(--accent); white-space: nowrap; }
.tile span { color: var(--soft); font-size: 0.8rem; }
.figures { display: grid; gap: 1.25rem;
           grid-template-columns: repeat(auto-fit, minmax(min(100%, 26rem), 1fr)); }
figure { margin: 0; padding: 0.6rem; border: 1px solid var(--line); border-radius: 0.5rem;
         break-inside: avoid; }
figure svg { display: block; width: 100%; height: auto; max-height: 34rem; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: 0.92rem; font-variant-numeric: tabular-nums; }
th, td { padding: 0.28rem 0.8rem 0.28rem 0; border-bottom: 1px solid var(--line); text-align: right; }
th { font-weight: 600; }
th:first-child { text-align: left; font-weight: 400; }
.tables { display: flex; flex-wrap: wrap; gap: 1.25rem 3.5rem; }
section { break-inside: avoid; max-width: 100%; }
.note { max-width: 36rem; }
h3 { font-size: 1rem; margin: 0 0 0.25rem; }
@media (max-width: 40rem) { table { font-size: 0.8rem; } th, td { padding-right: 0.5rem; } }
@media print {
  body { max-width: none; padding: 0; font-size: 10pt; }
  .figures { grid-template-columns: 1fr 1fr; gap: 0.5rem; }
  .scroll { overflow: visible; }
  @page { margin: 14mm; }
}
)";

//! Bytes of the UTF-8 character that begins at \e i; 0 where none does that XML allows.
size_t characterAt(const std::string &text, size_t i)
{
  const size_t length = vpUtf8Length(text, i);
  const unsigned char first = static_cast<unsigned char>(text[i]);
  const bool control = length == 1 && (first < 0x20 || first == 0x7f);
  const bool noCharacter =
      length == 3 && text.compare(i, 2, "\xEF\xBF") == 0 && static_cast<unsigned char>(text[i + 2]) >= 0xBE;
  return control || noCharacter ? 0 : length;
}

//! \e text as text of the page: no markup, no control characters, valid UTF-8.
std::string escaped(const std::string &text)
{
  static const std::array<std::pair<char, const char *>, 5> entities = {
      {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&#39;"}}};
  std::string html;
  for (size_t i = 0; i < text.size();) {
    const size_t length = characterAt(text, i);
    std::string character = length == 0 ? (static_cast<unsigned char>(text[i]) < 0x80 ? " " : "\xEF\xBF\xBD")
                                        : text.substr(i, length);
    for (const auto &[plain, entity] : entities) {
      if (length == 1 && text[i] == plain) {
        character = entity;
      }
    }
    html += character;
    i += length == 0 ? 1 : length;
  }
  return html;
}

std::string replaced(const std::string &text, const std::string &from, const std::string &to)
{
  std::string result;
  size_t begin = 0;
  for (size_t i; (i = text.find(from, begin)) != std::string::npos; begin = i + from.size()) {
    result.append(text, begin, i - begin).append(to);
  }
  return result.append(text, begin, std::string::npos);
}

//! The picture as an element of the page: without prologue, and with ids that no other figure has.
std::string inlined(const vpReportFigure &figure)
{
  const size_t begin = figure.svg.find("<svg");
  std::string svg = begin == std::string::npos ? std::string() : figure.svg.substr(begin);
  svg = replaced(svg, "\n xmlns:xlink=\"http://www.w3.org/1999/xlink\"", ""); // HTML's own href does
  svg = replaced(svg, "xlink:href=", "href=");
  for (const std::string quote : {"'", "\""}) {
    svg = replaced(svg, " id=" + quote, " id=" + quote + figure.name + "-");
    svg = replaced(svg, "href=" + quote + "#", "href=" + quote + "#" + figure.name + "-");
  }
  svg = replaced(svg, "url(#", "url(#" + figure.name + "-");
  return svg;
}

std::string html(const vpReportTable &table)
{
  std::string text = "<section>\n<h3>" + escaped(table.heading) + "</h3>\n<div class=\"scroll\"><table>\n";
  std::string head;
  bool headed = false;
  for (const std::string &column : table.columns) {
    head += "<th scope=\"col\">" + escaped(column) + "</th>";
    headed = headed || !column.empty();
  }
  text += headed ? "<thead><tr>" + head + "</tr></thead>\n<tbody>\n" : "<tbody>\n";
  for (const std::vector<std::string> &row : table.rows) {
    for (size_t i = 0; i < row.size(); ++i) {
      text +=
          i == 0 ? "<tr><th scope=\"row\">" + escaped(row[i]) + "</th>" : "<td>" + escaped(row[i]) + "</td>";
    }
    text += "</tr>\n";
  }
  text += "</tbody>\n</table></div>\n";
  return text + (table.note.empty() ? "" : "<p class=\"note\">" + escaped(table.note) + "</p>\n") +
         "</section>\n";
}

std::vector<vpReportTile> tilesOf(const vpEvaluation &evaluation)
{
  if (evaluation.pairs.empty()) {
    return {};
  }
  const auto millimetres = [](double metres) {
    std::array<char, 64> buffer;
    std::snprintf(buffer.data(), buffer.size(), "%.3g mm", 1000 * metres);
    return std::string(buffer.data());
  };
  std::vector<vpReportTile> tiles = {
      {millimetres(evaluation.horizontal.mean), "mean horizontal error"},
      {millimetres(evaluation.horizontal.percentile90), "90 % of the errors below"},
      {millimetres(evaluation.horizontal.percentile95), "95 % of the errors below"},
      {millimetres(evaluation.horizontal.largest), "largest horizontal error"},
      {millimetres(evaluation.dispersion.radius()), "dispersion radius"}};
  if (evaluation.fixes && evaluation.fixes->frames > 0) {
    std::array<char, 64> buffer;
    std::snprintf(buffer.data(), buffer.size(), "%.1f %%", 100 * evaluation.fixes->share());
    tiles.push_back({buffer.data(), "of the frames with a fix"});
    std::snprintf(buffer.data(), buffer.size(), "%.3g ms", 1000 * evaluation.fixes->compute.mean);
    tiles.push_back({buffer.data(), "mean time per frame"});
  }
  return tiles;
}
} // namespace

std::string vpHtmlReport(const std::string &title, const std::vector<std::string> &sources,
                         const vpEvaluation &evaluation, const std::vector<vpReportFigure> &figures)
{
  return vpHtmlPage(title, sources, tilesOf(evaluation), figures, vpTablesOf(evaluation));
}

std::string vpHtmlPage(const std::string &title, const std::vector<std::string> &sources,
                       const std::vector<vpReportTile> &tiles, const std::vector<vpReportFigure> &figures,
                       const std::vector<vpReportTable> &tables)
{
  std::string page = "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n"
                     "<meta charset=\"utf-8\"/>\n"
                     "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>" +
                     escaped(title) + "</title>\n<style>" + style +
                     "</style>\n</head>\n<body>\n<header>\n<h1>" + escaped(title) + "</h1>\n";
  for (const std::string &source : sources) {
    page += "<p class=\"source\">" + escaped(source) + "</p>\n";
  }
  page += "</header>\n<main>\n";
  if (!tiles.empty()) {
    page += "<div class=\"tiles\">\n";
    for (const vpReportTile &tile : tiles) {
      page += "<div class=\"tile\"><b>" + escaped(tile.value) + "</b><span>" + escaped(tile.meaning) +
              "</span></div>\n";
    }
    page += "</div>\n";
  }
  if (!figures.empty()) {
    page += "<h2>Figures</h2>\n<div class=\"figures\">\n";
    for (const vpReportFigure &figure : figures) {
      page += "<figure>\n" + inlined(figure) + "<figcaption>" + escaped(figure.caption) +
              "</figcaption>\n</figure>\n";
    }
    page += "</div>\n";
  }
  page += "<h2>Numbers</h2>\n<div class=\"tables\">\n";
  for (const vpReportTable &table : tables) {
    page += html(table);
  }
  return page + "</div>\n</main>\n</body>\n</html>\n";
}

END_VISP_NAMESPACE
