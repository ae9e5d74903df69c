// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/report_run.hpp"

#include <cmath>
#include <string>

#include "tools/palpate/json_number.hpp"
#include "tools/palpate/report_json.hpp"
#include "tools/realtime/safety.hpp"

namespace palpate::cli {
namespace {

using Json = nlohmann::ordered_json;
using realtime::TraceRecord;

template <class Number>
double length_of(const std::array<Number, 3>& v) {
  return std::hypot(static_cast<double>(v[0]), static_cast<double>(v[1]),
                    static_cast<double>(v[2]));
}

/// Faults that the tick has and the one before had not; the latter may be null.
std::string new_faults(const TraceRecord& now, const TraceRecord* before) {
  const unsigned had = before == nullptr ? 0u : before->faults;
  std::string out;
  for (const std::string_view name :
       realtime::names({static_cast<std::uint16_t>(now.faults & ~had)})) {
    out += (out.empty() ? "" : ", ") + std::string(name);
  }
  return out;
}

/// Deadlines missed, which leave a gap in the grid of due times, and faults. Where ticks were
/// dropped on their way into the trace a gap may be theirs: then faults alone.
Json marks_json(const ReportRun& run) {
  Json out = Json::array();
  const TraceRecord* before = nullptr;
  for (const TraceRecord& r : run.records) {
    if (out.size() >= kMaxMarks) break;
    const double t_s = static_cast<double>(r.time_ns) * 1e-9;
    const double since_s =
        before == nullptr ? 0 : t_s - static_cast<double>(before->time_ns) * 1e-9;
    if (run.dropped == 0 && since_s * run.rate_Hz > 1.5) {
      out.push_back({{"t_s", t_s}, {"fault", nullptr}});
    }
    if (const std::string fault = new_faults(r, before); !fault.empty()) {
      out.push_back({{"t_s", t_s}, {"fault", fault}});
    }
    before = &r;
  }
  return out;
}

}  // namespace

nlohmann::ordered_json report_run_json(const ReportInput& input, const Frames& frames) {
  const ReportRun& run = *input.run;
  const auto at = [&run](std::size_t tick) -> const TraceRecord& { return run.records[tick]; };
  const auto sampled = [&](auto value) {
    return packed(frames.sample([&](std::size_t tick) { return value(at(tick)); }));
  };
  const auto axes = [&](auto value) {
    Json out = Json::array();
    for (std::size_t i = 0; i < 3; ++i) {
      out.push_back(sampled([&](const TraceRecord& r) { return value(r, i); }));
    }
    return out;
  };
  const auto start_m = at(0).position_m;
  const bool known = input.view && input.view->scene.budget_us;
  return {
      {"period_us", 1e6 / run.rate_Hz},
      {"budget_us", known ? number(*input.view->scene.budget_us) : Json(nullptr)},
      {"marks", marks_json(run)},
      {"sent_N", sampled([](const TraceRecord& r) { return length_of(r.sent_force_N); })},
      {"sent_xyz_N", axes([](const TraceRecord& r, std::size_t i) { return r.sent_force_N[i]; })},
      {"torque_Nm", sampled([](const TraceRecord& r) { return length_of(r.rendered_torque_Nm); })},
      {"sent_torque_Nm", sampled([](const TraceRecord& r) { return length_of(r.sent_torque_Nm); })},
      {"moved_xyz_mm", axes([&](const TraceRecord& r, std::size_t i) {
         return 1e3 * (r.position_m[i] - start_m[i]);
       })},
      {"energy_mJ", sampled([](const TraceRecord& r) { return 1e3 * r.energy_J; })},
      {"age_us", packed(frames.peak([&](std::size_t tick) {
         return 1e-3 * static_cast<double>(at(tick).state_age_ns);
       }))}};
}

}  // namespace palpate::cli
