// SPDX-License-Identifier: GPL-3.0-or-later
// Work of the levels engine by setting and by budget, in counts: no clock is read.
//
//   bench_levels settings [TICKS [SCENE...]]   queries and front by setting
//   bench_levels budgets  [TICKS [SCENE...]]   accuracy against the budget in work units
//
// Scenes: golf_on_golf, ellipsoid_on_golf, jaws; default: all.
//
// Rows are CSV, one for each scene, contact tolerance (share of the smaller radius) and setting.
// front and queries are means over the ticks; force_nrmse is against exact ticks, of their largest
// force, from the tenth tick on; budget_nrmse is the same against what the setting gives without a
// budget; none counts ticks without a contact where an exact tick has one; bound_of_delta is the
// mean certified error of the distance over delta; lost counts ticks in which an exact tick has a
// contact that is nearer than what the certificate allows.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <vector>

#include "tools/bench/scenes.hpp"

namespace palpate {
namespace {

using bench::Bench;
using bench::Body;
using bench::SceneName;

constexpr std::size_t kSettled = 10;  // ticks after which accuracy counts
constexpr SceneName kScenes[] = {{"golf_on_golf", "golf_ball", "golf_ball", false},
                                 {"ellipsoid_on_golf", "ellipsoid", "golf_ball", false},
                                 {"jaws", "jaw_lower", "jaw_upper", true}};

struct Variant {
  const char* name;
  void (*change)(Settings&);
};

constexpr Variant kExact[] = {
    {"exact", [](Settings&) {}},
    {"exact, bounds = paper", [](Settings& s) { s.bounds = Bounds::paper; }}};

constexpr Variant kSimplified[] = {
    {"s0 = 0", [](Settings& s) { s.s0 = 0; }},
    {"s0 = 0.025", [](Settings&) {}},
    {"s0 = 0.2", [](Settings& s) { s.s0 = 0.2; }},
    {"s0 = 0.025, bounds = paper", [](Settings& s) { s.bounds = Bounds::paper; }},
    {"kappa = 0.1", [](Settings& s) {
       s.s0 = 1e6;
       s.kappa = 0.1;
     }}};

struct Run {
  std::vector<double> queries, front, contacts, bound_m;
  std::vector<Vec3d> force_N;
  std::vector<double> least_m;  ///< upper end of what may be there: the contact's, or delta
  std::size_t truncated = 0;
};

Run run(const Body& a, const Body& b, const Settings& settings, const std::vector<Pose>& poses,
        std::uint64_t units) {
  Bench bench(a, b, settings);
  Run out;
  for (const Pose& pose : poses) {
    const TickResult r = bench.tick_at(pose, {.units = units});
    out.queries.push_back(static_cast<double>(r.queries));
    out.front.push_back(static_cast<double>(r.front_nodes));
    out.contacts.push_back(static_cast<double>(r.contacts.size()));
    out.bound_m.push_back(r.certificate.error_bound_m);
    out.force_N.push_back(r.wrench.force_N);
    out.least_m.push_back(r.contacts.empty() ? settings.delta_m : r.min_distance_m);
    if (r.certificate.truncated()) ++out.truncated;
  }
  return out;
}

std::size_t lost(const Run& r, const Run& exact) {
  constexpr double kRounding_m = 1e-8;
  std::size_t count = 0;
  for (std::size_t i = 0; i < r.least_m.size(); ++i) {
    if (exact.least_m[i] < r.least_m[i] - r.bound_m[i] - kRounding_m) ++count;
  }
  return count;
}

std::size_t without_contact(const Run& r, const Run& exact) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < r.contacts.size(); ++i) {
    if (exact.contacts[i] > 0 && r.contacts[i] == 0) ++count;
  }
  return count;
}

struct Place {
  const char* scene;
  double delta_rel;
  double delta_m;
};

