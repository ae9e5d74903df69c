// SPDX-License-Identifier: GPL-3.0-or-later
// `palpate sweep`: speed against accuracy, on the user's own scene and motion. docs/SWEEP.md.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "config/scene_keys.hpp"
#include "config/text_file.hpp"
#include "tools/palpate/command.hpp"
#include "tools/palpate/output_file.hpp"
#include "tools/palpate/poses.hpp"
#include "tools/palpate/sweep_advice.hpp"
#include "tools/palpate/sweep_folder.hpp"
#include "tools/palpate/sweep_plots.hpp"
#include "tools/palpate/sweep_runs.hpp"
#include "tools/palpate/sweep_table.hpp"
#include "tools/palpate/words.hpp"

namespace palpate::cli {
namespace {

// The tick's fixed work comes after the deadline, so that a budget is met by a smaller one.
constexpr double kSharesOfBudget[] = {0.5, 0.75, 0.9};

struct SweepArguments {
  std::string scene, poses, folder;
  std::vector<std::string> engines = {"levels", "regions"}, bounds = {"tight"};
  std::vector<double> s0 = {0.005, 0.01, 0.025, 0.05}, kappa, force_tolerance_N, budget_us, delta_m;
  Observer observer;
  SweepRuns runs;
  bool recommend = false, json = false, quiet = false;
};

/// Shares of the force at touch, stiffness times delta, that regions are tried with.
constexpr double kToleranceShares[] = {0.1, 1.0, 10.0};

SweepAxes axes_of(const SweepArguments& a, const config::Scene& scene) {
  SweepAxes axes;
  for (const std::string& name : a.engines) {
    axes.engines.push_back(name == "levels" ? EngineKind::levels : EngineKind::regions);
  }
  for (const std::string& name : a.bounds) {
    axes.bounds.push_back(name == "paper" ? Bounds::paper : Bounds::tight);
  }
  axes.s0 = a.s0;
  axes.kappa = a.kappa.empty() ? std::vector{scene.kappa.value_or(kNoLimit)} : a.kappa;
  axes.delta_m = a.delta_m.empty() ? std::vector{scene.settings.delta_m} : a.delta_m;
  axes.force_tolerance_N = a.force_tolerance_N;
  for (const double share : kToleranceShares) {
    if (!a.force_tolerance_N.empty()) break;
    const Settings& s = scene.settings;
    axes.force_tolerance_N.push_back(share * s.stiffness_N_per_m * s.delta_m);
  }
  axes.budget_us = a.budget_us;
  if (a.recommend) {
    axes.budget_us = {kNoLimit};
    for (const double share : kSharesOfBudget) axes.budget_us.push_back(share * a.budget_us[0]);
  }
  if (axes.budget_us.empty()) axes.budget_us = {kNoLimit};
  return axes;
}

void require_one_budget(const SweepArguments& a) {
  if (!a.recommend || (a.budget_us.size() == 1 && std::isfinite(a.budget_us[0]))) return;
  throw Failure(kUsage, "advice needs one budget", "--recommend",
                "give --budget-us with one number beside it");
}

/// There is nothing to compare with where the levels engine was not asked for.
std::string times_text(double ratio) { return std::isnan(ratio) ? "-" : format("%.1f", ratio); }

void print_table(std::span<const SweepRow> rows) {
  std::printf("%-60s %11s %11s %8s %8s %10s %8s\n", "setting", "median µs", "p99.9 µs", "force %",
              "torque %", "noticeable", "speed-up");
  for (const SweepRow& row : rows) {
    const SweepFigures& f = row.figures;
    std::printf("%-60s %10.1f %10.1f %8.2f %8.2f %10.3f %8s%s\n", id_of(row.setting).c_str(),
                f.median_ns * 1e-3, f.p999_ns * 1e-3, 100 * f.force_nrmse, 100 * f.torque_nrmse,
                f.noticeable, times_text(row.speedup_median).c_str(), row.pareto ? " *" : "");
  }
  std::puts("* nothing here is both faster and more accurate");
}

void recommend(const SweepArguments& a, const SweepFolder& folder, const config::Scene& scene,
               std::span<const SweepRow> rows) {
  const double budget_us = a.budget_us[0];
  const SweepRow* best = most_accurate(rows, budget_us);
  if (!best) {
    throw Failure(kOther, "no setting's p99.9 fits " + config::to_text(budget_us) + " µs", a.scene,
                  "raise --budget-us, or try larger --s0 and --force-tolerance");
  }
  const auto file = folder.file("recommended.toml");
  write_file(file, scene_text(scene.file, a.folder, best->setting, budget_us));
  if (!a.json) std::printf("%s  scene  %s\n", advice(*best, budget_us).c_str(), file.c_str());
}

/// What was promised and does not hold is said, and is the exit status.
void judge(std::span<const SweepRow> rows, std::size_t differing) {
  std::size_t broken = 0;
  for (const SweepRow& row : rows) broken += row.figures.certificates_broken;
  if (broken == 0 && differing == 0) return;
  std::fprintf(stderr,
               "palpate: %zu certificates are broken; %zu settings computed something else the "
               "second time\n",
               broken, differing);
  set_exit(kPromiseBroken);
}

/// Settings of earlier sweeps in the folder stay in its table.
std::vector<SweepSetting> with_earlier(std::vector<SweepSetting> settings,
                                       const SweepFolder& folder) {
  std::string table;
  if (config::read_text(folder.file("sweep.json"), table)) return settings;
  for (const SweepSetting& earlier : settings_of(table)) {
    const bool is_new = std::find(settings.begin(), settings.end(), earlier) == settings.end();
    if (is_new) settings.push_back(earlier);
  }
  return settings;
}

void sweep(const SweepArguments& a) {
  require_one_budget(a);
  const config::Scene scene = config::load_scene(a.scene);
  const PoseTrack track = read_poses(a.poses, scene);
  const SweepFolder folder(a.folder, scene, a.poses, track.ticks.size(),
                           {a.observer, a.runs.processor_time});
  const std::vector<SweepSetting> settings = with_earlier(expand(axes_of(a, scene)), folder);
  std::size_t differing = 0;
  {
    const bake::Progress show = progress(a.quiet);
    differing = run_settings(folder, scene, track, settings, a.runs, show);
  }
  const std::vector<SweepRow> rows = tabulate(folder, settings, a.observer);
  const std::string as_json = to_json(rows);
  write_file(folder.file("sweep.csv"), to_csv(rows));
  write_file(folder.file("trade.svg"), trade_plot(rows));
  write_file(folder.file("profile.svg"), profile_plot(folder, rows));
  write_file(folder.file("sweep.json"), as_json);
  if (a.json) {
    std::fputs(as_json.c_str(), stdout);
  } else if (!a.quiet) {
    print_table(rows);
  }
  judge(rows, differing);
  if (a.recommend) recommend(a, folder, scene, rows);
}

/// A number of the range, or "inf".
CLI::Validator number_or_inf(double min, double max) {
  const std::string range = config::to_text(min) + " to " + config::to_text(max) + " or inf";
  const auto check = [min, max, range](const std::string& text) {
    double value = 0;
    const bool ok = CLI::detail::lexical_cast(text, value) && value >= min &&
                    (value <= max || std::isinf(value));
    return ok ? std::string() : "'" + text + "' is no number from " + range;
  };
  return {check, range, "number"};
}

void add_axes(CLI::App& command, SweepArguments& a) {
  command.add_option("--engine", a.engines, "levels, regions")
      ->delimiter(',')
      ->check(CLI::IsMember({"levels", "regions"}))
      ->capture_default_str();
  command.add_option("--s0", a.s0, "thresholds of levels")
      ->delimiter(',')
      ->check(number_between(0, 1e6))
      ->capture_default_str();
  command.add_option("--kappa", a.kappa, "shares of delta, or inf; default: the scene's")
      ->delimiter(',')
      ->check(number_or_inf(0, 1e6));
  command
      .add_option("--force-tolerance", a.force_tolerance_N,
                  "N, of regions; default: 0.1, 1 and 10 times stiffness times delta")
      ->delimiter(',')
      ->check(number_between(0, 1e18));
  command.add_option("--budget-us", a.budget_us, "µs, or inf; default: inf")
      ->delimiter(',')
      ->check(number_or_inf(0, 1e9));
  command.add_option("--bounds", a.bounds, "tight, paper")
      ->delimiter(',')
      ->check(CLI::IsMember({"tight", "paper"}))
      ->capture_default_str();
  command.add_option("--delta", a.delta_m, "m; default: the scene's")
      ->delimiter(',')
      ->check(number_between(1e-18, 1e18));
}

void add_measures(CLI::App& command, SweepArguments& a) {
  command
      .add_option("--timed-ticks", a.runs.timed_ticks,
                  "measure the time of the first this many ticks, alone on the machine")
      ->check(number_between(1, 1e9))
      ->capture_default_str();
  command.add_option("--repeat", a.runs.repeat, "time each tick this often, take the median")
      ->check(number_between(1, 1000))
      ->capture_default_str();
  command.add_option("--threads", a.runs.threads, "for what is not timed; 0: all cores")
      ->check(number_between(0, kMaxThreads))
      ->capture_default_str();
  command.add_flag("--processor-time", a.runs.processor_time,
                   "measure processor time, for machines that are not quiet; budgets too");
  command
      .add_option("--weber", a.observer.weber_fraction,
                  "smallest share of a force that a hand notices")
      ->check(number_between(0, 10))
      ->capture_default_str();
  command
      .add_option("--floor-N", a.observer.floor_N,
                  "smallest difference of force that it notices, N")
      ->check(number_between(0, 1e6))
      ->capture_default_str();
}

}  // namespace

void add_sweep(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "sweep", "Speed against accuracy: replay a motion at many settings and exactly");
  const auto a = std::make_shared<SweepArguments>();
  command->add_option("SCENE", a->scene, "scene file (TOML)")->required();
  command->add_option("--poses", a->poses, "recorded poses (CSV)")->required();
  command
      ->add_option("-o,--output", a->folder,
                   "folder for table, plots and ticks; one that is begun is continued")
      ->required();
  add_axes(*command, *a);
  add_measures(*command, *a);
  command->add_flag("--recommend", a->recommend,
                    "print the most accurate setting whose p99.9 fits --budget-us, and write its "
                    "scene into the folder");
  command->add_flag("--json", a->json, "print the table as JSON");
  command->add_flag("--quiet", a->quiet, "print no progress and no table");
  command->callback([a] { sweep(*a); });
}

}  // namespace palpate::cli
