// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/sweep_plots.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tools/plot/svg.hpp"

namespace palpate::cli {
namespace {

using plot::Mark;
using plot::Panel;
using plot::Series;

constexpr std::size_t kProfiles = 6;
constexpr std::size_t kPointsALine = 500;  // more cannot be told apart

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

Panel trade_panel(std::span<const SweepRow> rows, double delta_m) {
  Panel panel{"delta " + short_number(delta_m * 1e3) + " mm",
              {"median time of a tick, µs", true},
              {"force error (NRMSE), %", false},
              {{"levels", Mark::point, {}},
               {"regions", Mark::point, {}},
               {"levels, exact", Mark::point, {}},
               {"regions, exact", Mark::point, {}},
               {"best", Mark::line, {}}}};
  for (const SweepRow& row : rows) {
    if (row.setting.delta_m != delta_m) continue;
    const std::pair<double, double> at(row.figures.median_ns * 1e-3, 100 * row.figures.force_nrmse);
    const std::size_t engine = row.setting.engine == EngineKind::levels ? 0 : 1;
    panel.series[engine + (row.setting.exact ? 2 : 0)].points.push_back(at);
    if (row.pareto) panel.series[4].points.push_back(at);
  }
  std::sort(panel.series[4].points.begin(), panel.series[4].points.end());
  return panel;
}

std::string name_of(const SweepSetting& s) {
  const std::string engine = s.engine == EngineKind::levels ? "levels" : "regions";
  if (s.exact) return engine + ", exact" + (s.bounds == Bounds::paper ? ", paper's" : "");
  if (s.engine == EngineKind::regions)
    return engine + ", " + short_number(s.force_tolerance_N) + " N";
  return engine + ", s0 " + short_number(100 * s.s0) + " %";
}

/// What the paper's figures show.
bool is_profile(const SweepSetting& s, const SweepSetting& first) {
  if (s.delta_m != first.delta_m || std::isfinite(s.budget_us)) return false;
  return s.exact || s.engine == EngineKind::regions ||
         (std::isinf(s.kappa) && s.bounds == Bounds::tight);
}

Series line(const SweepSetting& setting, std::span<const TickRow> ticks,
            double (*value)(const TickRow&)) {
  Series out{name_of(setting), Mark::line, {}};
  const std::size_t stride = (ticks.size() + kPointsALine - 1) / kPointsALine;
  for (std::size_t i = 0; i < ticks.size(); i += stride) {
    out.points.emplace_back(double(i), value(ticks[i]));
  }
  return out;
}

}  // namespace

std::string trade_plot(std::span<const SweepRow> rows) {
  std::vector<double> deltas_m;
  for (const SweepRow& row : rows) deltas_m.push_back(row.setting.delta_m);
  std::sort(deltas_m.begin(), deltas_m.end());
  deltas_m.erase(std::unique(deltas_m.begin(), deltas_m.end()), deltas_m.end());
  std::vector<Panel> panels;
  panels.reserve(deltas_m.size());
  for (const double delta_m : deltas_m) panels.push_back(trade_panel(rows, delta_m));
  return to_svg(panels);
}

std::string profile_plot(const SweepFolder& folder, std::span<const SweepRow> rows) {
  std::vector<Panel> panels = {{"Contact profile", {"tick", false}, {"force, N", false}, {}},
                               {"", {"tick", false}, {"time, µs", true}, {}},
                               {"", {"tick", false}, {"front, nodes", true}, {}}};
  for (const SweepRow& row : rows) {
    if (panels[0].series.size() == kProfiles) break;
    if (!is_profile(row.setting, rows.front().setting)) continue;
    const auto ticks = folder.load(row.setting);
    if (!ticks) continue;
    const auto add = [&](std::size_t panel, double (*value)(const TickRow&)) {
      panels[panel].series.push_back(line(row.setting, *ticks, value));
    };
    add(0, [](const TickRow& tick) { return norm(tick.wrench.force_N); });
    add(1, [](const TickRow& tick) { return double(tick.time_ns) * 1e-3; });
    add(2, [](const TickRow& tick) { return double(tick.front_nodes); });
  }
  return to_svg(panels);
}

}  // namespace palpate::cli
