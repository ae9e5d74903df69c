// SPDX-License-Identifier: GPL-3.0-or-later
// How soon a contact is felt under a budget of work units, of bodies that slide, come near and
// leap.
//
//   bench_onset SLIDES BUDGET[,BUDGET...] [A B DELTA]...
//
// BUDGET: units, or units+reserve (Budget::reserve_units).
// A, B: models of `palpate make-model`, gear_60 and gear_50 (tools/bench/scenes.hpp), or mesh
// files; DELTA: contact tolerance, relative to the smaller radius. Default: jaws, golf balls, a
// screw and a nut, gears of needles. Each pair is brought together from random sides in random
// turns (the same on every machine), and A slides over B and turns, held 0.45 delta apart: begun
// there, after coming near, four times as fast, and each pose as if nothing were known (leaping).
//
// A row (CSV) a pair, motion and budget, and one for all pairs: ticks that touch by an exact query
// (touching); of those, ticks without a contact (missed); those among them whose tick before had
// one (dropped), and whose certificates rule out the contact that is there (denied; must be 0);
// how often misses follow each other until a contact is felt (late), for how many ticks, median,
// 90 % and most; how deep the deepest that is missed is, as a share of delta; and of all ticks, how
// many drew on the reserve (drawn), those of them that do not touch (in vain), and the units that
// they took in all, mean and most of all ticks. Units are exact: the same figures on every machine.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "host_bake/models/noise.hpp"
#include "tools/bench/scenes.hpp"

namespace palpate::bench {
namespace {

struct Motion {
  const char* name;
  double speed;     ///< delta a tick
  int coming_near;  ///< ticks before the slide
  int ticks;        ///< of the slide
  bool cold;        ///< all is forgotten before each tick
};
constexpr Motion kMotions[] = {{"sliding", 0.1, 0, 100, false},
                               {"coming near", 0.1, 60, 100, false},
                               {"fast", 0.4, 0, 100, false},
                               {"leaping", 0.1, 0, 5, true}};
constexpr double kHeld = 0.45;       // of delta; apart: no whole number of steps from touching
constexpr double kMostLifted = 0.3;  // of delta, a tick
constexpr double kReach = 0.3;       // of the smaller radius; distances are known up to there

struct Asked {
  std::string a, b;
  double delta_rel;
};

struct Pair {
  explicit Pair(const Asked& asked)
      : a(mesh_of(asked.a), asked.delta_rel, bake::ForEngine::regions),
        b(mesh_of(asked.b), asked.delta_rel, bake::ForEngine::regions),
        radius_m(std::min(a.view.header->radius_m, b.view.header->radius_m)),
        delta_m(asked.delta_rel * radius_m) {}
  [[nodiscard]] Settings settings(double tolerance_m) const {
    return {.engine = EngineKind::regions, .delta_m = tolerance_m, .exact = true};
  }
  Body a, b;
  double radius_m, delta_m;
};

Quat random_turn(bake::Random& random) {
  while (true) {
    const Quat q{random.signed_unit(), random.signed_unit(), random.signed_unit(),
                 random.signed_unit()};
    const double length2 = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
    if (length2 > 1 || length2 < 1e-3) continue;
    const double s = 1 / std::sqrt(length2);
    return {s * q.w, s * q.x, s * q.y, s * q.z};
  }
}

Vec3d random_way(bake::Random& random) { return rotation(random_turn(random)) * Vec3d{0, 0, 1}; }

/// Poses of a, sliding over b from where it comes down on it.
std::vector<Pose> slide(const Pair& pair, Bench& wide, const Motion& motion, bake::Random& random) {
  const double delta = pair.delta_m;
  const Vec3d out = random_way(random);
  Pose pose{{}, random_turn(random)};
  const Vec3d any = random_way(random);
  const Vec3d across = any - dot(any, out) * out;
  const Vec3d along = (1 / norm(across)) * across;
  const double half_turn = 0.25 * motion.speed * delta / pair.radius_m;
  const Vec3d v = half_turn * random_way(random);
  const double w = std::sqrt(1 - half_turn * half_turn);
  const Quat small{w, v.x, v.y, v.z};

  const Vec3d centre = centre_of(pair.a);
  const double apart = pair.a.view.header->radius_m + pair.b.view.header->radius_m;
  pose.position_m = centre_of(pair.b) + apart * out - rotation(pose.orientation) * centre;
  wide.forget();
  pose = brought_near(wide, pose, out, kHeld * delta, kReach * pair.radius_m);

  std::vector<Pose> poses;
  for (int i = motion.coming_near; i > 0; --i) {
    poses.push_back({pose.position_m + i * motion.speed * delta * out, pose.orientation});
  }
  for (int i = 0; i < motion.ticks; ++i) {
    poses.push_back(pose);
    const Vec3d at = pose.position_m + rotation(pose.orientation) * centre;
    pose.orientation = small * pose.orientation;
    pose.position_m = at + motion.speed * delta * along - rotation(pose.orientation) * centre;
    const double lift = distance_at(wide, pose, kReach * pair.radius_m) - kHeld * delta;
    const double most = kMostLifted * delta;
    pose.position_m -= std::clamp(lift, -most, most) * out;
  }
  return poses;
}

struct Count {
  std::uint64_t touching = 0, missed = 0, dropped = 0, denied = 0;
  std::vector<double> late;  ///< ticks in a row
  double deepest = 0;        ///< of delta
  std::uint64_t ticks = 0, drawn = 0, in_vain = 0, drawn_units = 0, most_units = 0;

