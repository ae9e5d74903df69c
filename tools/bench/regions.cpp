// SPDX-License-Identifier: GPL-3.0-or-later
// Time and accuracy of the region engine on scenes of two detailed objects.
//
//   bench_regions [TICKS [SCENE[:DELTA[:LEFT_OUT]]...]]
//                                                scenes: jaws, tips, golf, socket, screw, joint,
//                                                gears; default: all, with 0.01, 0.02 and 0.05;
//                                                detail left out before baking, against all of it
//   bench_regions TICKS paced [KERNELS]          all scenes at 0.02 under budgets of time, longer
//                                                by as much as FCL takes longer here than .82 ms
//                                                for one distance of jaws tip to tip
//   bench_regions TICKS growth [KERNELS]         jaws with more and more triangles at one motion,
//                                                with tolerances of force, in twenty turns
//   bench_regions TICKS detail [KERNELS]         jaws with less and less detail left, likewise
//   bench_regions TICKS divided [KERNELS]        all scenes at 0.01 and 0.02 by width of regions,
//                                                against the exact force of those a quarter as wide
//   bench_regions TICKS instructions             jaws by each instruction set of this processor
//
// KERNELS: scalar, base, avx2, avx512; default: best.
//
// A row (CSV) for each scene, contact tolerance (relative to the radius) and mode: exact with all
// state kept (warm) or forgotten at each tick (cold), with a tolerance of force, and under budgets
// of time or of work units; under these also with the poses in an order in which each is far from
// the one before it, and all state kept (jump). Times are of the thread's own processor clock, so
// that a busy machine shows in the caches only; units are those of the engine
// (TickResult::queries), counted and not timed. without_contact counts ticks that have found none
// where the exact ones do, denied those of them whose certificate rules one out. force_nrmse is
// against the exact ticks, of their largest force, over all ticks but the first ten; felt_nrmse is
// that of the force on display, where force_nrmse sums over regions; settled_* are of the second
// half of the ticks (settled_us: mean); bound_of_force is the median of the certified error over
// the largest sum; exact is the share of ticks whose regions' forces, sizes summed, miss no more
// than a micronewton, and bound_ratio the median of the certified error over what they miss in the
// others (0: there are none); force_step is the largest change of that sum from tick to tick. Where
// FCL is installed, its distance of the same meshes (one least distance, OBBRSS) is asked between
// the exact ticks, pose by pose; of_fcl is our time by its time, summed over the run.
//
// A budget of time is run five times, and its row is the run of the median felt_nrmse; felt_least
// and felt_most are those of the best and the worst. For a shared host may take nine tenths of a
// processor's pace for tens of milliseconds, which is tens of ticks in a row, and a run that it
// has done this to tells of the host.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/bench/scenes.hpp"
#if defined(PALPATE_BENCH_FCL)
#include "tools/bench/mesh_fcl.hpp"
#endif
#include "tools/palpate/clocks.hpp"

namespace palpate::bench {
namespace {

constexpr int kStarted = 10;  // ticks after which a budgeted run counts

constexpr SceneName kScenes[] = {
    {"jaws", "jaw_lower", "jaw_upper", true},  {"tips", "jaw_lower", "jaw_lower", false, true},
    {"golf", "golf_ball", "golf_ball", false}, {"socket", "golf_ball", "golf_shell", true},
    {"screw", "screw", "nut", true},           {"joint", "ball_joint_head", "ball_joint_cup", true},
    {"gears", "gear_60", "gear_50", false}};

Budget within(double budget_us) {
  Budget budget;
  if (budget_us > 0) {
    static cli::ProcessorClock clock;
    budget.clock_ns = cli::ProcessorClock::read;
    budget.clock_context = &clock;
    budget.deadline_ns = clock.now_ns() + static_cast<std::uint64_t>(budget_us * 1e3);
  }
  return budget;
}

double size_N(const Settings& settings, const Contact& c) {
  return settings.stiffness_N_per_m * (settings.delta_m - c.distance_m);
}

/// Of all regions: what clusters make of them is the force stage's affair, and neighbours whose
/// nearest point is a common one join a cluster or not by the last bit.
Vec3d summed_force(const Settings& settings, const TickResult& r) {
  Vec3d sum{};
  for (const Contact& c : r.contacts) {
    sum += size_N(settings, c) * c.normal;
  }
  return sum;
}

double summed_sizes(const Settings& settings, const TickResult& r) {
  double sum = 0;
  for (const Contact& c : r.contacts) sum += size_N(settings, c);
  return sum;
}

struct Run {
  explicit Run(std::size_t ticks = 0)
      : us(ticks),
        contacts(ticks),
        near(ticks),
        units(ticks),
        bound_N(ticks),
        sizes_N(ticks),
        force_N(ticks),
        felt_N(ticks),
        status(ticks) {}

