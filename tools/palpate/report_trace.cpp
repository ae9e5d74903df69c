// SPDX-License-Identifier: GPL-3.0-or-later
// Reports from traces of runs (docs/REALTIME.md, "Trace format").
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <string>

#include "config/text_file.hpp"
#include "config/unit_quaternion.hpp"
#include "tools/palpate/command.hpp"
#include "tools/palpate/report_input.hpp"
#include "tools/realtime/trace.hpp"

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;
using realtime::TraceHeader;
using realtime::TraceRecord;

// Records are copied as they lie in the file.
static_assert(std::endian::native == std::endian::little);

struct Trace {
  TraceHeader header;
  fs::path scene;
  std::vector<TraceRecord> records;  ///< at least one
};

[[noreturn]] void refuse(const std::string& what, const fs::path& file) {
  throw Failure(kRefused, what, file.string(),
                "give a trace that 'palpate run -o' wrote, or the folder of a sweep or a replay");
}

Trace read_trace(const fs::path& file) {
  std::string bytes;
  if (const std::error_code error = config::read_text(file, bytes)) {
    refuse("cannot read the trace (" + error.message() + ")", file);
  }
  Trace trace;
  TraceHeader& h = trace.header;
  if (bytes.size() < sizeof h) refuse("not a trace", file);
  std::memcpy(&h, bytes.data(), sizeof h);
  if (h.magic != realtime::kTraceMagic) refuse("not a trace", file);
  if (h.version != realtime::kTraceVersion || h.record_bytes != sizeof(TraceRecord)) {
    refuse("a trace of another version", file);
  }
  const std::size_t room = bytes.size() - std::min<std::size_t>(bytes.size(), h.header_bytes);
  if (h.header_bytes < sizeof h || h.scene_bytes > h.header_bytes - sizeof h ||
      h.records != room / sizeof(TraceRecord) || room % sizeof(TraceRecord) != 0) {
    refuse("a trace cut short", file);
  }
  if (h.records == 0) refuse("a trace without ticks", file);
  trace.scene = bytes.substr(sizeof h, h.scene_bytes);
  trace.records.resize(h.records);
  std::memcpy(trace.records.data(), bytes.data() + h.header_bytes, room);
  return trace;
}

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
  return row;
}

ReportRun run_of(const Trace& trace) {
  ReportRun run;
  run.rate_Hz = trace.header.rate_Hz;
  run.dropped = trace.header.dropped;
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
