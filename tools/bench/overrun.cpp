// SPDX-License-Identifier: GPL-3.0-or-later
// How far ticks with a budget of time run past their deadline, and how many lose their contacts.
//
//   bench_overrun ENGINE TICKS BUDGET...         ENGINE: levels (exact), simplified (levels,
//                                                s0 = 0.025) or regions; BUDGET: microseconds, or
//                                                with a u behind it work units
//
// Interlocking jaws pressed together (tools/bench/scenes.cpp), contact tolerance 2 % of the
// radius: slow and fast passes along one motion, forwards and backwards, and a leap to another
// place of it every thousand ticks. A row (CSV) a budget: ticks, ticks that the deadline ended, and
// of those how far past it they were over, in microseconds: median, 99.9 %, 99.999 % and largest.
// A twin of the engine is told the same times in the same ticks, so that it does the same work, and
// repeats those that were late by more than 10 us. By the shortest time that each piece of a tick
// took between two looks at the clock, it would have been late by so much without the host's
// interruptions: how many ticks were repeated, and again 99.9 %, 99.999 % and largest of all (own);
// the longest such piece that a deadline passed in, and the longest time from the first look past
// the deadline to the tick's end. Then the mean time of a work unit; ticks that had no contact
// where the engine's exact query has one (lost), those among them whose force is more than a
// twentieth of the largest, how many follow each other at most, and those whose certificate rules
// out the contact that is there (denied; must be 0); ticks that rightly have none but do not rule
// one out (undecided), of those that have none (apart); and the root mean square error of the force
// over the largest (nrmse), all against the exact query. Wants a core of its own: `chrt -f 50
// taskset -c 1 bench_overrun ...`.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <string_view>
#include <thread>
#include <vector>

#include "tools/bench/clock_tape.hpp"
#include "tools/bench/scenes.hpp"

namespace palpate::bench {
namespace {

constexpr SceneName kJaws{"jaws", "jaw_lower", "jaw_upper", true};
constexpr int kPlaces = 2000;
constexpr std::uint64_t kPass = 1000;  // ticks between leaps
constexpr double kLate_us = 10;        // ticks that end later past their deadline are repeated
constexpr int kRepeats = 3;
constexpr double kFelt = 0.05;      // of the largest force
constexpr double kRounding = 1e-6;  // of delta
// A thread that never sleeps has its processor taken away by the kernel, in favour of others that
// wait for it (sched_rt_runtime_us; since Linux 6.12 the fair server, 50 ms of each second). A
// haptic loop sleeps in every period.
constexpr std::uint64_t kAwake_ns = 20'000'000;
constexpr std::chrono::milliseconds kRest{2};

double us_since(std::uint64_t start_ns, std::uint64_t now_ns) {
  return 1e-3 * (static_cast<double>(now_ns) - static_cast<double>(start_ns));
}

/// Which place of the motion a tick takes: passes of different speed and direction.
class Walk {
 public:
  std::size_t next() {
    if (tick_++ % kPass == 0) leap();
    at_ = (at_ + step_) % kPlaces;
    return at_;
  }

 private:
  void leap() {
    seed_ = seed_ * 6364136223846793005u + 1442695040888963407u;
    constexpr std::size_t kSteps[] = {1, kPlaces - 1, 0, 3, kPlaces - 7, 20};
    at_ = (seed_ >> 33) % kPlaces;
    step_ = kSteps[(seed_ >> 20) % std::size(kSteps)];
  }

