// SPDX-License-Identifier: GPL-3.0-or-later
// What a report is made from: a sweep's or a replay's folder, or a trace of a run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/scene.hpp"
#include "tools/palpate/poses.hpp"
#include "tools/palpate/replay_csv.hpp"
#include "tools/palpate/report_sweep.hpp"
#include "tools/realtime/trace.hpp"

namespace palpate::cli {

enum class ReportKind { replay, sweep, run };

/// One line of the contact profiles: the ticks of one replay or of the run.
struct ReportLine {
  std::string name;    ///< the setting of a sweep, else the table's file name without ".csv"
  bool exact = false;  ///< the truth that the others are measured against
  std::vector<TickRow> ticks;
};

/// What only a run has, beside its line.
struct ReportRun {
  double rate_Hz = 0;
  std::uint64_t missed = 0;   ///< periods that the loop skipped
  std::uint64_t dropped = 0;  ///< ticks that left no record
  double sent_force_max_N = 0;
  std::vector<std::uint32_t> latency_ns;       ///< [ticks] wake-up after the time due
  std::uint16_t faults = 0;                    ///< TraceRecord::faults of all ticks together
  std::vector<realtime::TraceRecord> records;  ///< [ticks]
};

/// What the 3D view needs.
struct ReportScene {
  config::Scene scene;
  PoseTrack track;                 ///< as many ticks as each line
  std::filesystem::path contacts;  ///< CONTACTS.csv of line `contacts_of`; empty: there is none
  std::size_t contacts_of = 0;
};

/// What a certificate is judged by, see certificate_broken().
struct JudgedBy {
  double delta_m = 0;
  double radius_m = 0;  ///< of the larger body
};

struct ReportInput {
  ReportKind kind = ReportKind::replay;
  std::string name;                  ///< of the folder or file
  std::vector<ReportLine> lines;     ///< at least one unless `settings` has some; all equally long
  std::vector<SweepPoint> settings;  ///< of a sweep
  std::optional<ReportRun> run;
  std::optional<ReportScene> view;  ///< only where there are lines
  std::optional<JudgedBy> judged;   ///< of a replay with an exact line whose scene is known
  std::vector<std::string> notes;   ///< what was left out and why, a sentence each
};

/// What the command line adds where the folder or trace does not say it; each may be empty.
struct ReportHints {
  std::filesystem::path scene, poses;
};

/// Lines of one report at most; a sweep's others are told by its table alone.
inline constexpr std::size_t kMaxReportLines = 8;

/// Reads a folder or a trace. A scene, poses or contacts that the hints do not name and that cannot
/// be read cost the 3D view and leave a note. Throws Failure(kRefused): not there, neither folder
/// nor trace, nothing in it to report, tables of different lengths, a table cut short; and whatever
/// is wrong with a file that the hints name.
ReportInput read_report_input(const std::filesystem::path& source, const ReportHints& hints);

// The two halves of it.
ReportInput read_report_folder(const std::filesystem::path& folder, const ReportHints& hints);
ReportInput read_report_trace(const std::filesystem::path& file, const ReportHints& hints);

}  // namespace palpate::cli
