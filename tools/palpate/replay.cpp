// SPDX-License-Identifier: GPL-3.0-or-later
// `palpate replay`: the contact engine over recorded poses, without a device.
#include "tools/palpate/file_format.hpp"
#include "tools/palpate/replay_loop.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/palpate/command.hpp"
#include "tools/palpate/output_file.hpp"
#include "tools/palpate/replay_profile.hpp"

namespace palpate::cli {
namespace {

struct ReplayArguments {
  std::string scene, poses, ticks, contacts, engine;
  bool exact = false, json = false, quiet = false;
  std::optional<double> s0, budget_us, reserve_us, kappa, force_tolerance_N;
  ReplayOptions options;
};

/// The scene as the file has it, then as the command line wants it.
config::Scene load(const ReplayArguments& a) {
  if (a.contacts == a.ticks) {
    throw Failure(kUsage, "ticks and contacts cannot be one file", a.ticks,
                  "give --contacts another name");
  }
  config::Scene scene = config::load_scene(a.scene);
  if (a.engine == "levels") scene.settings.engine = EngineKind::levels;
  if (a.engine == "regions") scene.settings.engine = EngineKind::regions;
  if (a.exact) scene.settings.exact = true;
  if (a.s0) scene.settings.s0 = *a.s0;
  if (a.kappa) scene.kappa = a.kappa;
  if (a.force_tolerance_N) scene.settings.force_tolerance_N = *a.force_tolerance_N;
  const bool own_budget = a.exact || a.budget_us || a.options.budget_units;
  if (own_budget) scene.budget_us = a.budget_us;
  if (own_budget || a.reserve_us) scene.reserve_us = a.reserve_us;
  return scene;
}

/// The figures of a replay, in the units of their names.
struct Summary {
  std::uint64_t p50_ns = 0, p99_ns = 0, max_ns = 0;
  double contacts_mean = 0, force_mean_N = 0, force_max_N = 0;
  std::size_t truncated = 0;
  std::size_t undecided = 0;  ///< no contact, and none ruled out
};

Summary summarise(std::span<const TickRow> ticks) {
  Summary s;
  std::vector<std::uint64_t> times;
  for (const TickRow& row : ticks) {
    const double share = 1.0 / double(ticks.size());
    const double force_N = norm(row.wrench.force_N);
    times.push_back(row.time_ns);
    s.contacts_mean += share * double(row.contacts);
    s.force_mean_N += share * force_N;
    s.force_max_N = std::max(s.force_max_N, force_N);
    if (row.certificate.truncated()) ++s.truncated;
    if (row.certificate.contact == ContactStatus::undecided) ++s.undecided;
  }
  std::sort(times.begin(), times.end());
  s.p50_ns = times[times.size() / 2];
  s.p99_ns = times[times.size() * 99 / 100];
  s.max_ns = times.back();
  return s;
}

void print_json(const Recording& recording, const Summary& s, bool profile) {
  nlohmann::ordered_json json = {
      {"ticks", recording.ticks.size()},
      {"tick_ns", {{"p50", s.p50_ns}, {"p99", s.p99_ns}, {"max", s.max_ns}}},
      {"contacts_mean", s.contacts_mean},
      {"force_N", {{"mean", s.force_mean_N}, {"max", s.force_max_N}}},
      {"truncated", s.truncated},
      {"undecided", s.undecided},
      {"image_bytes", recording.image_bytes},
      {"engine_bytes", recording.engine_bytes}};
  if (profile) json["profile"] = profile_json(*recording.counters);
  std::puts(json.dump().c_str());
}

void print_text(const Recording& recording, const Summary& s) {
  std::printf(
      "%zu ticks: median %.1f µs, p99 %.1f µs, max %.1f µs; %.1f contacts and %.3g N on average; "
      "%zu truncated, %zu undecided\n",
      recording.ticks.size(), double(s.p50_ns) * 1e-3, double(s.p99_ns) * 1e-3,
      double(s.max_ns) * 1e-3, s.contacts_mean, s.force_mean_N, s.truncated, s.undecided);
}

/// CONTACTS.csv: rows are kept as they are while they are few, so that making text of them does not
/// disturb the ticks that are timed, and go to the file once they are many.
class ContactTable {
 public:
  explicit ContactTable(std::string file) : name_(std::move(file)) {
    if (!name_.empty()) rows_.reserve(kRows);
  }

  void add(std::size_t tick, std::span<const Contact> contacts) {
    for (const Contact& contact : contacts) rows_.push_back({tick, contact});
    if (rows_.size() >= kRows) spill();
  }

  /// Nothing where no file was asked for.
  void commit() {
    if (name_.empty()) return;
    spill();
    file_->commit();
  }

 private:
  static constexpr std::size_t kRows = std::size_t(1) << 18;  // about 50 MB

  void spill() {
    if (!file_) {
      file_.emplace(name_);
      file_->append(std::string(kContactsHeader) + "\n");
    }
    file_->append(contact_rows(rows_));
    rows_.clear();
  }

