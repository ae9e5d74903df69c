// SPDX-License-Identifier: GPL-3.0-or-later
// Reports from traces of runs (docs/REALTIME.md, "Trace format").
#include <algorithm>
#include <cmath>
#include <string>

#include "config/unit_quaternion.hpp"
#include "tools/palpate/command.hpp"
#include "tools/palpate/report_input.hpp"
#include "tools/palpate/trace_file.hpp"

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;
using realtime::TraceRecord;

Vec3d vec(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

TickRow row_of(const TraceRecord& r) {
  TickRow row;
  row.t_s = static_cast<double>(r.time_ns) * 1e-9;
  row.wrench = {vec(r.rendered_force_N), vec(r.rendered_torque_Nm)};
  row.contacts = r.contacts;
  row.clusters = r.clusters;
  row.min_distance_m = r.min_distance_m;
  row.front_nodes = r.front_nodes;
  row.queries = r.queries;
  row.time_ns = r.tick_ns;
  row.certificate.truncated_by_time = (r.truncated & realtime::kByTime) != 0;
  row.certificate.truncated_by_units = (r.truncated & realtime::kByUnits) != 0;
  row.certificate.truncated_by_memory = (r.truncated & realtime::kByMemory) != 0;
  row.certificate.s_worst = r.s_worst;
  row.certificate.error_bound_m = r.error_bound_m;
  row.certificate.force_bound_N = r.force_bound_N;
  return row;
}

ReportRun run_of(const Trace& trace) {
  ReportRun run;
  run.rate_Hz = trace.header.rate_Hz;
  run.dropped = trace.header.dropped;
  run.records = trace.records;
  for (const TraceRecord& r : trace.records) {
    const auto [x, y, z] = r.sent_force_N;
    run.sent_force_max_N =
        std::max(run.sent_force_max_N, norm(Vec3d{double(x), double(y), double(z)}));
    run.latency_ns.push_back(r.latency_ns);
    run.faults = static_cast<std::uint16_t>(run.faults | r.faults);
  }
  // Due times lie on a grid: what has neither a record nor was dropped, was skipped.
  const double periods =
      std::round(static_cast<double>(trace.records.back().time_ns) * 1e-9 * run.rate_Hz) + 1;
  const double seen = static_cast<double>(trace.records.size() + run.dropped);
  if (periods > seen && periods < 1e15) run.missed = static_cast<std::uint64_t>(periods - seen);
  return run;
}

/// The tool's poses; a tick without a reading keeps the last one.
PoseTrack track_of(const Trace& trace, std::uint32_t tool) {
  PoseTrack track;
  for (const TraceRecord& r : trace.records) {
    PoseTick& tick = track.ticks.emplace_back();
    tick.t_s = static_cast<double>(r.time_ns) * 1e-9;
    tick.first = track.changes.size();
    const auto [w, x, y, z] = r.orientation;
    PoseChange change{.body = tool, .pose = {vec(r.position_m), {w, x, y, z}}};
    if (!std::isfinite(squared_norm(change.pose.position_m)) ||
        !config::make_unit(change.pose.orientation)) {
      continue;
    }
    track.changes.push_back(change);
    tick.changes = 1;
  }
  return track;
}

}  // namespace

ReportInput read_report_trace(const fs::path& file, const ReportHints& hints) {
  const Trace trace = read_trace(file);
  ReportInput input;
  input.kind = ReportKind::run;
  input.name = file.filename().string();
  ReportLine line;
  line.name = "run";
  for (const TraceRecord& r : trace.records) line.ticks.push_back(row_of(r));
  input.lines.push_back(std::move(line));
  input.run = run_of(trace);
  try {
    ReportScene view;
    view.scene = config::load_scene(hints.scene.empty() ? trace.scene : hints.scene);
    view.track = track_of(trace, view.scene.tool);
    input.view = std::move(view);
  } catch (const config::ConfigError& e) {
    if (!hints.scene.empty()) throw;
    input.notes.push_back(std::string("No 3D view: ") + e.what() + ".");
  }
  return input;
}

ReportInput read_report_input(const fs::path& source, const ReportHints& hints) {
  std::error_code error;
  if (fs::is_directory(source, error)) return read_report_folder(source, hints);
  if (!fs::exists(source, error)) {
    throw Failure(kRefused, "no such folder or trace", source.string(), "check the path");
  }
  if (!hints.poses.empty()) {
    throw Failure(kUsage, "a trace holds its own poses", source.string(), "leave out --poses");
  }
  return read_report_trace(source, hints);
}

}  // namespace palpate::cli
