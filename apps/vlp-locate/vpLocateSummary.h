/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpLocateSummary_h
#define vpLocateSummary_h

#include <map>
#include <string>

#include "vpLocateOutputs.h"

BEGIN_VISP_NAMESPACE

//! How often each reason came. Reasons that differ in their numbers alone count as one.
class vpReasonCount
{
public:
  void add(const std::string &reason);

  //! The most frequent first, each with its count: `no lamp-like region (12), a position needs two lamps, 1
  //! came (3)`.
  std::string text() const;

private:
  struct Entry {
    std::string first; // as it first came
    size_t count = 0;
  };
  std::map<std::string, Entry> m_entries; // by the reason without its numbers
};

//! Counts what became of the frames, and says it on stderr.
class vpLocateSummary
{
public:
  void add(const vpLocatedFrame &located);
  void addBad() { ++m_bad; }

  size_t used() const { return m_used; }
  size_t bad() const { return m_bad; }
  size_t positions() const { return m_positions; }

  void log() const;

private:
  std::string m_name; // of the last frame
  size_t m_used = 0;  // frames that were read and looked at
  size_t m_bad = 0;
  size_t m_positions = 0;
  size_t m_ambiguous = 0;
  size_t m_counted = 0; // regions that count for a position
  size_t m_left = 0;    // those that do not, for a reason of their own
  double m_compute = 0; // s, over all frames
  vpReasonCount m_refusals;
  vpReasonCount m_remarks;
  struct Places {
    size_t right = 0, wrong = 0; // images of a lamp where the map has it, and elsewhere
  };
  std::map<std::string, Places> m_places; // by its id
};

END_VISP_NAMESPACE

#endif
