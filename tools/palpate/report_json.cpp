// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/report_json.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "tools/palpate/json_number.hpp"
#include "tools/palpate/report_run.hpp"
#include "tools/palpate/report_words.hpp"

namespace palpate::cli {
namespace {

using Json = nlohmann::ordered_json;

// packed() gives values as they lie in memory.
static_assert(std::endian::native == std::endian::little);

constexpr float kGap = std::numeric_limits<float>::quiet_NaN();

float time_us(const TickRow& row) {
  return row.time_ns == 0 ? kGap : static_cast<float>(row.time_ns) * 1e-3f;
}

/// Rounding is no error: what is below a millionth of the bound counts as none.
double shown_error_m(const TickRow& row, const TickRow& exact) {
  const double error_m = distance_error_m(row, exact);
  return error_m < 1e-6 * row.certificate.error_bound_m ? 0 : error_m;
}

Json line_json(const ReportLine& line, const ReportLine* exact, const Frames& frames) {
  const auto row = [&line](std::size_t tick) -> const TickRow& { return line.ticks[tick]; };
  Json out;
  out["name"] = line.name;
  out["exact"] = line.exact;
  out["force_N"] =
      packed(frames.sample([&](std::size_t tick) { return norm(row(tick).wrench.force_N); }));
  out["time_us"] = packed(frames.peak([&](std::size_t tick) { return time_us(row(tick)); }));
  out["front"] = packed(frames.sample([&](std::size_t tick) { return row(tick).front_nodes; }));
  out["contacts"] = packed(frames.sample([&](std::size_t tick) { return row(tick).contacts; }));
  out["bound_m"] =
      packed(frames.sample([&](std::size_t tick) { return row(tick).certificate.error_bound_m; }));
  if (exact != nullptr && !line.exact) {
    out["error_m"] = packed(frames.sample(
        [&](std::size_t tick) { return shown_error_m(row(tick), exact->ticks[tick]); }));
  }
  return out;
}

Json lines_json(const ReportInput& input, const Frames& frames) {
  const auto exact = std::find_if(input.lines.begin(), input.lines.end(),
                                  [](const ReportLine& line) { return line.exact; });
  Json out = Json::array();
  for (const ReportLine& line : input.lines) {
    out.push_back(line_json(line, exact == input.lines.end() ? nullptr : &*exact, frames));
  }
  return out;
}

Json latency_json(const ReportInput& input) {
  std::vector<std::string> names;
  std::vector<std::vector<std::uint64_t>> sets_ns;
  for (const ReportLine& line : input.lines) {
    names.push_back(input.run ? "tick" : line.name);
    auto& set = sets_ns.emplace_back();
    for (const TickRow& row : line.ticks) set.push_back(row.time_ns);
  }
  if (input.run) {
    names.emplace_back("late wake-up");
    sets_ns.emplace_back(input.run->latency_ns.begin(), input.run->latency_ns.end());
  }
  const DurationBins bins = bin_durations(sets_ns);
  if (bins.from_us.empty()) return nullptr;
  Json sets = Json::array();
  for (std::size_t i = 0; i < names.size(); ++i) {
    sets.push_back({{"name", names[i]}, {"counts", packed(bins.counts[i])}});
  }
  return {{"from_us", packed(bins.from_us)}, {"bins_per_octave", kBinsPerOctave}, {"sets", sets}};
}

/// Errors below this, a hundredth of a per cent, are drawn as none: a logarithmic axis would give
/// most of its length to the rounding of exact queries.
constexpr double kLeastDrawnNrmse = 1e-4;

/// Half the least error that is drawn as it is: where none is drawn.
double lower_edge(const std::vector<SweepPoint>& settings) {
  double least = 2.0;
  for (const SweepPoint& p : settings) {
    if (p.force_nrmse >= kLeastDrawnNrmse) least = std::min(least, p.force_nrmse);
  }
  return least / 2;
}

Json setting_json(const SweepPoint& p, double lower_edge) {
  return {{"engine", p.engine},
          {"exact", p.exact},
          {"words", p.words},
          {"delta_m", number(p.delta_m)},
          {"median_us", number(p.median_us)},
          {"p99_us", number(p.p99_us)},
          {"p999_us", number(p.p999_us)},
          {"max_us", number(p.max_us)},
          {"front_mean", number(p.front_mean)},
          {"queries_mean", number(p.queries_mean)},
          {"truncated", number(p.truncated)},
          {"force_nrmse", number(p.force_nrmse)},
          {"drawn_nrmse", number(p.force_nrmse < kLeastDrawnNrmse ? lower_edge : p.force_nrmse)},
          {"torque_nrmse", number(p.torque_nrmse)},
          {"noticeable", number(p.noticeable)},
          {"bound_m", number(p.bound_m)},
          {"error_m", number(p.error_m)},
          {"speedup", number(p.speedup)},
          {"pareto", p.pareto}};
}

}  // namespace

std::string base64(std::span<const std::byte> bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t have = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (k < have ? std::to_integer<std::uint32_t>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      out += k <= have ? kDigits[group >> (18 - 6 * k) & 63u] : '=';
    }
  }
  return out;
}

nlohmann::ordered_json frames_json(const ReportInput& input, const Frames& frames) {
  const std::vector<TickRow>& ticks = input.lines.front().ticks;
  return {{"count", frames.count},
          {"stride", frames.stride},
          {"ticks", frames.ticks},
          {"t_s", packed(frames.sample([&](std::size_t tick) { return ticks[tick].t_s; }))}};
}

nlohmann::ordered_json report_json(const ReportInput& input, const Frames& frames) {
  Json out;
  out["version"] = PALPATE_VERSION;
  out["kind"] = input.kind == ReportKind::sweep ? "sweep"
                : input.kind == ReportKind::run ? "run"
                                                : "replay";
  out["name"] = input.name;
  out["summary"] = summary_in_words(input);
  out["notes"] = input.notes;
  out["settings"] = Json::array();
  const double edge = lower_edge(input.settings);
  for (const SweepPoint& p : input.settings) out["settings"].push_back(setting_json(p, edge));
  out["lines"] = Json::array();
  if (input.lines.empty()) return out;
  if (frames.stride > 1) {
    out["notes"].push_back("Of " + std::to_string(frames.ticks) + " ticks one in " +
                           std::to_string(frames.stride) +
                           " is shown in the plots; times are the longest of each " +
                           std::to_string(frames.stride) + ".");
  }
  out["frames"] = frames_json(input, frames);
  out["lines"] = lines_json(input, frames);
  out["latency"] = latency_json(input);
  if (input.run) {
    out["late_us"] = packed(frames.peak(
        [&](std::size_t tick) { return static_cast<double>(input.run->latency_ns[tick]) * 1e-3; }));
    out["run"] = report_run_json(input, frames);
  }
  return out;
}

}  // namespace palpate::cli
