// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/sweep_settings.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace palpate::cli {
namespace {

std::string text(double value) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, value).ptr};
}

void add(std::vector<SweepSetting>& out, const SweepSetting& setting) {
  if (std::find(out.begin(), out.end(), setting) == out.end()) out.push_back(setting);
}

/// Each of the settings with each value in turn.
template <class Value>
void cross(std::vector<SweepSetting>& settings, const std::vector<Value>& values,
           Value SweepSetting::*axis) {
  std::vector<SweepSetting> out;
  for (const SweepSetting& setting : settings) {
    for (const Value value : values) out.emplace_back(setting).*axis = value;
  }
  settings = std::move(out);
}

void add_levels(std::vector<SweepSetting>& out, const SweepAxes& axes, double delta_m) {
  std::vector<SweepSetting> all = {{.engine = EngineKind::levels, .delta_m = delta_m}};
  cross(all, axes.bounds, &SweepSetting::bounds);
  cross(all, axes.s0, &SweepSetting::s0);
  cross(all, axes.kappa, &SweepSetting::kappa);
  cross(all, axes.budget_us, &SweepSetting::budget_us);
  for (const SweepSetting& setting : all) add(out, setting);
}

void add_regions(std::vector<SweepSetting>& out, const SweepAxes& axes, double delta_m) {
  std::vector<SweepSetting> all = {{.engine = EngineKind::regions, .delta_m = delta_m}};
  cross(all, axes.force_tolerance_N, &SweepSetting::force_tolerance_N);
  cross(all, axes.budget_us, &SweepSetting::budget_us);
  for (const SweepSetting& setting : all) add(out, setting);
}

SweepSetting exact(EngineKind engine, Bounds bounds, double delta_m) {
  return {.engine = engine, .exact = true, .bounds = bounds, .delta_m = delta_m};
}

}  // namespace

std::vector<SweepSetting> expand(const SweepAxes& axes) {
  const auto wants = [&](EngineKind kind) {
    return std::find(axes.engines.begin(), axes.engines.end(), kind) != axes.engines.end();
  };
  std::vector<SweepSetting> out;
  for (const double delta_m : axes.delta_m) {
    if (wants(EngineKind::levels)) {
      add(out, exact(EngineKind::levels, Bounds::tight, delta_m));
      add(out, exact(EngineKind::levels, Bounds::paper, delta_m));
    }
    if (wants(EngineKind::regions)) add(out, exact(EngineKind::regions, Bounds::tight, delta_m));
    if (wants(EngineKind::levels)) add_levels(out, axes, delta_m);
    if (wants(EngineKind::regions)) add_regions(out, axes, delta_m);
  }
  return out;
}

std::string id_of(const SweepSetting& s) {
  const bool levels = s.engine == EngineKind::levels;
  std::string id = levels ? "levels" : "regions";
  if (s.exact) id += "-exact";
  if (!s.exact && levels) {
    id += "-s0_" + text(s.s0);
    if (std::isfinite(s.kappa)) id += "-kappa_" + text(s.kappa);
  }
  if (!s.exact && !levels) id += "-tolerance_" + text(s.force_tolerance_N);
  if (levels && s.bounds == Bounds::paper) id += "-paper_bounds";
  if (std::isfinite(s.budget_us)) id += "-budget_" + text(s.budget_us);
  return id + "-delta_" + text(s.delta_m);
}

SweepSetting reference_of(const SweepSetting& setting) {
  return exact(setting.engine, Bounds::tight, setting.delta_m);
}

config::Scene with_setting(const config::Scene& scene, const SweepSetting& s) {
  config::Scene out = scene;
  out.settings.engine = s.engine;
  out.settings.exact = s.exact;
  out.settings.s0 = s.s0;
  out.settings.force_tolerance_N = s.force_tolerance_N;
  out.settings.bounds = s.bounds;
  out.settings.delta_m = s.delta_m;
  out.kappa.reset();
  if (std::isfinite(s.kappa)) out.kappa = s.kappa;
  out.budget_us.reset();
  out.reserve_us.reset();
  if (std::isfinite(s.budget_us)) out.budget_us = s.budget_us;
  return out;
}

}  // namespace palpate::cli
