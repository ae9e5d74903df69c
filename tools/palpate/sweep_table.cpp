// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/sweep_table.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "tools/palpate/command.hpp"
#include "tools/palpate/json_number.hpp"

namespace palpate::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

/// Loads exact runs once, however many settings they are compared with.
class References {
 public:
  explicit References(const SweepFolder& folder) : folder_(folder) {}

  /// Empty where the sweep has none.
  const std::vector<TickRow>& of(const SweepSetting& exact) {
    const auto [at, is_new] = ticks_.try_emplace(id_of(exact));
    if (is_new) at->second = folder_.load(exact).value_or(std::vector<TickRow>());
    return at->second;
  }

 private:
  const SweepFolder& folder_;
  std::map<std::string, std::vector<TickRow>> ticks_;
};

double ratio(double a, double b) { return b > 0 ? a / b : kNotKnown; }

/// Against the exact run with the paper's bounds at the same delta.
void compare_with_paper(std::vector<SweepRow>& rows) {
  for (SweepRow& row : rows) {
    row.speedup_median = row.front_ratio = kNotKnown;
    for (const SweepRow& paper : rows) {
      const SweepSetting& s = paper.setting;
      if (!s.exact || s.bounds != Bounds::paper || s.delta_m != row.setting.delta_m) continue;
      row.speedup_median = ratio(paper.figures.median_ns, row.figures.median_ns);
      if (row.setting.engine == EngineKind::levels) {
        row.front_ratio = ratio(paper.figures.front_mean, row.figures.front_mean);
      }
    }
  }
}

bool beats(const SweepRow& a, const SweepRow& b) {
  const SweepFigures& x = a.figures;
  const SweepFigures& y = b.figures;
  return a.setting.delta_m == b.setting.delta_m && x.median_ns <= y.median_ns &&
         x.force_nrmse <= y.force_nrmse &&
         (x.median_ns < y.median_ns || x.force_nrmse < y.force_nrmse);
}

void mark_pareto(std::vector<SweepRow>& rows) {
  for (SweepRow& row : rows) {
    row.pareto = !std::isnan(row.figures.median_ns) && !std::isnan(row.figures.force_nrmse) &&
                 std::none_of(rows.begin(), rows.end(),
                              [&](const SweepRow& other) { return beats(other, row); });
  }
}

/// Nanoseconds are whole numbers.
Json whole(double value) {
  return std::isfinite(value) ? Json(static_cast<std::int64_t>(value)) : Json(nullptr);
}

void put_setting(const SweepSetting& s, Json& out) {
  const bool levels = s.engine == EngineKind::levels;
  const auto where = [](bool known, const Json& value) { return known ? value : Json(nullptr); };
  out["id"] = id_of(s);
  out["engine"] = levels ? "levels" : "regions";
  out["exact"] = s.exact;
  out["s0"] = where(levels && !s.exact, s.s0);
  out["kappa"] = where(levels && !s.exact, number(s.kappa));
  out["force_tolerance_N"] = where(!levels && !s.exact, s.force_tolerance_N);
  out["budget_us"] = number(s.budget_us);
  out["interpolate"] = where(levels, false);
  out["bounds"] = where(levels, s.bounds == Bounds::paper ? "paper" : "tight");
  out["delta_m"] = s.delta_m;
}

