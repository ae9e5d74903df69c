// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/sweep_advice.hpp"

#include <toml++/toml.h>
#include <cmath>
#include <cstdio>
#include <string>
#include <system_error>
#include <tuple>

#include "config/text_file.hpp"
#include "tools/palpate/command.hpp"
#include "tools/palpate/scene_edit.hpp"

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;

toml::table& table(toml::table& in, std::string_view key) {
  return *in.insert(key, toml::table()).first->second.as_table();
}

void put_setting(const SweepSetting& s, double budget_us, toml::table& engine) {
  const bool levels = s.engine == EngineKind::levels;
  engine.insert_or_assign("engine", levels ? "levels" : "regions");
  engine.insert_or_assign("exact", s.exact);
  engine.insert_or_assign("delta_m", s.delta_m);
  engine.insert_or_assign("budget_us", std::isfinite(s.budget_us) ? s.budget_us : budget_us);
  engine.erase("kappa");
  if (!levels) {
    engine.insert_or_assign("force_tolerance_N", s.force_tolerance_N);
    return;
  }
  engine.insert_or_assign("s0", s.s0);
  engine.insert_or_assign("bounds", s.bounds == Bounds::paper ? "paper" : "tight");
  if (std::isfinite(s.kappa)) engine.insert_or_assign("kappa", s.kappa);
}

/// @param from  the scene's file, which its images are relative to  @param to  a folder
void move_images(toml::table& scene, const fs::path& from, const fs::path& to) {
  const fs::path home = fs::absolute(from).parent_path();
  for (toml::node& body : *scene["body"].as_array()) {
    toml::table& keys = *body.as_table();
    const fs::path image = home / keys["image"].value_or(std::string());
    keys.insert_or_assign("image", fs::proximate(image, fs::absolute(to)).string());
  }
}

}  // namespace

const SweepRow* most_accurate(std::span<const SweepRow> rows, double budget_us) {
  const auto rank = [](const SweepRow& row) {
    return std::tuple(row.figures.force_nrmse, row.figures.p999_ns);
  };
  const SweepRow* best = nullptr;
  for (const SweepRow& row : rows) {
    const bool fits = row.figures.p999_ns <= budget_us * 1e3;  // false where nothing was timed
    const bool known = !std::isnan(row.figures.force_nrmse);
    if (fits && known && (!best || rank(row) < rank(*best))) best = &row;
  }
  return best;
}

std::string advice(const SweepRow& row, double budget_us) {
  const SweepFigures& f = row.figures;
  char text[640];
  std::snprintf(text, sizeof text,
                "Within %g µs on this machine: %s\n"
                "  costs  median %.1f µs, p99 %.1f µs, p99.9 %.1f µs, longest %.1f µs over %zu "
                "ticks\n"
                "  loses  force error %.3g %% (NRMSE), torque error %.3g %%; a hand could notice "
                "it in %.3g %% of the ticks\n"
                "  ended by the budget in %.3g %% of the ticks\n",
                budget_us, id_of(row.setting).c_str(), f.median_ns * 1e-3, f.p99_ns * 1e-3,
                f.p999_ns * 1e-3, f.max_ns * 1e-3, f.timed_ticks, 100 * f.force_nrmse,
                100 * f.torque_nrmse, 100 * f.noticeable, 100 * f.truncated);
  return text;
}

std::string scene_text(const fs::path& scene, const fs::path& folder, const SweepSetting& setting,
                       double budget_us) {
  try {
    std::string text;
    if (const std::error_code error = config::read_text(scene, text)) {
      throw Failure(kRefused, "cannot read the scene (" + error.message() + ")", scene.string(),
                    "leave it in place during a sweep");
    }
    toml::table keys = toml::parse(text);
    put_setting(setting, budget_us, table(keys, "engine"));
    move_images(keys, scene, folder);
    return edited_scene(text, keys);
  } catch (const toml::parse_error& e) {
    throw Failure(kUsage, std::string("the scene has changed: ") + e.what(), scene.string(),
                  "let nobody write to it during a sweep");
  }
}

}  // namespace palpate::cli