/// @param whole  the same setting without a budget
void print_row(const Place& at, const char* variant, const Run& r, const Run& exact,
               const Run& whole) {
  std::printf("%s,%g,\"%s\",%.1f,%.1f,%.1f,%.4f,%.4f,%.4f,%.3f,%zu,%zu\n", at.scene, at.delta_rel,
              variant, bench::mean(r.queries), bench::mean(r.front), bench::mean(r.contacts),
              bench::nrmse(r.force_N, exact.force_N, kSettled),
              bench::nrmse(r.force_N, whole.force_N, kSettled), bench::mean(r.bound_m) / at.delta_m,
              static_cast<double>(r.truncated) / static_cast<double>(r.least_m.size()),
              without_contact(r, exact), lost(r, exact));
  std::fflush(stdout);
}

void by_settings(const Place& at, const Body& a, const Body& b, const std::vector<Pose>& poses) {
  constexpr std::uint64_t kUnlimited = Budget{}.units;
  const Settings base{.delta_m = at.delta_m};
  Settings exact = base;
  exact.exact = true;
  const Run truth = run(a, b, exact, poses, kUnlimited);
  for (const Variant& variant : kExact) {
    Settings settings = exact;
    variant.change(settings);
    const Run found = run(a, b, settings, poses, kUnlimited);
    print_row(at, variant.name, found, truth, found);
  }
  for (const Variant& variant : kSimplified) {
    Settings settings = base;
    variant.change(settings);
    const Run found = run(a, b, settings, poses, kUnlimited);
    print_row(at, variant.name, found, truth, found);
  }
}

constexpr Variant kUnderBudget[] = {
    {"exact", [](Settings& s) { s.exact = true; }},
    {"exact, order = deviation",
     [](Settings& s) {
       s.exact = true;
       s.order = Order::deviation;
     }},
    {"s0 = 0", [](Settings& s) { s.s0 = 0; }},
    {"s0 = 0.025", [](Settings&) {}},
    {"s0 = 0.025, order = deviation", [](Settings& s) { s.order = Order::deviation; }}};

void by_budget(const Place& at, const Body& a, const Body& b, const std::vector<Pose>& poses) {
  const Run truth = run(a, b, {.delta_m = at.delta_m, .exact = true}, poses, Budget{}.units);
  for (const Variant& variant : kUnderBudget) {
    Settings settings{.delta_m = at.delta_m};
    variant.change(settings);
    const Run whole = run(a, b, settings, poses, Budget{}.units);
    for (std::uint64_t units = 16; units <= 16384; units *= 2) {
      char name[64];
      std::snprintf(name, sizeof name, "%s, %llu units", variant.name,
                    static_cast<unsigned long long>(units));
      print_row(at, name, run(a, b, settings, poses, units), truth, whole);
    }
  }
}

void measure(const SceneName& scene, bool budgets, int ticks) {
  const Body a(scene.a, 0.02, bake::ForEngine::both);
  const Body b(scene.b, 0.02, bake::ForEngine::both);
  const double radius = std::min(a.view.header->radius_m, b.view.header->radius_m);
  for (const double delta_rel : {0.01, 0.02, 0.05}) {
    const Place at{scene.name, delta_rel, delta_rel * radius};
    const std::vector<Pose> poses = bench::motion(scene, a, b, at.delta_m, ticks);
    (budgets ? by_budget : by_settings)(at, a, b, poses);
  }
}

bool wanted(const SceneName& scene, int argc, char** argv) {
  for (int i = 3; i < argc; ++i) {
    if (std::strcmp(argv[i], scene.name) == 0) return true;
  }
  return argc <= 3;
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
  const std::string_view mode = argc > 1 ? argv[1] : "";
  if (mode != "settings" && mode != "budgets") {
    std::fputs("usage: bench_levels settings|budgets [TICKS [SCENE...]]\n", stderr);
    return 2;
  }
  const int ticks = argc > 2 ? std::max(20, std::atoi(argv[2])) : 200;
  std::puts(
      "scene,delta_rel,setting,queries,front,contacts,force_nrmse,budget_nrmse,bound_of_delta,"
      "truncated,none,lost");
  for (const palpate::SceneName& scene : palpate::kScenes) {
    if (palpate::wanted(scene, argc, argv)) palpate::measure(scene, mode == "budgets", ticks);
  }
  return 0;
}