void put_figures(const SweepFigures& f, Json& out) {
  out["ticks"] = f.ticks;
  out["timed_ticks"] = f.timed_ticks;
  out["median_ns"] = whole(f.median_ns);
  out["p99_ns"] = whole(f.p99_ns);
  out["p999_ns"] = whole(f.p999_ns);
  out["max_ns"] = whole(f.max_ns);
  out["front_mean"] = number(f.front_mean);
  out["queries_mean"] = number(f.queries_mean);
  out["truncated"] = number(f.truncated);
  out["force_nrmse"] = number(f.force_nrmse);
  out["torque_nrmse"] = number(f.torque_nrmse);
  out["force_error_max_N"] = number(f.force_error_max_N);
  out["direction_error_median_rad"] = number(f.direction_error_median_rad);
  out["noticeable"] = number(f.noticeable);
  out["force_step_max_N"] = number(f.force_step_max_N);
  out["s_worst_mean"] = number(f.s_worst_mean);
  out["s_worst_max"] = number(f.s_worst_max);
  out["error_bound_median"] = number(f.error_bound_median_m);
  out["error_bound_max"] = number(f.error_bound_max_m);
  out["true_error_median"] = number(f.true_error_median_m);
  out["bound_over_error_median"] = number(f.bound_over_error_median);
  out["certificates_broken"] = f.certificates_broken;
}

Json to_json(const SweepRow& row) {
  Json out;
  put_setting(row.setting, out);
  put_figures(row.figures, out);
  out["force_nrmse_levels"] = number(row.force_nrmse_levels);
  out["speedup_median"] = number(row.speedup_median);
  out["front_ratio"] = number(row.front_ratio);
  out["pareto"] = row.pareto;
  return out;
}

SweepSetting setting_of(const Json& row) {
  SweepSetting s;
  const auto take = [&](const char* key, auto& value) {
    if (!row.at(key).is_null()) row.at(key).get_to(value);
  };
  if (row.at("engine") == "regions") s.engine = EngineKind::regions;
  if (row.at("bounds") == "paper") s.bounds = Bounds::paper;
  take("exact", s.exact);
  take("s0", s.s0);
  take("kappa", s.kappa);
  take("force_tolerance_N", s.force_tolerance_N);
  take("budget_us", s.budget_us);
  take("delta_m", s.delta_m);
  return s;
}

std::string field(const Json& value) {
  if (value.is_null()) return "";
  return value.is_string() ? value.get<std::string>() : value.dump();
}

}  // namespace

std::vector<SweepRow> tabulate(const SweepFolder& folder, std::span<const SweepSetting> settings,
                               const Observer& observer) {
  References references(folder);
  std::vector<SweepRow> rows;
  for (const SweepSetting& setting : settings) {
    const std::vector<TickRow> ticks = folder.load(setting).value_or(std::vector<TickRow>());
    const std::vector<TickRow>& exact = references.of(reference_of(setting));
    if (ticks.empty() || exact.empty()) {
      throw Failure(kOther, "the ticks of a setting have gone", id_of(setting),
                    "let nobody write to the folder during a sweep, and begin again");
    }
    SweepRow& row = rows.emplace_back();
    row.setting = setting;
    row.figures = figures(ticks, exact, observer, setting.delta_m, folder.radius_m());
    const std::vector<TickRow>& levels = references.of({.exact = true, .delta_m = setting.delta_m});
    row.force_nrmse_levels =
        levels.empty() ? kNotKnown : nrmse(forces_of(ticks), forces_of(levels));
  }
  compare_with_paper(rows);
  mark_pareto(rows);
  return rows;
}

std::string to_json(std::span<const SweepRow> rows) {
  Json list = Json::array();
  for (const SweepRow& row : rows) list.push_back(to_json(row));
  return list.dump(1) + "\n";
}

std::vector<SweepSetting> settings_of(const std::string& json) {
  try {
    std::vector<SweepSetting> out;
    for (const Json& row : Json::parse(json)) out.push_back(setting_of(row));
    return out;
  } catch (const Json::exception&) {
    return {};
  }
}

std::string to_csv(std::span<const SweepRow> rows) {
  std::string out;
  for (const SweepRow& row : rows) {
    const Json json = to_json(row);
    std::string header, line;
    for (const auto& [key, value] : json.items()) {
      header += (header.empty() ? "" : ",") + key;
      line += (line.empty() ? "" : ",") + field(value);
    }
    if (out.empty()) out = header + "\n";
    out += line + "\n";
  }
  return out;
}

}  // namespace palpate::cli