  std::uint64_t tick_ = 0, seed_ = 1;
  std::size_t at_ = 0, step_ = 1;
};

struct Place {
  Pose pose;
  bool touches = false;  ///< something is nearer than delta
  double distance_m = 0;
  Vec3d force_N;
};

/// What the engine itself finds there without a budget.
std::vector<Place> places_of(const Body& a, const Body& b, Settings settings) {
  settings.exact = true;
  Bench exact(a, b, settings);
  std::vector<Place> places;
  for (const Pose& pose : motion(kJaws, a, b, settings.delta_m, kPlaces)) {
    const TickResult r = exact.tick_at(pose);
    places.push_back({pose, !r.contacts.empty(), r.min_distance_m, r.wrench.force_N});
  }
  return places;
}

double peak_of(const std::vector<Place>& places) {
  double peak = 0;
  for (const Place& place : places) peak = std::max(peak, norm(place.force_N));
  return peak;
}

struct Row {
  std::vector<float> over_us;  ///< of ticks that the deadline ended
  std::vector<float> own_us;   ///< the same without interruptions
  std::uint64_t repeated = 0;
  double piece_us = 0;  ///< longest between two looks at the clock that a deadline passed in
  double rest_us = 0;   ///< longest from the first look past the deadline to the end
  double busy_us = 0, units = 0;
  std::uint64_t lost = 0;
  std::uint64_t lost_felt = 0;    ///< of these, with a force of more than kFelt of the peak
  std::uint64_t lost_in_row = 0;  ///< most that follow each other
  std::uint64_t denied = 0;       ///< of the lost, by their certificates
  std::uint64_t undecided = 0;    ///< of the ticks apart
  std::uint64_t apart = 0;        ///< nothing is nearer than delta
  double square_error = 0;        ///< of the force over the peak, summed
};

/// Of a tick: `50` on the command line is microseconds, `50u` units.
struct Allowed {
  explicit Allowed(const char* text) {
    char* unit = nullptr;
    amount = std::strtod(text, &unit);
    in_units = *unit == 'u';
  }
  [[nodiscard]] Budget from(std::uint64_t now_ns, ClockTape& clock) const {
    if (in_units) return {.units = static_cast<std::uint64_t>(amount)};
    return {.clock_ns = ClockTape::read,
            .clock_context = &clock,
            .deadline_ns = now_ns + static_cast<std::uint64_t>(1e3 * amount)};
  }
  double amount = 0;
  bool in_units = false;
};

/// The work of one tick, by the shortest time that each piece took: from one look at the clock to
/// the next, and from the last to the end.
class Pieces {
 public:
  Pieces(const ClockTape& clock, std::uint64_t end_ns)
      : shortest_ns_(clock.asked_ns().size(), std::numeric_limits<std::uint64_t>::max()) {
    repeat(clock, end_ns);
  }
  void repeat(const ClockTape& clock, std::uint64_t end_ns) {
    const std::vector<std::uint64_t>& asked = clock.asked_ns();
    for (std::size_t i = 0; i < asked.size(); ++i) {
      const std::uint64_t next = i + 1 < asked.size() ? asked[i + 1] : end_ns;
      shortest_ns_[i] = std::min(shortest_ns_[i], next - asked[i]);
    }
  }
  [[nodiscard]] double us(std::size_t from, std::size_t to) const {
    std::uint64_t sum = 0;
    for (std::size_t i = from; i < to; ++i) sum += shortest_ns_[i];
    return 1e-3 * static_cast<double>(sum);
  }
  [[nodiscard]] std::size_t size() const { return shortest_ns_.size(); }

 private:
  std::vector<std::uint64_t> shortest_ns_;
};

/// An engine that does what another has done, as often as is wanted.
class Twin {
 public:
  Twin(const Body& a, const Body& b, const Settings& settings, const Limits& limits)
      : bench_(a, b, settings, limits) {}
  void forget() { bench_.forget(); }
  /// Does a tick that was not late, to know what the other knows.
  void follow(const Pose& pose, const Budget& budget, ClockTape& clock) {
    clock.play();
    bench_.tick_at(pose, budget);
  }
  /// Does a late tick again and again.
  Pieces repeat(const Pose& pose, const Budget& budget, ClockTape& clock, std::uint64_t end_ns) {
    Pieces pieces(clock, end_ns);
    bench_.save(before_);
    for (int i = 0; i < kRepeats; ++i) {
      if (i > 0) bench_.restore(before_);
      follow(pose, budget, clock);
      pieces.repeat(clock, cli::wall_ns());
    }
    return pieces;
  }

 private:
  Bench bench_;
  std::vector<std::byte> before_;
};

/// How late a tick would have been whose pieces each take the shortest time.
void note_own(const Pieces& pieces, const ClockTape& clock, std::uint64_t deadline_ns, Row& row) {
  const std::vector<std::uint64_t>& told = clock.told_ns();
  const auto past = static_cast<std::size_t>(
      std::upper_bound(told.begin(), told.end(), deadline_ns) - told.begin());
  const std::size_t last = past > 0 ? past - 1 : 0;  // look before the deadline
  // Where even the first look was too late, the host was before it.
  const double left = std::max(0.0, us_since(told[last], deadline_ns));
  const double own = pieces.us(last, pieces.size()) - left;
  row.own_us.push_back(static_cast<float>(own));
  row.piece_us = std::max(row.piece_us, pieces.us(last, last + 1));
  row.rest_us = std::max(row.rest_us, pieces.us(last + 1, pieces.size()));
  ++row.repeated;
}

Row run(Bench& bench, Twin& twin, const std::vector<Place>& places, std::uint64_t ticks,
        Allowed allowed) {
  Row row;
  row.over_us.reserve(ticks);
  row.own_us.reserve(ticks);
  ClockTape clock;
  bench.forget();
  twin.forget();
  const double peak = peak_of(places);
  const double delta_m = bench.settings().delta_m;
  Walk walk;
  std::uint64_t in_row = 0;
  std::uint64_t woken = cli::wall_ns();
  for (std::uint64_t i = 0; i < ticks; ++i) {
    if (cli::wall_ns() - woken > kAwake_ns) {
      std::this_thread::sleep_for(kRest);
      woken = cli::wall_ns();
    }
    const Place& place = places[walk.next()];
    clock.record();
    const std::uint64_t start = cli::wall_ns();
    const Budget budget = allowed.from(start, clock);
    const TickResult r = bench.tick_at(place.pose, budget);
    const std::uint64_t end = cli::wall_ns();
    row.busy_us += us_since(start, end);
    row.units += static_cast<double>(r.queries);
    row.square_error += squared_norm((1 / peak) * (r.wrench.force_N - place.force_N));
    const bool lost = place.touches && r.contacts.empty();
    in_row = lost ? in_row + 1 : 0;
    row.lost_in_row = std::max(row.lost_in_row, in_row);
    row.lost += lost ? 1u : 0u;
    row.lost_felt += lost && norm(place.force_N) > kFelt * peak ? 1u : 0u;
    const double least_m = delta_m - r.certificate.error_bound_m;
    const bool ruled_out = r.certificate.contact == ContactStatus::ruled_out ||
                           place.distance_m < least_m - kRounding * delta_m;
    row.denied += lost && ruled_out ? 1u : 0u;
    row.apart += place.touches ? 0u : 1u;
    const bool undecided = r.certificate.contact == ContactStatus::undecided;
    row.undecided += !place.touches && undecided ? 1u : 0u;
    if (allowed.in_units) continue;
    const bool ended = r.certificate.truncated_by_time;
    const double over = us_since(budget.deadline_ns, end);
    if (ended) row.over_us.push_back(static_cast<float>(over));
    if (ended && over > kLate_us) {
      note_own(twin.repeat(place.pose, budget, clock, end), clock, budget.deadline_ns, row);
      continue;
    }
    twin.follow(place.pose, budget, clock);
    if (ended) row.own_us.push_back(static_cast<float>(over));
  }
  return row;
}

double at_share(std::vector<float>& sorted, double share) {
  if (sorted.empty()) return 0;
  return static_cast<double>(
      sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))]);
}

