// SPDX-License-Identifier: Apache-2.0
#include "rt_core/convex/distance.hpp"

#include <limits>

#include "rt_core/base/assert.hpp"
#include "rt_core/convex/minkowski.hpp"
#include "rt_core/convex/simplex.hpp"

namespace palpate::convex {
namespace {

/// Distinct points of a - b with their vertices.
struct Simplex {
  std::uint32_t count = 0;
  Vec3d points[4];
  std::uint32_t a[4] = {};
  std::uint32_t b[4] = {};
};

enum class End : std::uint8_t {
  bounded,     ///< the bounds meet, or the lower one is above the caller's limit
  on_simplex,  ///< the origin lies on the simplex, which does not enclose it
  enclosed,    ///< the simplex encloses the origin
  stalled,     ///< the upper bound stopped shrinking, or the cap was met
};

struct Search {
  End end = End::stalled;
  Simplex simplex;  ///< where not enclosed: the points that carry the nearest one
  double weights[3] = {};
  double upper = std::numeric_limits<double>::infinity();
  double lower = -std::numeric_limits<double>::infinity();  ///< negative: overlap along the normal
  Vec3d normal{};                                           ///< unit, of the lower bound
  std::uint32_t iterations = 0;
};

bool contains(const Simplex& s, std::uint32_t a, std::uint32_t b) noexcept {
  for (std::uint32_t i = 0; i < s.count; ++i) {
    if (s.a[i] == a && s.b[i] == b) return true;
  }
  return false;
}

void append(Simplex& s, const DifferencePoint& p) noexcept {
  s.points[s.count] = p.point;
  s.a[s.count] = p.a;
  s.b[s.count] = p.b;
  ++s.count;
}

DifferencePoint first_point(const Simplex& s) noexcept { return {s.points[0], s.a[0], s.b[0]}; }

Simplex load(const HullPair& pair, const Cache& cache) noexcept {
  Simplex s;
  for (std::uint32_t i = 0; i < cache.count && i < 4; ++i) {
    PALPATE_ASSERT(cache.a[i] < pair.a.count && cache.b[i] < pair.b.count);
    if (!contains(s, cache.a[i], cache.b[i])) append(s, difference(pair, cache.a[i], cache.b[i]));
  }
  if (s.count == 0) append(s, difference(pair, 0, 0));
  return s;
}

void store(const Simplex& s, Cache& cache) noexcept {
  cache.count = s.count;
  for (std::uint32_t i = 0; i < s.count; ++i) {
    cache.a[i] = s.a[i];
    cache.b[i] = s.b[i];
  }
}

/// Drops the points that do not carry the nearest one.
void reduce(Search& search, const Nearest& nearest) noexcept {
  if (nearest.count == search.simplex.count) {  // all of them, in order: the usual case when warm
    for (std::uint32_t i = 0; i < nearest.count; ++i) search.weights[i] = nearest.weight[i];
    return;
  }
  const Simplex all = search.simplex;
  search.simplex.count = 0;
  for (std::uint32_t i = 0; i < nearest.count; ++i) {
    const std::uint32_t k = nearest.index[i];
    append(search.simplex, {all.points[k], all.a[k], all.b[k]});
    search.weights[i] = nearest.weight[i];
  }
}

/// GJK from the simplex in `search`.
///
/// Its upper bound may not grow by more than rounding. It need not shrink: beside a needle the
/// direction can still turn where the distance no longer shows it. Cycles end at the cap.
/// @param on_simplex  upper bound at which the origin counts as lying on the simplex
void run(const HullPair& pair, double on_simplex, double stop_above, Search& search) noexcept {
  const double unit = extent(pair);
  const double slack = rounding(pair);
  search.end = End::stalled;
  while (search.iterations < kMaxDistanceIterations) {
    const Carry carry = search.iterations == 0 ? Carry::any : Carry::last;
    const Nearest nearest = nearest_on_simplex(search.simplex.points, search.simplex.count, carry);
    if (nearest.count == 4) {
      search.end = End::enclosed;
      return;
    }
    const double upper = sqrt_of(nearest.squared);
    if (!(upper < search.upper + slack)) {
      if (search.iterations > 0) --search.simplex.count;  // the last point brought nothing
      return;
    }
    if (upper < search.upper) search.upper = upper;
    reduce(search, nearest);
    if (upper <= on_simplex) {
      search.end = End::on_simplex;
      return;
    }
    const Vec3d normal = (1 / norm(nearest.axis)) * nearest.axis;
    const DifferencePoint w = support(pair, -nearest.axis, first_point(search.simplex));
    ++search.iterations;
    const double lower = dot(normal, w.point) - slack;
    if (lower > search.lower) {
      search.lower = lower;
      search.normal = normal;
    }
    if (search.lower > stop_above || upper - search.lower <= kDistanceGap * (unit + upper)) {
      search.end = End::bounded;
      return;
    }
    if (contains(search.simplex, w.a, w.b)) return;
    append(search.simplex, w);
  }
  --search.simplex.count;
}

/// Adds a weighted vertex to a witness, once for each distinct vertex.
void add_weight(std::uint32_t vertex, double weight, std::uint32_t (&vertices)[3],
                double (&weights)[3], std::uint32_t& count) noexcept {
  for (std::uint32_t i = 0; i < count; ++i) {
    if (vertices[i] != vertex) continue;
    weights[i] += weight;
    return;
  }
  vertices[count] = vertex;
  weights[count] = weight;
  ++count;
}

void set_witnesses(const HullPair& pair, const Search& search, Distance& out) noexcept {
  Vec3d apart{};
  for (std::uint32_t i = 0; i < search.simplex.count; ++i) {
    const double weight = search.weights[i];
    if (!(weight > 0)) continue;
    add_weight(search.simplex.a[i], weight, out.vertices_a, out.weights_a, out.count_a);
    add_weight(search.simplex.b[i], weight, out.vertices_b, out.weights_b, out.count_b);
    apart += weight * search.simplex.points[i];
  }
  for (std::uint32_t i = 0; i < out.count_a; ++i) {
    out.point_a += out.weights_a[i] * vertex_of_a(pair, out.vertices_a[i]);
  }
  out.point_b = out.point_a - apart;
  out.distance = norm(apart);
}

/// One search with a shifted by `by`. True where the origin is enclosed then; its simplex goes to
/// `enclosing`. Else the normal found, if it parts the hulls better than what `search` has.
bool enclosed_when_shifted(const HullPair& pair, Vec3d by, Search& search,
                           Simplex& enclosing) noexcept {
  RelativePose shifted = pair.b_in_a;
  shifted.translation -= by;
  const HullPair moved{pair.a, pair.b, shifted};
  Search again;
  for (std::uint32_t i = 0; i < search.simplex.count; ++i) {
    append(again.simplex, difference(moved, search.simplex.a[i], search.simplex.b[i]));
  }
  run(moved, 0, std::numeric_limits<double>::infinity(), again);
  search.iterations += again.iterations;
  if (again.end == End::enclosed) {
    enclosing = again.simplex;
    return true;
  }
  const double lower = again.lower - dot(again.normal, by);  // of the hulls where they are
  if (lower > search.lower) {
    search.lower = lower;
    search.normal = again.normal;
  }
  return false;
}

/// Tells touching from penetrating where the origin lies on a simplex that does not enclose it.
///
/// Hulls that share interior points still do after a small shift of a, one way or the other; where
/// they only touch, one of the two parts them, and its search finds the normal. Should a needle
/// leave that open, a larger shift decides; should that too, they count as penetrating.
State settle(const HullPair& pair, Search& search) noexcept {
  // Askew to the coordinate planes and to every direction with small integer components.
  constexpr Vec3d kAskew{0.3014872, 0.5570963, 0.7737903};
  constexpr double kShifts[2] = {kTouching, 30 * kTouching};
  static_assert(kShifts[1] < kDistanceAccept);
  Simplex enclosing = search.simplex;
  search.lower = -std::numeric_limits<double>::infinity();
  for (const double size : kShifts) {
    const Vec3d shift = (size * extent(pair)) * kAskew;
    const bool one = enclosed_when_shifted(pair, shift, search, enclosing);
    const bool other = enclosed_when_shifted(pair, -shift, search, enclosing);
    if (search.lower > -kDistanceAccept * extent(pair)) return State::touching;
    if (one && other) break;
  }
  search.simplex = enclosing;
  return State::penetrating;
}

State classify(const HullPair& pair, Search& search) noexcept {
  const double accept = kDistanceAccept * (extent(pair) + search.upper);
  switch (search.end) {
    case End::enclosed:
      return State::penetrating;
    case End::on_simplex:
      return settle(pair, search);
    case End::bounded:
      return search.lower > 0 ? State::separated : State::touching;
    case End::stalled:
      break;
  }
  if (search.lower > 0 && search.upper - search.lower <= accept) return State::separated;
  const bool near = search.upper <= accept && accept < std::numeric_limits<double>::infinity();
  return near ? settle(pair, search) : State::gave_up;
}

}  // namespace

Distance distance(const Hull& a, const Hull& b, const RelativePose& b_in_a, double stop_above,
                  Cache& cache) noexcept {
  constexpr double kOnSimplex = 0.1 * kTouching;
  PALPATE_ASSERT(a.count > 0 && b.count > 0 && stop_above >= 0);
  const HullPair pair{a, b, b_in_a};
  Search search;
  search.simplex = load(pair, cache);
  run(pair, kOnSimplex * extent(pair), stop_above, search);
  Distance out;
  out.state = classify(pair, search);
  out.iterations = search.iterations;
  store(search.simplex, cache);
  if (out.state == State::penetrating) return out;
  set_witnesses(pair, search, out);
  out.normal = search.normal;
  out.lower_bound = search.lower > 0 ? search.lower : 0;
  // The witnesses' own rounding can bring them a hair inside the slab.
  if (out.lower_bound > out.distance) out.lower_bound = out.distance;
  return out;
}

void seed(const Hull& a, const Hull& b, const RelativePose& b_in_a, Vec3d direction,
          Cache& cache) noexcept {
  const DifferencePoint w = support({a, b, b_in_a}, -direction, {});
  cache.count = 1;
  cache.a[0] = w.a;
  cache.b[0] = w.b;
}

}  // namespace palpate::convex