  std::string name_;
  std::vector<ContactRow> rows_;
  std::optional<OutputFile> file_;
};

/// What a table is of, in a file beside it, for `palpate report`.
class About {
 public:
  explicit About(const ReplayArguments& a) {
    const std::filesystem::path table(a.ticks);
    if (std::filesystem::exists(table) && !std::filesystem::is_regular_file(table))
      return;  // a pipe
    const nlohmann::ordered_json json = {
        {"scene", std::filesystem::absolute(a.scene).lexically_normal().string()},
        {"poses", std::filesystem::absolute(a.poses).lexically_normal().string()},
        {"version", PALPATE_VERSION}};
    file_.emplace(std::filesystem::path(table).replace_extension(".about.json"));
    file_->append(json.dump(1) + "\n");
  }
  void commit() {
    if (file_) file_->commit();
  }

 private:
  std::optional<OutputFile> file_;
};

void run(const ReplayArguments& a) {
  const config::Scene scene = load(a);
  const PoseTrack track = read_poses(a.poses, scene);
  require_writable(a.ticks);
  const bake::Progress show = progress(a.quiet);
  ContactTable contacts(a.contacts);
  ReplayListeners listeners;
  listeners.progress = [&](double done) { show("replay", done); };
  if (!a.contacts.empty()) {
    listeners.contacts = [&](std::size_t tick, std::span<const Contact> found) {
      contacts.add(tick, found);
    };
  }
  const Recording recording = replay(scene, track, a.options, listeners);
  if (a.options.profile && !recording.counters) {
    throw Failure(kUsage, "this build counts nothing", "--profile",
                  "configure it with -DPALPATE_COUNTERS=ON");
  }
  const std::string ticks = ticks_csv(recording.ticks);
  OutputFile ticks_file(a.ticks, std::as_bytes(std::span(ticks)));
  About about(a);
  contacts.commit();  // all files or none
  ticks_file.commit();
  about.commit();
  if (!a.quiet && !recording.start_overlap.empty()) {
    std::fprintf(stderr, "Note: %s.\n", recording.start_overlap.c_str());
  }
  const Summary summary = summarise(recording.ticks);
  if (a.json) {
    print_json(recording, summary, a.options.profile);
  } else {
    if (!a.quiet) print_text(recording, summary);
    if (a.options.profile) {
      std::fputs(profile_text(*recording.counters, recording.limits).c_str(), stdout);
    }
  }
}

void add_budget(CLI::App& command, ReplayArguments& a) {
  CLI::Option* time =
      command.add_option("--budget-us", a.budget_us, "stop refining a tick after this time (µs)");
  CLI::Option* units =
      command.add_option("--budget-units", a.options.budget_units,
                         "stop refining a tick after this many convex-pair queries: repeatable");
  time->check(number_between(0, 1e9))->excludes(units);
  units->check(number_between(0, 1e18));
  CLI::Option* more_time =
      command.add_option("--reserve-us", a.reserve_us,
                         "so much longer (µs) for a tick that feels nothing and cannot rule out a "
                         "contact, until it can (regions engine)");
  CLI::Option* more_units =
      command.add_option("--reserve-units", a.options.reserve_units,
                         "the same in units beyond --budget-units: repeatable");
  more_time->check(number_between(0, 1e9))->excludes(units);
  more_units->check(number_between(0, 1e18))->needs(units);
}

}  // namespace

void add_replay(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("replay",
                         "Run the contact engine over recorded poses, without a device. Friction "
                         "and contact damping of the scene are felt, with velocities from the "
                         "poses of successive ticks; coupling and steadying are the loop's alone");
  const auto a = std::make_shared<ReplayArguments>();
  command->add_option("SCENE", a->scene, "scene file (TOML)")->required();
  command->add_option("--poses", a->poses, "recorded poses (CSV)")->required();
  command->add_option("-o,--output", a->ticks, "write a row a tick (CSV)")
      ->required()
      ->check(named_as(".csv"));
  command
      ->add_option("--contacts", a->contacts,
                   "write a row a contact, with points on both surfaces (CSV)")
      ->check(named_as(".csv"));
  command->add_option("--engine", a->engine, "in place of the scene's engine")
      ->check(CLI::IsMember({"levels", "regions"}));
  command->add_flag("--exact", a->exact,
                    "refine to the original surface; unlimited unless a budget is given here, "
                    "whatever the scene says");
  command->add_option("--s0", a->s0, "in place of the scene's s0")->check(number_between(0, 1e6));
  add_budget(*command, *a);
  command->add_option("--kappa", a->kappa, "in place of the scene's kappa (levels engine)")
      ->check(number_between(0, 1e6));
  command
      ->add_option("--force-tolerance", a->force_tolerance_N,
                   "in place of the scene's force_tolerance_N (regions engine)")
      ->check(number_between(0, 1e18));
  command
      ->add_option("--repeat", a->options.repeat,
                   "replay this often, report the last one with the median times")
      ->check(number_between(1, 1000));
  command->add_flag("--profile", a->options.profile,
                    "print what the last repetition was made of: time by stage (means; the sums in "
                    "--json), queries, high-water marks of the pools");
  command->add_flag("--json", a->json, "print the summary as one JSON object");
  command->add_flag("--quiet", a->quiet, "print no progress and no summary");
  command->callback([a] { run(*a); });
}

}  // namespace palpate::cli