int measure(std::string_view engine, std::uint64_t ticks, int count, char** budgets) {
  const Body a(kJaws.a, 0.02, bake::ForEngine::both);
  const Body b(kJaws.b, 0.02, bake::ForEngine::both);
  const double radius = std::min(a.view.header->radius_m, b.view.header->radius_m);
  Settings settings{.delta_m = 0.02 * radius, .exact = engine != "simplified"};
  if (engine == "regions") settings.engine = EngineKind::regions;
  const std::vector<Place> places = places_of(a, b, settings);
  // Little to copy for the twin, and more than budgets fill: a tick that is short of it ends the
  // run.
  const Limits limits{.nodes = 1u << 14, .contacts = 1u << 12, .clusters = 1u << 14};
  Bench bench(a, b, settings, limits);
  Twin twin(a, b, settings, limits);
  std::puts(
      "engine,budget,ticks,ended_by_deadline,over_p50_us,over_p99.9_us,over_p99.999_us,"
      "over_max_us,repeated,own_p99.9_us,own_p99.999_us,own_max_us,piece_max_us,rest_max_us,"
      "unit_us,lost,lost_felt,lost_in_row,denied,undecided,apart,nrmse");
  for (int i = 0; i < count; ++i) {
    Row row = run(bench, twin, places, ticks, Allowed(budgets[i]));
    std::sort(row.over_us.begin(), row.over_us.end());
    std::sort(row.own_us.begin(), row.own_us.end());
    std::printf(
        "%.*s,%s,%llu,%zu,%.1f,%.1f,%.1f,%.1f,%llu,%.1f,%.1f,%.1f,%.1f,%.1f,%.3f,%llu,%llu,%llu,%"
        "llu,%llu,%llu,%.4f\n",
        static_cast<int>(engine.size()), engine.data(), budgets[i],
        static_cast<unsigned long long>(ticks), row.over_us.size(), at_share(row.over_us, 0.5),
        at_share(row.over_us, 0.999), at_share(row.over_us, 0.99999), at_share(row.over_us, 1),
        static_cast<unsigned long long>(row.repeated), at_share(row.own_us, 0.999),
        at_share(row.own_us, 0.99999), at_share(row.own_us, 1), row.piece_us, row.rest_us,
        row.busy_us / std::max(row.units, 1.0), static_cast<unsigned long long>(row.lost),
        static_cast<unsigned long long>(row.lost_felt),
        static_cast<unsigned long long>(row.lost_in_row),
        static_cast<unsigned long long>(row.denied), static_cast<unsigned long long>(row.undecided),
        static_cast<unsigned long long>(row.apart),
        std::sqrt(row.square_error / static_cast<double>(ticks)));
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  const std::string_view engine = argc > 1 ? argv[1] : "";
  if (argc < 4 || (engine != "levels" && engine != "simplified" && engine != "regions")) {
    std::fputs("usage: bench_overrun levels|simplified|regions TICKS BUDGET[u]...\n", stderr);
    return 2;
  }
  return palpate::bench::measure(engine, std::strtoull(argv[2], nullptr, 10), argc - 3, argv + 3);
}