  void add(const Count& other) {
    touching += other.touching;
    missed += other.missed;
    dropped += other.dropped;
    denied += other.denied;
    late.insert(late.end(), other.late.begin(), other.late.end());
    deepest = std::max(deepest, other.deepest);
    ticks += other.ticks;
    drawn += other.drawn;
    in_vain += other.in_vain;
    drawn_units += other.drawn_units;
    most_units = std::max(most_units, other.most_units);
  }
};

/// Of each pose how deep the deepest contact is, of delta; 0: none.
std::vector<double> depths_at(Bench& exact, const std::vector<Pose>& poses) {
  std::vector<double> depths;
  exact.forget();
  for (const Pose& pose : poses) {
    const TickResult r = exact.tick_at(pose);
    depths.push_back(r.contacts.empty() ? 0 : 1 - r.min_distance_m / exact.settings().delta_m);
  }
  return depths;
}

Count count(Bench& bench, const std::vector<Pose>& poses, const std::vector<double>& depths,
            bool cold, const Budget& budget) {
  Count out;
  int in_row = 0;
  bool felt_before = false;
  const auto end_row = [&] {
    if (in_row > 0) out.late.push_back(in_row);
    in_row = 0;
  };
  bench.forget();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (cold) {
      bench.forget();
      end_row();
    }
    const TickResult r = bench.tick_at(poses[i], budget);
    const bool touches = depths[i] > 0;
    const bool felt = !r.contacts.empty();
    const bool drew = r.certificate.on_reserve;
    ++out.ticks;
    out.drawn += drew ? 1u : 0u;
    out.in_vain += drew && !touches ? 1u : 0u;
    out.drawn_units += drew ? r.certificate.units_used : 0;
    out.most_units = std::max(out.most_units, r.certificate.units_used);
    out.touching += touches ? 1u : 0u;
    if (touches && !felt) {
      ++in_row;
      ++out.missed;
      out.dropped += felt_before && !cold ? 1u : 0u;
      out.denied += r.certificate.contact == ContactStatus::ruled_out ? 1u : 0u;
      out.deepest = std::max(out.deepest, depths[i]);
    } else {
      end_row();
    }
    felt_before = felt;
  }
  end_row();
  return out;
}

void print(const Asked& asked, const Motion& motion, const Budget& budget, const Count& found) {
  const auto number = [](std::uint64_t n) { return static_cast<unsigned long long>(n); };
  const double drawn_mean = static_cast<double>(found.drawn_units) /
                            static_cast<double>(std::max<std::uint64_t>(found.drawn, 1));
  std::printf(
      "%s,%s,%g,%s,%llu,%llu,%llu,%llu,%llu,%llu,%zu,%.0f,%.0f,%.0f,%.2f,%llu,%llu,%llu,%.0f,%"
      "llu\n",
      asked.a.c_str(), asked.b.c_str(), asked.delta_rel, motion.name, number(budget.units),
      number(budget.reserve_units), number(found.touching), number(found.missed),
      number(found.dropped), number(found.denied), found.late.size(), percentile(found.late, 0.5),
      percentile(found.late, 0.9), percentile(found.late, 1), found.deepest, number(found.ticks),
      number(found.drawn), number(found.in_vain), drawn_mean, number(found.most_units));
  std::fflush(stdout);
}

/// By budget.
std::vector<Count> measure(const Pair& pair, const Motion& motion, int slides,
                           const std::vector<Budget>& budgets) {
  Bench wide(pair.a, pair.b, pair.settings(kReach * pair.radius_m));
  Bench exact(pair.a, pair.b, pair.settings(pair.delta_m));
  Bench bench(pair.a, pair.b, pair.settings(pair.delta_m));
  std::vector<Count> counts(budgets.size());
  bake::Random random(1);
  for (int i = 0; i < slides; ++i) {
    const std::vector<Pose> poses = slide(pair, wide, motion, random);
    const std::vector<double> depths = depths_at(exact, poses);
    for (std::size_t k = 0; k < budgets.size(); ++k) {
      counts[k].add(count(bench, poses, depths, motion.cold, budgets[k]));
    }
  }
  return counts;
}

void measure_all(int slides, const std::vector<Budget>& budgets, const std::vector<Asked>& all) {
  std::puts(
      "a,b,delta_rel,motion,units,reserve,touching,missed,dropped,denied,late,late_median,late_90,"
      "late_most,deepest,ticks,drawn,in_vain,drawn_mean,most_units");
  std::array<std::vector<Count>, std::size(kMotions)> sums;
  sums.fill(std::vector<Count>(budgets.size()));
  for (const Asked& asked : all) {
    const Pair pair(asked);
    for (std::size_t m = 0; m < std::size(kMotions); ++m) {
      const std::vector<Count> counts = measure(pair, kMotions[m], slides, budgets);
      for (std::size_t k = 0; k < budgets.size(); ++k) {
        print(asked, kMotions[m], budgets[k], counts[k]);
        sums[m][k].add(counts[k]);
      }
    }
  }
  for (std::size_t m = 0; m < std::size(kMotions); ++m) {
    for (std::size_t k = 0; k < budgets.size(); ++k) {
      print({"all", "all", 0}, kMotions[m], budgets[k], sums[m][k]);
    }
  }
}

/// "units" or "units+reserve", with commas between; empty where it is neither.
std::vector<Budget> budgets_of(const char* text) {
  std::vector<Budget> out;
  char* end = nullptr;
  for (const char* at = text; *at != '\0'; at = *end == ',' ? end + 1 : end) {
    Budget& budget = out.emplace_back();
    budget.units = std::strtoull(at, &end, 10);
    if (end == at) return {};
    if (*end == '+') {
      at = end + 1;
      budget.reserve_units = std::strtoull(at, &end, 10);
      if (end == at) return {};
    }
    if (*end != ',' && *end != '\0') return {};
  }
  return out;
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  using namespace palpate::bench;
  const int slides = argc > 1 ? std::atoi(argv[1]) : 0;
  const std::vector<palpate::Budget> budgets =
      argc > 2 ? budgets_of(argv[2]) : std::vector<palpate::Budget>{};
  std::vector<Asked> pairs;
  for (int i = 3; i + 2 < argc; i += 3) {
    pairs.push_back({argv[i], argv[i + 1], std::atof(argv[i + 2])});
  }
  const bool good_pairs =
      (argc - 3) % 3 == 0 && std::all_of(pairs.begin(), pairs.end(), [](auto& p) {
        return p.delta_rel > 0 && p.delta_rel < kReach;
      });
  if (slides <= 0 || budgets.empty() || !good_pairs) {
    std::fputs("usage: bench_onset SLIDES BUDGET[,BUDGET...] [A B DELTA]...\n", stderr);
    return 2;
  }
  if (pairs.empty()) {
    pairs = {{"jaw_lower", "jaw_upper", 0.02},
             {"golf_ball", "golf_ball", 0.02},
             {"screw", "nut", 0.02},
             {"gear_60", "gear_50", 0.02},
             {"gear_60", "gear_50", 0.01}};
  }
  try {
    measure_all(slides, budgets, pairs);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_onset: %s\n", error.what());
    return 1;
  }
  return 0;
}
