/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLocateSummary.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include <spdlog/spdlog.h>

BEGIN_VISP_NAMESPACE

namespace
{
//! \e text with every run of digits as one #.
std::string withoutNumbers(const std::string &text)
{
  std::string shape;
  for (const char c : text) {
    const bool digit = std::isdigit(static_cast<unsigned char>(c)) != 0;
    if (!digit || shape.empty() || shape.back() != '#') {
      shape += digit ? '#' : c;
    }
  }
  return shape;
}

std::string counted(size_t count, const std::string &thing)
{
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}
} // namespace

void vpReasonCount::add(const std::string &reason)
{
  Entry &entry = m_entries[withoutNumbers(reason)];
  if (entry.count++ == 0) {
    entry.first = reason.empty() ? "no reason given" : reason;
  }
}

std::string vpReasonCount::text() const
{
  constexpr size_t most = 5;
  std::vector<Entry> entries;
  for (const auto &[shape, entry] : m_entries) {
    entries.push_back(entry);
  }
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry &one, const Entry &other) { return one.count > other.count; });
  std::string text;
  size_t others = 0;
  for (size_t i = 0; i < entries.size(); ++i) {
    if (i < most) {
      text += (i == 0 ? "" : "; ") + entries[i].first + " (" + std::to_string(entries[i].count) + ")";
    } else {
      others += entries[i].count;
    }
  }
  return others == 0 ? text : text + "; other reasons (" + std::to_string(others) + ")";
}

void vpLocateSummary::add(const vpLocatedFrame &located)
{
  ++m_used;
  m_name = located.frame.name;
  m_compute += located.compute;
  const vpVlpFix &fix = located.location.fix;
  if (fix.valid) {
    ++m_positions;
    m_ambiguous += fix.ambiguous ? 1 : 0;
  } else {
    m_refusals.add(fix.refusal);
  }
  for (const vpLampObservation &lamp : located.location.observations) {
    static const std::string outOfPlace = "not where "; // as such remarks begin
    if (fix.valid && !lamp.id.empty()) {
      Places &places = m_places[lamp.id];
      places.right += lamp.accepted ? 1 : 0;
      places.wrong += !lamp.accepted && lamp.remark.compare(0, outOfPlace.size(), outOfPlace) == 0 ? 1 : 0;
    }
    if (lamp.accepted) {
      ++m_counted;
    } else if (fix.valid || lamp.remark != fix.refusal) { // that is said already
      m_remarks.add(lamp.remark);
      ++m_left;
    }
  }
}

void vpLocateSummary::log() const
{
  if (m_used > 0 && m_positions == 0) {
    spdlog::error("no position in {}: {}", m_used == 1 ? m_name : "any of " + counted(m_used, "frame"),
                  m_refusals.text());
  } else if (m_used > 0) {
    spdlog::info("{}, {}{}, {:.1f} ms a frame on average{}", counted(m_used, "frame"),
                 counted(m_positions, "position"),
                 m_ambiguous == 0 ? "" : " (" + std::to_string(m_ambiguous) + " ambiguous)",
                 1000 * m_compute / m_used,
                 m_bad == 0 ? "" : ", " + counted(m_bad, "other frame") + " could not be used");
    if (m_positions < m_used) {
      spdlog::info("no position: {}", m_refusals.text());
    }
  }
  if (m_counted > 0 || m_left > 0) {
    spdlog::info("{} for the position{}",
                 counted(m_counted, "lamp image") + (m_counted == 1 ? " counts" : " count"),
                 m_left == 0 ? "" : "; others do not: " + m_remarks.text());
  }
  for (const auto &[id, places] : m_places) {
    static const size_t enough = 5, times = 4; // images out of place; as many as of those in it
    if (places.wrong >= enough && places.wrong > times * places.right) {
      spdlog::warn(
          "lamp {} is not where the map has it in {} of {} images: measure it, or let vlp-calibrate lamps",
          id, places.wrong, places.wrong + places.right);
    }
  }
}

END_VISP_NAMESPACE