  std::vector<double> us, contacts, near, units, bound_N;
  std::vector<double> settled_us;  ///< of the second half of the ticks
  std::vector<double> sizes_N;     ///< of the regions' forces, summed
  std::vector<Vec3d> force_N;      ///< summed over regions
  std::vector<Vec3d> felt_N;
  std::vector<ContactStatus> status;
  double fcl_us = 0;  ///< mean; 0: not asked
};

/// What is asked between two ticks.
#if defined(PALPATE_BENCH_FCL)
constexpr bool kHasPeer = true;
using Peer = FclPair;
double peer_us(const Peer& peer, const Pose& pose) {
  const std::uint64_t start = cli::processor_ns();
  const double distance = peer.distance(pose, {});
  const double us = static_cast<double>(cli::processor_ns() - start) * 1e-3;
  return distance >= 0 ? us : 0;
}
#else
constexpr bool kHasPeer = false;
struct Peer {
  Peer(const bake::Mesh&, const bake::Mesh&) {}
};
double peer_us(const Peer&, const Pose&) { return 0; }
#endif

/// What the engine knows when a tick begins.
enum class From : std::uint8_t { pose_before, nothing, far_pose };

constexpr From kFroms[] = {From::pose_before, From::nothing, From::far_pose};

constexpr const char* name_of(From from) {
  constexpr const char* kNames[] = {"warm", "cold", "jump"};
  return kNames[static_cast<std::size_t>(from)];
}

struct Plan {
  From from = From::pose_before;
  double budget_us = 0;
  std::uint64_t budget_units = 0;
  double tolerance_N = 0;
  const Peer* peer = nullptr;
};

Budget budget_of(const Plan& plan) {
  Budget budget = within(plan.budget_us);
  if (plan.budget_units > 0) budget.units = plan.budget_units;
  return budget;
}

/// From each pose to one some two fifths of them away, through all.
std::size_t stride_of(From from, std::size_t poses) {
  if (from != From::far_pose) return 1;
  std::size_t stride = 2 * poses / 5;
  while (std::gcd(stride, poses) != 1) ++stride;
  return stride;
}

/// Whatever the order, results are in that of the poses.
Run run(Bench& bench, const std::vector<Pose>& poses, const Plan& plan) {
  const std::size_t count = poses.size();
  const std::size_t stride = stride_of(plan.from, count);
  Run out(count);
  bench.forget();
  for (std::size_t visited = 0; visited < count; ++visited) {
    const std::size_t i = visited * stride % count;
    if (plan.from == From::nothing) bench.forget();
    const std::uint64_t start = cli::processor_ns();
    const TickResult r = bench.tick_at(poses[i], budget_of(plan));
    out.us[i] = static_cast<double>(cli::processor_ns() - start) * 1e-3;
    out.contacts[i] = static_cast<double>(r.contacts.size());
    out.near[i] = static_cast<double>(r.front_nodes);
    out.units[i] = static_cast<double>(r.queries);
    out.status[i] = r.certificate.contact;
    out.bound_N[i] = r.certificate.force_bound_N;
    out.sizes_N[i] = summed_sizes(bench.settings(), r);
    out.force_N[i] = summed_force(bench.settings(), r);
    out.felt_N[i] = r.wrench.force_N;
    if (plan.peer != nullptr) {
      out.fcl_us += peer_us(*plan.peer, poses[i]) / static_cast<double>(count);
    }
  }
  out.settled_us.assign(out.us.begin() + std::ptrdiff_t(count / 2), out.us.end());
  return out;
}

/// Ticks with this status where the exact query has a contact.
int in_contact(const Run& r, const Run& exact, ContactStatus status) {
  int count = 0;
  for (std::size_t i = 0; i < r.status.size(); ++i) {
    count += r.status[i] == status && exact.contacts[i] > 0 ? 1 : 0;
  }
  return count;
}

/// How far the certificate is from what is missing.
struct Tightness {
  double exact = 0;  ///< share of the ticks that miss nothing
  double ratio = 0;  ///< of the others: median of certified by missing
};

Tightness tightness(const Run& r, const Run& exact) {
  constexpr double kNothing_N = 1e-6;
  std::vector<double> ratios;
  for (std::size_t i = kStarted; i < r.bound_N.size(); ++i) {
    const double missing_N = exact.sizes_N[i] - r.sizes_N[i];
    if (missing_N > kNothing_N) ratios.push_back(r.bound_N[i] / missing_N);
  }
  const auto counted = static_cast<double>(r.bound_N.size() - kStarted);
  return {1 - static_cast<double>(ratios.size()) / counted, percentile(ratios, 0.5)};
}

/// How far the force on display is off.
double felt_error(const Run& r, const Run& exact) {
  return nrmse(r.felt_N, exact.felt_N, kStarted);
}

/// Of several runs of one plan.
struct FeltErrors {
  double least = 0;
  double most = 0;
};

void print_row(const char* scene, double delta_rel, const Plan& plan, const Run& r,
               const Run& exact, const std::optional<FeltErrors>& runs = {}) {
  double peak = 0;
  double step = 0;
  for (std::size_t i = 0; i < exact.force_N.size(); ++i) {
    peak = std::max(peak, norm(exact.force_N[i]));
    if (i > 0) step = std::max(step, norm(exact.force_N[i] - exact.force_N[i - 1]));
  }
  const std::vector<double> settled(r.units.begin() + std::ptrdiff_t(r.units.size() / 2),
                                    r.units.end());
  const Tightness tight = tightness(r, exact);
  const int denied = in_contact(r, exact, ContactStatus::ruled_out);
  const int without_contact = denied + in_contact(r, exact, ContactStatus::undecided);
  std::printf(
      "%s,%g,%s,%g,%g,%g,%.1f,%.1f,%.1f,%.1f,%.1f,%.0f,%.0f,%.1f,%.1f,"
      "%d,%d,%.4f,%.4f,%.4f,%.4f,%.2f,%.1f,%.4f",
      scene, delta_rel, name_of(plan.from), plan.budget_us, double(plan.budget_units),
      plan.tolerance_N, mean(r.us), percentile(r.us, 0.5), percentile(r.us, 0.99),
      mean(r.settled_us), percentile(r.settled_us, 0.5), mean(r.units), mean(settled), mean(r.near),
      mean(r.contacts), without_contact, denied, nrmse(r.force_N, exact.force_N, kStarted),
      felt_error(r, exact), nrmse(r.felt_N, exact.felt_N, r.felt_N.size() / 2),
      percentile(r.bound_N, 0.5) / peak, tight.exact, tight.ratio, step / peak);
  if (r.fcl_us > 0) {
    std::printf(",%.1f,%.3f", r.fcl_us, mean(r.us) / r.fcl_us);
  } else {
    std::printf(",,");
  }
  if (runs) {
    std::printf(",%.4f,%.4f\n", runs->least, runs->most);
  } else {
    std::printf(",,\n");
  }
  std::fflush(stdout);
}

/// Several runs, of which the row is the one of the median error.
/// @param plan_now  a Plan with a budget of time, asked before each
void print_median_row(const char* scene, double delta_rel, Bench& bench,
                      const std::vector<Pose>& poses, const Run& exact, auto plan_now) {
  constexpr std::size_t kRuns = 5;
  struct Planned {
    Plan plan;
    Run run;
    double error = 0;
  };
  std::vector<Planned> all;
  for (std::size_t i = 0; i < kRuns; ++i) {
    const Plan plan = plan_now();
    Run found = run(bench, poses, plan);
    const double error = felt_error(found, exact);
    all.push_back({plan, std::move(found), error});
  }
  std::sort(all.begin(), all.end(),
            [](const Planned& x, const Planned& y) { return x.error < y.error; });
  const Planned& median = all[kRuns / 2];
  print_row(scene, delta_rel, median.plan, median.run, exact,
            FeltErrors{all.front().error, all.back().error});
}

/// What an argument asks for.
struct Asked {
  double delta_rel = 0;      ///< 0: all
  double max_deviation = 0;  ///< of both bodies
};

constexpr double kBudgets_us[] = {50, 100, 250, 500};

/// Forgetting all, and under budgets, from whatever a tick may begin with.
void print_plans(const SceneName& scene, double delta_rel, Bench& bench,
                 const std::vector<Pose>& poses, const Run& exact) {
  const auto print_one = [&](const Plan& plan) {
    print_row(scene.name, delta_rel, plan, run(bench, poses, plan), exact);
  };
  print_one({.from = From::nothing});
  for (const double budget_us : kBudgets_us) {
    for (const From from : kFroms) {
      print_median_row(scene.name, delta_rel, bench, poses, exact,
                       [&] { return Plan{.from = from, .budget_us = budget_us}; });
    }
  }
  for (const std::uint64_t units :
       {100u, 200u, 300u, 400u, 500u, 600u, 1000u, 2500u, 5000u, 10000u}) {
    for (const From from : kFroms) print_one({.from = from, .budget_units = units});
  }
}

/// Two bodies and their motion.
struct Staged {
  Staged(const SceneName& scene, double delta_rel, int ticks)
      : a(scene.a, delta_rel, bake::ForEngine::regions),
        b(scene.b, delta_rel, bake::ForEngine::regions),
        delta(delta_rel * std::min(a.view.header->radius_m, b.view.header->radius_m)),
        poses(motion(scene, a, b, delta, ticks)) {}

