// SPDX-License-Identifier: Apache-2.0
#include "rt_core/convex/support.hpp"

#include <bit>
#include <limits>

#include "rt_core/base/assert.hpp"

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace palpate::convex {
namespace {

#if defined(__SSE2__)

/// Vertices whose dot products a scan holds at once.
constexpr std::uint32_t kRun = 32;

/// Two dot products, each as dot() computes it.
[[gnu::always_inline]] inline __m128d dots(const __m128d (&d)[3], __m128 x, __m128 y,
                                           __m128 z) noexcept {
  return _mm_add_pd(
      _mm_add_pd(_mm_mul_pd(d[0], _mm_cvtps_pd(x)), _mm_mul_pd(d[1], _mm_cvtps_pd(y))),
      _mm_mul_pd(d[2], _mm_cvtps_pd(z)));
}

/// Dot products of four vertices.
[[gnu::always_inline]] inline void four_dots(const __m128d (&d)[3], const image::Vertex* v,
                                             __m128d (&out)[2]) noexcept {
  __m128 x = _mm_loadu_ps(v[0].position);
  __m128 y = _mm_loadu_ps(v[1].position);
  __m128 z = _mm_loadu_ps(v[2].position);
  __m128 w = _mm_loadu_ps(v[3].position);
  _MM_TRANSPOSE4_PS(x, y, z, w);
  out[0] = dots(d, x, y, z);
  out[1] = dots(d, _mm_movehl_ps(x, x), _mm_movehl_ps(y, y), _mm_movehl_ps(z, z));
}

/// The farthest of `count` vertices, a multiple of 4 up to kRun, from `first` on, where it is
/// farther than `best`. No index is carried along: the bits of the vertices that have the largest
/// product tell the first of them.
[[gnu::always_inline]] inline void scan_run(const Hull& hull, const __m128d (&d)[3],
                                            std::uint32_t first, std::uint32_t fours,
                                            Farthest& best) noexcept {
  __m128d products[kRun / 4][2];
  __m128d largest = _mm_set1_pd(best.dot);
  for (std::uint32_t i = 0; i < fours; ++i) {
    four_dots(d, hull.vertices + first + 4 * i, products[i]);
    largest = _mm_max_pd(largest, _mm_max_pd(products[i][0], products[i][1]));
  }
  largest = _mm_max_pd(largest, _mm_shuffle_pd(largest, largest, 1));
  if (!(_mm_cvtsd_f64(largest) > best.dot)) return;
  std::uint32_t met = 0;
  for (std::uint32_t i = 0; i < fours; ++i) {
    const int low = _mm_movemask_pd(_mm_cmpeq_pd(products[i][0], largest));
    const int high = _mm_movemask_pd(_mm_cmpeq_pd(products[i][1], largest));
    met |= static_cast<std::uint32_t>(low | high << 2) << (4 * i);
  }
  best = {first + static_cast<std::uint32_t>(std::countr_zero(met)), _mm_cvtsd_f64(largest)};
}

#endif

/// The same with and without vector registers, to the last bit.
Farthest scan(const Hull& hull, const Vec3d& direction) noexcept {
  Farthest best{0, -std::numeric_limits<double>::infinity()};
  std::uint32_t i = 0;
#if defined(__SSE2__)
  const __m128d d[3] = {_mm_set1_pd(direction.x), _mm_set1_pd(direction.y),
                        _mm_set1_pd(direction.z)};
  while (i + 4 <= hull.count) {
    const std::uint32_t left = hull.count - i;
    const std::uint32_t fours = (left < kRun ? left : kRun) / 4;
    scan_run(hull, d, i, fours, best);
    i += 4 * fours;
  }
#endif
  for (; i < hull.count; ++i) {
    const double product = dot(direction, position(hull, i));
    if (product > best.dot) best = {i, product};
  }
  return best;
}

/// Does an edge certainly lead on in a direction, more than rounding could make it seem? The
/// direction, too, may be off by a few roundings, after a turn into the hull's axes.
bool rises(const Vec3d& direction, const Vec3d& edge) noexcept {
  constexpr double kRoundings = 16 * 1.2e-16;
  const double x = direction.x * edge.x;
  const double y = direction.y * edge.y;
  const double z = direction.z * edge.z;
  return x + y + z > kRoundings * (__builtin_fabs(x) + __builtin_fabs(y) + __builtin_fabs(z));
}

/// The neighbour of `here` along the edge that rises most, or `here`.
std::uint32_t climb_once(const Hull& hull, const Vec3d& direction, std::uint32_t here) noexcept {
  const Vec3d from = position(hull, here);
  const std::uint32_t* end = hull.neighbours + hull.starts[here + 1];
  double best_rise = 0;
  std::uint32_t best = here;
  for (const std::uint32_t* n = hull.neighbours + hull.starts[here]; n < end; ++n) {
    const double rise = dot(direction, position(hull, *n) - from);
    if (rise > best_rise) {
      best_rise = rise;
      best = *n;
    }
  }
  if (best == here) return here;
  // The corners of a face that faces the direction seem to rise in a circle.
  return rises(direction, position(hull, best) - from) ? best : here;
}

}  // namespace

Farthest farthest(const Hull& hull, double x, double y, double z, std::uint32_t start) noexcept {
  PALPATE_ASSERT(hull.count > 0 && start < hull.count);
  const Vec3d direction{x, y, z};
  if (hull.starts == nullptr) return scan(hull, direction);
  std::uint32_t here = start;
  for (std::uint32_t step = 0; step < kMaxClimbSteps; ++step) {
    const std::uint32_t next = climb_once(hull, direction, here);
    if (next == here) return {here, dot(direction, position(hull, here))};
    here = next;
  }
  return scan(hull, direction);
}

}  // namespace palpate::convex
