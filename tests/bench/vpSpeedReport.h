/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpSpeedReport_h
#define vpSpeedReport_h

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

/*!
  Prints as Google Benchmark does, and keeps what it printed of benchmarks called `case/what` for Markdown
  tables: of repetitions the median. Times are those of the processor, which other programs disturb less.
*/
class vpSpeedReport : public benchmark::ConsoleReporter
{
public:
  //! A column: what the benchmark is called, and how it is headed.
  using Column = std::pair<std::string, std::string>;

  vpSpeedReport() : ConsoleReporter(OO_None) {}

  void ReportRuns(const std::vector<Run> &runs) override
  {
    ConsoleReporter::ReportRuns(runs);
    for (const Run &run : runs) {
      if (run.iterations == 0 || run.run_type != Run::RT_Iteration) {
        continue;
      }
      const std::string &name = run.run_name.function_name;
      const size_t slash = name.rfind('/');
      const std::string frames = name.substr(0, slash);
      if (std::find(m_cases.begin(), m_cases.end(), frames) == m_cases.end()) {
        m_cases.push_back(frames);
      }
      Figures &figures = m_figures[{frames, name.substr(slash + 1)}];
      figures.seconds.push_back(run.cpu_accumulated_time / static_cast<double>(run.iterations));
      for (const auto &[counter, value] : run.counters) {
        figures.counters[counter] = value;
      }
    }
  }

  //! Times of each column as multiples of that of \e unit, and ratios of two columns.
  void printRatios(const Column &unit, const std::vector<Column> &columns,
                   const std::vector<std::pair<Column, Column>> &ratios) const
  {
    std::vector<std::string> heads = headsOf(columns);
    heads.insert(heads.begin(), unit.second + ", ms");
    for (const auto &[peer, ours] : ratios) {
      heads.push_back(peer.second + " / " + ours.second);
    }
    print("Time of one core, as multiples of " + unit.second + " of the same frame", columns, heads,
          [&](const std::string &frames) {
            std::vector<std::string> cells = {text("%.4f", 1000 * seconds(frames, unit.first))};
            for (const Column &column : columns) {
              cells.push_back(text("%.3g", seconds(frames, column.first) / seconds(frames, unit.first)));
            }
            for (const auto &[peer, ours] : ratios) {
              cells.push_back(text("%.3g", seconds(frames, peer.first) / seconds(frames, ours.first)));
            }
            return cells;
          });
  }

  //! Error and ids of each column.
  void printAccuracy(const std::vector<Column> &columns) const
  {
    print("Horizontal error, mm: mean / largest; ids wrong, ids missing; frames without a position", columns,
          headsOf(columns), [&](const std::string &frames) {
            std::vector<std::string> cells;
            for (const auto &[name, head] : columns) {
              if (!find(frames, name)) {
                cells.push_back("-");
                continue;
              }
              cells.push_back(text("%.4f", counter(frames, name, "mean_mm")) + " / " +
                              text("%.4f", counter(frames, name, "max_mm")) + "; " +
                              text("%.0f", counter(frames, name, "wrong")) + ", " +
                              text("%.0f", counter(frames, name, "missing")) + "; " +
                              text("%.0f", counter(frames, name, "no_fix")) + " of " +
                              text("%.0f", counter(frames, name, "frames")));
            }
            return cells;
          });
  }

  //! Counters of the benchmark \e what, in microseconds, as shares of the time of \e whole.
  void printShares(const Column &what, const Column &whole, const std::vector<std::string> &counters) const
  {
    std::vector<std::string> heads = {whole.second + ", ms"};
    heads.insert(heads.end(), counters.begin(), counters.end());
    print("Stages, as shares of " + whole.second + ", %", {what}, heads, [&](const std::string &frames) {
      const double all = seconds(frames, whole.first);
      std::vector<std::string> cells = {text("%.3f", 1000 * all)};
      for (const std::string &name : counters) {
        cells.push_back(text("%.1f", 1e-4 * counter(frames, what.first, name) / all));
      }
      return cells;
    });
  }

  //! Trackers of one lamp.
  void printTrackers(const Column &unit, const std::vector<Column> &columns, const Column &ours) const
  {
    print("Trackers of one lamp: ms; as a multiple of " + unit.second + "; of " + ours.second +
              "; mean / largest error, px",
          columns, headsOf(columns), [&](const std::string &frames) {
            std::vector<std::string> cells;
            for (const auto &[name, head] : columns) {
              if (!find(frames, name)) {
                cells.push_back("-");
                continue;
              }
              const double time = seconds(frames, name);
              cells.push_back(text("%.4f", 1000 * time) + "; " +
                              text("%.3g", time / seconds(frames, unit.first)) + "; " +
                              text("%.3g", time / seconds(frames, ours.first)) + "; " +
                              text("%.2f", counter(frames, name, "mean_px")) + " / " +
                              text("%.2f", counter(frames, name, "max_px")));
            }
            return cells;
          });
  }

private:
  struct Figures {
    std::vector<double> seconds; // of each repetition
    std::map<std::string, double> counters;
  };

  const Figures *find(const std::string &frames, const std::string &what) const
  {
    const auto found = m_figures.find({frames, what});
    return found == m_figures.end() ? nullptr : &found->second;
  }

  //! Median; NaN where that benchmark did not run.
  double seconds(const std::string &frames, const std::string &what) const
  {
    const Figures *figures = find(frames, what);
    if (!figures) {
      return NAN;
    }
    std::vector<double> sorted = figures->seconds;
    std::sort(sorted.begin(), sorted.end());
    return 0.5 * (sorted[(sorted.size() - 1) / 2] + sorted[sorted.size() / 2]);
  }

  double counter(const std::string &frames, const std::string &what, const std::string &name) const
  {
    const Figures *figures = find(frames, what);
    return figures && figures->counters.count(name) ? figures->counters.at(name) : NAN;
  }

  static std::string text(const char *format, double value)
  {
    if (!std::isfinite(value)) {
      return "-";
    }
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, format, value);
    return buffer;
  }

  static std::vector<std::string> headsOf(const std::vector<Column> &columns)
  {
    std::vector<std::string> heads;
    for (const Column &column : columns) {
      heads.push_back(column.second);
    }
    return heads;
  }

  //! A row for each case of which any of these columns ran.
  template <class Cells>
  void print(const std::string &title, const std::vector<Column> &columns,
             const std::vector<std::string> &heads, Cells cellsOf) const
  {
    std::vector<std::string> cases;
    std::copy_if(m_cases.begin(), m_cases.end(), std::back_inserter(cases), [&](const std::string &frames) {
      return std::any_of(columns.begin(), columns.end(),
                         [&](const Column &column) { return find(frames, column.first) != nullptr; });
    });
    if (cases.empty()) {
      return;
    }
    std::printf("\n%s:\n\n| frames |", title.c_str());
    for (const std::string &head : heads) {
      std::printf(" %s |", head.c_str());
    }
    std::printf("\n|---|");
    for (size_t i = 0; i < heads.size(); ++i) {
      std::printf("---|");
    }
    std::printf("\n");
    for (const std::string &frames : cases) {
      std::printf("| %s |", frames.c_str());
      for (const std::string &cell : cellsOf(frames)) {
        std::printf(" %s |", cell.c_str());
      }
      std::printf("\n");
    }
  }

  std::vector<std::string> m_cases; // in the order in which they came
  std::map<std::pair<std::string, std::string>, Figures> m_figures;
};

#endif