  Settings settings() const { return {.engine = EngineKind::regions, .delta_m = delta}; }

  Body a, b;
  double delta;
  std::vector<Pose> poses;
};

void measure(const SceneName& scene, const Asked& asked, int ticks) {
  const double delta_rel = asked.delta_rel;
  const Staged staged(scene, delta_rel, ticks);
  const std::vector<Pose>& poses = staged.poses;
  const Peer peer(mesh_of(scene.a), mesh_of(scene.b));
  Bench bench(staged.a, staged.b, staged.settings());
  const Run exact = run(bench, poses, {.peer = &peer});
  print_row(scene.name, delta_rel, {}, exact, exact);
  if (!(asked.max_deviation > 0)) {
    print_plans(scene, delta_rel, bench, poses, exact);
    return;
  }
  const Body less_a(scene.a, delta_rel, bake::ForEngine::regions, 0, asked.max_deviation);
  const Body less_b(scene.b, delta_rel, bake::ForEngine::regions, 0, asked.max_deviation);
  Bench less(less_a, less_b, bench.settings());
  print_row(scene.name, delta_rel, {}, run(less, poses, {}), exact);
  print_plans(scene, delta_rel, less, poses, exact);
}

/// How many times as long as .82 ms FCL takes here and now for one distance of jaws tip to tip.
double host_pace(const Peer& tips, const std::vector<Pose>& poses) {
  constexpr double kReference_us = 820;
  std::vector<double> us;
  for (const Pose& pose : poses) us.push_back(peer_us(tips, pose));
  return percentile(us, 0.5) / kReference_us;
}

/// A machine's speed changes while this runs: it is asked before each run.
void measure_paced(int ticks, const regions::Kernels& kernels) {
  constexpr double kDeltaRel = 0.02;
  constexpr int kAsked = 100;
  constexpr SceneName kTips = kScenes[1];
  const std::vector<Pose> tips_poses = Staged(kTips, kDeltaRel, kAsked).poses;
  const Peer tips(mesh_of(kTips.a), mesh_of(kTips.b));
  for (const SceneName& scene : kScenes) {
    const Staged staged(scene, kDeltaRel, ticks);
    Bench bench(staged.a, staged.b, staged.settings());
    bench.use(kernels);
    const Run exact = run(bench, staged.poses, {});
    for (const double budget_us : kBudgets_us) {
      for (const From from : kFroms) {
        print_median_row(scene.name, kDeltaRel, bench, staged.poses, exact, [&] {
          return Plan{.from = from, .budget_us = budget_us * host_pace(tips, tips_poses)};
        });
      }
    }
  }
}

/// How much of a force is the choice of regions: of their width times a share, against a quarter.
void measure_divided(const SceneName& scene, double delta_rel, int ticks,
                     const regions::Kernels& kernels) {
  const Body b(scene.b, delta_rel, bake::ForEngine::regions);
  std::vector<Pose> poses;
  double delta = 0;
  std::optional<Run> truth;
  for (const double share : {0.25, 0.5, 0.75, 1.0}) {
    // Regions are as wide as the root of what they are made for (host_bake/regions/partition.hpp).
    const Body a(scene.a, share * share * delta_rel, bake::ForEngine::regions);
    if (poses.empty()) {
      delta = delta_rel * std::min(a.view.header->radius_m, b.view.header->radius_m);
      poses = motion(scene, a, b, delta, ticks);
    }
    Bench bench(a, b, {.engine = EngineKind::regions, .delta_m = delta});
    bench.use(kernels);
    char name[64];
    std::snprintf(name, sizeof name, "%s_%g", scene.name, share);
    for (const Plan& plan : {Plan{}, Plan{.budget_us = 250}, Plan{.budget_units = 2500},
                             Plan{.from = From::nothing, .budget_units = 2500}}) {
      const Run found = run(bench, poses, plan);
      if (!truth) truth = found;
      print_row(name, delta_rel, plan, found, *truth);
    }
  }
}

void measure_divided(int ticks, const regions::Kernels& kernels) {
  for (const double delta_rel : {0.01, 0.02}) {
    for (const SceneName& scene : kScenes) measure_divided(scene, delta_rel, ticks, kernels);
  }
}

/// Interlocking jaws of so many triangles each (0: their own number), with detail left out of both.
struct Jaws {
  static constexpr double kDeltaRel = 0.02;
  static constexpr double kTolerance_N = 3;
  /// The last is a twentieth of delta for each of their 53 contacts.
  static constexpr double kTolerances_N[] = {kTolerance_N, 5, 8};
  static constexpr SceneName kScene = kScenes[0];

