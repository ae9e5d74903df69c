// SPDX-License-Identifier: Apache-2.0
#include "rt_core/convex/distance.hpp"

#include <limits>

#include "rt_core/base/assert.hpp"
#include "rt_core/convex/minkowski.hpp"
#include "rt_core/convex/simplex.hpp"

namespace palpate::convex {
namespace {

/// Upper bound, relative to the sum of the scales, at which the origin counts as lying on a
/// simplex.
constexpr double kOnSimplex = 0.1 * kTouching;

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
  VertexPair start;  ///< the last support point: the next is climbed to from there
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

DifferencePoint cached_point(const HullPair& pair, const Cache& cache, std::uint32_t i) noexcept {
  PALPATE_ASSERT(cache.a[i] < pair.a.count && cache.b[i] < pair.b.count);
  return difference(pair, cache.a[i], cache.b[i]);
}

Simplex load(const HullPair& pair, const Cache& cache) noexcept {
  Simplex s;
  for (std::uint32_t i = 0; i < cache.count && i < 4; ++i) {
    if (!contains(s, cache.a[i], cache.b[i])) append(s, cached_point(pair, cache, i));
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

bool is_enough(const Enough& enough, double lower, double upper) noexcept {
  return lower > enough.above || (upper <= enough.below && lower > 0);
}

/// GJK from the simplex in `search`.
///
/// Its upper bound may not grow by more than rounding. It need not shrink: beside a needle the
/// direction can still turn where the distance no longer shows it. Cycles end at the cap.
/// @param on_simplex  upper bound at which the origin counts as lying on the simplex
void run(const HullPair& pair, double on_simplex, const Enough& enough, Search& search) noexcept {
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
    search.start = farthest(pair, -nearest.axis, search.start).vertices;
    const DifferencePoint w = difference(pair, search.start.a, search.start.b);
    ++search.iterations;
    const double lower = dot(normal, w.point) - slack;
    if (lower > search.lower) {
      search.lower = lower;
      search.normal = normal;
    }
    if (is_enough(enough, search.lower, upper) ||
        upper - search.lower <= kDistanceGap * (unit + upper)) {
      search.end = End::bounded;
      return;
    }
    if (contains(search.simplex, w.a, w.b)) return;
    append(search.simplex, w);
  }
  --search.simplex.count;
}

/// A witness by its vertices.
struct Witness {
  std::uint32_t (&vertices)[3];
  double (&weights)[3];
  std::uint32_t count = 0;

  /// Each vertex once; without a loop, for three is all there can be.
  [[gnu::always_inline]] void add(std::uint32_t vertex, double weight) noexcept {
    if (!(weight > 0)) return;
    if (count > 0 && vertex == vertices[0]) {
      weights[0] += weight;
    } else if (count > 1 && vertex == vertices[1]) {
      weights[1] += weight;
    } else {
      vertices[count] = vertex;
      weights[count] = weight;
      ++count;
    }
  }
};

/// From what carries the nearest point of a - b.
/// @param a, b, points, weights  [kCount]
/// @param on_a                   [kCount] the vertices of a
template <std::uint32_t kCount>
[[gnu::always_inline]] inline void set_witnesses(const std::uint32_t* a, const std::uint32_t* b,
                                                 const Vec3d* points, const Vec3d* on_a,
                                                 const double* weights, Distance& out) noexcept {
  Witness witness_a{out.vertices_a, out.weights_a};
  Witness witness_b{out.vertices_b, out.weights_b};
  Vec3d apart{};
  Vec3d point_a{};
  for (std::uint32_t i = 0; i < kCount; ++i) {
    witness_a.add(a[i], weights[i]);
    witness_b.add(b[i], weights[i]);
    apart += weights[i] * points[i];
    point_a += weights[i] * on_a[i];
  }
  out.count_a = witness_a.count;
  out.count_b = witness_b.count;
  out.point_a = point_a;
  out.point_b = point_a - apart;
  out.distance = norm(apart);
}

/// After the witnesses, whose own rounding can bring them a hair inside the slab.
void set_bounds(double lower, Vec3d normal, Distance& out) noexcept {
  out.normal = normal;
  out.lower_bound = lower > 0 ? (lower < out.distance ? lower : out.distance) : 0;
}

/// One search with a shifted by `by`. True where the origin is enclosed then; its simplex goes to
/// `enclosing`. Else the normal found, if it parts the hulls better than what `search` has.
bool enclosed_when_shifted(const HullPair& pair, Vec3d by, Search& search,
                           Simplex& enclosing) noexcept {
  RelativePose shifted = pair.b_in_a;
  shifted.translation -= by;
  const HullPair moved{pair.a, pair.b, shifted};
  Search again;
  again.start = search.start;
  for (std::uint32_t i = 0; i < search.simplex.count; ++i) {
    append(again.simplex, difference(moved, search.simplex.a[i], search.simplex.b[i]));
  }
  run(moved, 0, {}, again);
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

template <std::uint32_t kCount>
[[gnu::always_inline]] inline void load(const HullPair& pair, const Cache& cache,
                                        Vec3d (&on_a)[kCount], Vec3d (&points)[kCount]) noexcept {
  Vec3d on_b = vertex_of_b(pair, cache.b[0]);
  for (std::uint32_t i = 0; i < kCount; ++i) {
    PALPATE_ASSERT(cache.a[i] < pair.a.count && cache.b[i] < pair.b.count);
    if (i > 0 && cache.b[i] != cache.b[i - 1]) on_b = vertex_of_b(pair, cache.b[i]);
    on_a[i] = vertex_of_a(pair, cache.a[i]);
    points[i] = on_a[i] - on_b;
  }
}

template <std::uint32_t kCount>
[[gnu::always_inline]] inline Nearest nearest_on(const Vec3d (&points)[kCount]) noexcept {
  if constexpr (kCount == 3) {
    return nearest_on_triangle(points, 0, 1, 2);
  } else {
    return nearest_on_simplex(points, kCount, Carry::any);
  }
}

/// The usual answer of a coherent pair, without a Search, whose making would double its cost: all
/// kCount points of the cached simplex still carry the nearest one, and the bounds meet.
/// @param start  where climbs start; where the answer is no, perhaps a better place
template <std::uint32_t kCount>
bool still_nearest(const HullPair& pair, const Cache& cache, const Enough& enough,
                   VertexPair& start, Distance& out) noexcept {
  Vec3d on_a[kCount];
  Vec3d points[kCount];
  load<kCount>(pair, cache, on_a, points);
  const Nearest nearest = nearest_on<kCount>(points);
  const double upper = sqrt_of(nearest.squared);
  if (nearest.count != kCount || upper <= kOnSimplex * extent(pair)) return false;
  const double inverse = 1 / norm(nearest.axis);
  const FarthestPair low = farthest(pair, -nearest.axis, start);
  const double lower = -low.dot * inverse - rounding(pair);
  ++out.iterations;
  const bool bounded =
      is_enough(enough, lower, upper) || upper - lower <= kDistanceGap * (extent(pair) + upper);
  if (!bounded || !(lower > 0)) {
    start = low.vertices;
    return false;
  }
  out.state = State::separated;
  set_witnesses<kCount>(cache.a, cache.b, points, on_a, nearest.weight, out);
  set_bounds(lower, inverse * nearest.axis, out);
  return true;
}

bool still_nearest(const HullPair& pair, const Cache& cache, const Enough& enough,
                   VertexPair& start, Distance& out) noexcept {
  switch (cache.count) {
    case 1:
      return still_nearest<1>(pair, cache, enough, start, out);
    case 2:
      return still_nearest<2>(pair, cache, enough, start, out);
    case 3:
      return still_nearest<3>(pair, cache, enough, start, out);
    default:
      return false;
  }
}

void search_from(const HullPair& pair, VertexPair start, const Enough& enough, Cache& cache,
                 Distance& out) noexcept {
  Search search;
  search.simplex = load(pair, cache);
  search.start = start;
  run(pair, kOnSimplex * extent(pair), enough, search);
  out.state = classify(pair, search);
  out.iterations += search.iterations;
  const Simplex& s = search.simplex;
  store(s, cache);
  if (out.state == State::penetrating) return;
  Vec3d on_a[4];
  for (std::uint32_t i = 0; i < s.count; ++i) on_a[i] = vertex_of_a(pair, s.a[i]);
  switch (s.count) {
    case 1:
      set_witnesses<1>(s.a, s.b, s.points, on_a, search.weights, out);
      break;
    case 2:
      set_witnesses<2>(s.a, s.b, s.points, on_a, search.weights, out);
      break;
    default:
      set_witnesses<3>(s.a, s.b, s.points, on_a, search.weights, out);
  }
  set_bounds(search.lower, search.normal, out);
}

/// Starts a cold cache from the support points of a guessed direction. True where these are already
/// farther apart along it than the caller wants to know.
bool apart_along(const HullPair& pair, Vec3d guess, const Enough& enough, Cache& cache,
                 Distance& out) noexcept {
  const FarthestPair low = farthest(pair, -guess, {});
  cache.count = 1;
  cache.a[0] = low.vertices.a;
  cache.b[0] = low.vertices.b;
  out.iterations = 1;
  const double inverse = 1 / norm(guess);
  const double lower = -low.dot * inverse - rounding(pair);
  if (!(lower > enough.above)) return false;
  constexpr double kWhole[1] = {1};
  Vec3d on_a[1];
  Vec3d points[1];
  load<1>(pair, cache, on_a, points);
  set_witnesses<1>(cache.a, cache.b, points, on_a, kWhole, out);
  set_bounds(lower, inverse * guess, out);
  return true;
}

}  // namespace

Distance distance(const Hull& a, const Hull& b, const RelativePose& b_in_a, const Enough& enough,
                  Cache& cache, Vec3d guess) noexcept {
  PALPATE_ASSERT(a.count > 0 && b.count > 0 && enough.above >= 0);
  const HullPair pair{a, b, b_in_a};
  Distance out;
  if (cache.count == 0 && squared_norm(guess) > 0 && apart_along(pair, guess, enough, cache, out)) {
    return out;
  }
  VertexPair start{cache.a[0], cache.b[0]};
  if (still_nearest(pair, cache, enough, start, out)) return out;
  search_from(pair, start, enough, cache, out);
  return out;
}

}  // namespace palpate::convex