  explicit Jaws(std::size_t triangles = 0, double deviation = 0)
      : a(kScene.a, kDeltaRel, bake::ForEngine::regions, triangles, deviation),
        b(kScene.b, kDeltaRel, bake::ForEngine::regions, triangles, deviation) {
    char text[64];
    std::snprintf(text, sizeof text, "jaws_%zu_%zu_%g", 2 * triangles,
                  a.view.region_triangles.size() + b.view.region_triangles.size(), deviation);
    name = text;
  }

  double delta() const {
    return kDeltaRel * std::min(a.view.header->radius_m, b.view.header->radius_m);
  }

  Body a, b;
  std::string name;
};

/// The motion of the jaws with their own number of triangles, and their delta: the same contact
/// however fine others are.
struct SameContact {
  explicit SameContact(const Jaws& own, int ticks)
      : delta(own.delta()), poses(motion(Jaws::kScene, own.a, own.b, delta, ticks)) {}

  Settings settings(double tolerance_N = 0) const {
    return {.engine = EngineKind::regions, .delta_m = delta, .force_tolerance_N = tolerance_N};
  }

  double delta;
  std::vector<Pose> poses;
};

void append(const std::vector<double>& more, std::vector<double>& to) {
  to.insert(to.end(), more.begin(), more.end());
}

/// With tolerances, turn by turn: what else the machine does meanwhile it does to all sizes. A row
/// has the times of all turns; its errors are against the exact force of its own numbers, or, with
/// detail left out, of the coarsest jaws with all detail.
void measure_growth(int ticks, const regions::Kernels& kernels) {
  constexpr int kTurns = 20;
  constexpr std::size_t kSizes[] = {20'000, 0, 160'000, 640'000, 1'000'000};
  const SameContact same(Jaws(), ticks);
  std::deque<Run> exact;
  for (const double deviation : {0.0, 5e-4, 1e-3}) {
    std::deque<Jaws> sizes;
    for (const std::size_t triangles : kSizes) {
      const Jaws& jaws = sizes.emplace_back(triangles, deviation);
      if (deviation > 0) continue;
      Bench bench(jaws.a, jaws.b, same.settings());
      bench.use(kernels);
      exact.push_back(run(bench, same.poses, {}));
    }
    for (const double tolerance_N : Jaws::kTolerances_N) {
      const Plan plan{.tolerance_N = tolerance_N};
      std::deque<Bench> benches;
      for (const Jaws& jaws : sizes) {
        benches.emplace_back(jaws.a, jaws.b, same.settings(tolerance_N)).use(kernels);
      }
      std::vector<Run> found(sizes.size());
      for (int turn = 0; turn < kTurns; ++turn) {
        for (std::size_t i = 0; i < sizes.size(); ++i) {
          const Run before = std::move(found[i]);
          found[i] = run(benches[i], same.poses, plan);
          append(before.us, found[i].us);
          append(before.settled_us, found[i].settled_us);
        }
      }
      for (std::size_t i = 0; i < sizes.size(); ++i) {
        print_row(sizes[i].name.c_str(), Jaws::kDeltaRel, plan, found[i],
                  deviation > 0 ? exact[0] : exact[i]);
      }
    }
  }
}

/// Exact, under a budget and with a tolerance, against those that have all detail.
void measure_detail(int ticks, const regions::Kernels& kernels) {
  const SameContact same(Jaws(), ticks);
  for (const std::size_t triangles : {0u, 160'000u, 640'000u}) {
    std::optional<Run> truth;
    for (const double deviation : {0.0, 5e-4, 1e-3, 2e-3}) {
      const Jaws jaws(triangles, deviation);
      Bench exact_bench(jaws.a, jaws.b, same.settings());
      Bench loose_bench(jaws.a, jaws.b, same.settings(Jaws::kTolerance_N));
      exact_bench.use(kernels);
      loose_bench.use(kernels);
      for (const Plan& plan : {Plan{}, Plan{.from = From::nothing}, Plan{.budget_units = 2500}}) {
        const Run found = run(exact_bench, same.poses, plan);
        if (!truth) truth = found;
        print_row(jaws.name.c_str(), Jaws::kDeltaRel, plan, found, *truth);
      }
      for (const From from : {From::pose_before, From::nothing}) {
        const Plan plan{.from = from, .tolerance_N = Jaws::kTolerance_N};
        print_row(jaws.name.c_str(), Jaws::kDeltaRel, plan, run(loose_bench, same.poses, plan),
                  *truth);
      }
    }
  }
}

/// Those named, or none that run here.
const regions::Kernels* kernels_named(const char* name) {
  const regions::Kernels* tables[regions::kMostKernels] = {};
  const std::uint32_t count = regions::all_kernels(tables);
  const auto found = std::find_if(tables, tables + count, [&](const regions::Kernels* table) {
    return std::strcmp(table->name, name) == 0;
  });
  return found != tables + count ? *found : nullptr;
}

/// By each table of kernels that runs here, narrowest first, turn by turn.
void measure_instructions(int ticks, const regions::Kernels&) {
  constexpr double kDeltaRel = 0.02;
  constexpr int kTurns = 5;
  const Staged jaws(kScenes[0], kDeltaRel, ticks);
  const regions::Kernels* tables[regions::kMostKernels] = {};
  const std::uint32_t count = regions::all_kernels(tables);
  Bench bench(jaws.a, jaws.b, jaws.settings());
  std::optional<Run> exact;
  for (int turn = 0; turn < kTurns; ++turn) {
    for (std::uint32_t i = 0; i < count; ++i) {
      bench.use(*tables[i]);
      for (const From from : {From::pose_before, From::nothing}) {
        const Run found = run(bench, jaws.poses, {.from = from});
        if (!exact) exact = found;
        print_row(tables[i]->name, kDeltaRel, {.from = from}, found, *exact);
      }
    }
  }
}

/// Nothing where it names another scene.
std::optional<Asked> asked(const SceneName& scene, const char* argument) {
  const std::size_t length = std::strlen(scene.name);
  if (std::strncmp(argument, scene.name, length) != 0) return std::nullopt;
  Asked out;
  if (argument[length] == '\0') return out;
  if (argument[length] != ':') return std::nullopt;
  out.delta_rel = std::atof(argument + length + 1);
  const char* second = std::strchr(argument + length + 1, ':');
  if (second != nullptr) out.max_deviation = std::atof(second + 1);
  return out;
}

void measure_asked(const SceneName& scene, const Asked& asked, int ticks) {
  if (asked.delta_rel > 0) {
    measure(scene, asked, ticks);
    return;
  }
  for (const double each : {0.01, 0.02, 0.05}) measure(scene, {.delta_rel = each}, ticks);
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  using namespace palpate::bench;
  const int ticks = argc > 1 ? std::max(20, std::atoi(argv[1])) : 300;
  if (!kHasPeer && argc > 2 && std::strcmp(argv[2], "paced") == 0) {
    std::fprintf(stderr,
                 "bench_regions: paced needs FCL: install libfcl-dev and configure again\n");
    return 2;
  }
  std::printf(
      "scene,delta_rel,mode,budget_us,budget_units,tolerance_N,mean_us,median_us,p99_us,"
      "settled_us,settled_median_us,units,settled_units,near_regions,contacts,without_contact,"
      "denied,force_nrmse,felt_nrmse,settled_felt_nrmse,bound_of_force,exact,bound_ratio,"
      "force_step,fcl_us,of_fcl,felt_least,felt_most\n");
  constexpr struct {
    const char* name;
    void (*measure)(int ticks, const palpate::regions::Kernels& kernels);
  } kOthers[] = {{"paced", measure_paced},
                 {"growth", measure_growth},
                 {"detail", measure_detail},
                 {"divided", measure_divided},
                 {"instructions", measure_instructions}};
  for (const auto& other : kOthers) {
    if (argc < 3 || std::strcmp(argv[2], other.name) != 0) continue;
    const palpate::regions::Kernels* kernels =
        argc > 3 ? kernels_named(argv[3]) : &palpate::regions::best_kernels();
    if (kernels == nullptr) {
      std::fprintf(stderr, "bench_regions: no kernels here are called %s\n", argv[3]);
      return 2;
    }
    other.measure(ticks, *kernels);
    return 0;
  }
  for (const SceneName& scene : kScenes) {
    if (argc <= 2) measure_asked(scene, {}, ticks);
    for (int i = 2; i < argc; ++i) {
      if (const auto what = asked(scene, argv[i])) measure_asked(scene, *what, ticks);
    }
  }
  return 0;
}
