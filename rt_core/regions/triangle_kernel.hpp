// SPDX-License-Identifier: Apache-2.0
// Sixteen pairs of triangles at once, without branches. Private to the kernels.
//
// The least of the ways a distance can be met: two edges, a corner above the other face, an edge
// that pierces the other face. Parameters on edges are found from cross products, whose relative
// error grows with 1 / sine and not with its square, so that nearly parallel edges cost no
// accuracy: a wrong parameter then moves the result by the rounding of the coordinates only.
#pragma once

#include <limits>
#include <new>

#include "rt_core/regions/corner_lanes.hpp"
#include "rt_core/regions/kernels.hpp"
#include "rt_core/regions/simd.hpp"

namespace palpate::regions {
namespace {

/// Edges whose squared sine is less are taken as parallel: then a corner is as near.
inline constexpr float kParallel = 1e-12f;
/// Coordinates relative to the pair are stretched by this power of two, so that products of tiny
/// triangles' areas stay in the range of float.
inline constexpr float kStretch = 1024.0f;
inline constexpr float kShrunk2 = 1.0f / (kStretch * kStretch);

struct Triangles {
  Vectors corner[3];
  Vectors edge[3];  ///< from corner i to i + 1
  Floats edge_squared[3];
  Floats edge_inverse[3];  ///< 1 / edge_squared; 0 for a point
  Vectors normal;
  Floats normal_inverse;  ///< 1 / |normal|^2; 0 for a segment
  Vectors inward[3];      ///< in the plane, from edge i to the inside
};

PALPATE_LANES Floats inverse(Floats v) noexcept {
  const Floats positive = v > Floats{} ? v : all(1.0f);
  return v > Floats{} ? all(1.0f) / positive : Floats{};
}

/// A needle's normal is the small difference of large products: their rounding tilts it along the
/// longest edge, and so moves the plane far from the corner that it is laid through.
PALPATE_LANES Vectors upright(Vectors normal, const Triangles& t) noexcept {
  Vectors longest = t.edge[0];
  Floats inverse2 = t.edge_inverse[0];
  Floats most2 = t.edge_squared[0];
  for (int i = 1; i < 3; ++i) {
    const Ints longer = t.edge_squared[i] > most2;
    longest = select(longer, t.edge[i], longest);
    inverse2 = longer ? t.edge_inverse[i] : inverse2;
    most2 = most(t.edge_squared[i], most2);
  }
  return normal - dot(normal, longest) * inverse2 * longest;
}

PALPATE_LANES void complete(Triangles& t) noexcept {
  for (int i = 0; i < 3; ++i) {
    t.edge[i] = t.corner[(i + 1) % 3] - t.corner[i];
    t.edge_squared[i] = dot(t.edge[i], t.edge[i]);
    t.edge_inverse[i] = inverse(t.edge_squared[i]);
  }
  t.normal = upright(cross(t.edge[0], t.edge[1]), t);
  t.normal_inverse = inverse(dot(t.normal, t.normal));
  for (int i = 0; i < 3; ++i) t.inward[i] = cross(t.normal, t.edge[i]);
}

/// The nearest so far; points only where they are asked for.
struct Closest {
  Floats squared;
  Vectors on_a;
  Vectors apart;
};

template <bool kPoints>
PALPATE_LANES void keep(Closest& best, Floats squared, Vectors on_a, Vectors apart) noexcept {
  if constexpr (kPoints) {
    const Ints nearer = squared < best.squared;
    best.on_a = select(nearer, on_a, best.on_a);
    best.apart = select(nearer, apart, best.apart);
  }
  best.squared = least(squared, best.squared);
}

template <bool kPoints>
PALPATE_LANES void edge_and_edge(const Triangles& a, int i, const Triangles& b, int k,
                                 Closest& best) noexcept {
  const Vectors u = a.edge[i];
  const Vectors v = b.edge[k];
  const Vectors r = a.corner[i] - b.corner[k];
  const Vectors across = cross(u, v);
  const Floats across2 = dot(across, across);
  const Ints skew = across2 > kParallel * (a.edge_squared[i] * b.edge_squared[k]);
  const Floats along = dot(cross(v, r), across) / (skew ? across2 : all(1.0f));
  const Floats uv = dot(u, v);
  Floats s = skew ? clamp01(along) : Floats{};
  const Floats t = clamp01((uv * s + dot(v, r)) * b.edge_inverse[k]);
  s = clamp01((uv * t - dot(u, r)) * a.edge_inverse[i]);
  const Vectors apart = r + s * u - t * v;
  keep<kPoints>(best, dot(apart, apart), a.corner[i] + s * u, apart);
}

/// The corners of `corners` against the face of `face`: heights and sides, and the nearest where a
/// corner is above the face's inside.
struct Heights {
  Floats height[3];   ///< of each corner above the face's plane, times |normal|
  Floats side[3][3];  ///< [corner][edge] >= 0: inside of that edge, times |normal| |edge|
};

PALPATE_LANES void find_heights(const Triangles& corners, const Triangles& face,
                                Heights& h) noexcept {
  for (int c = 0; c < 3; ++c) {
    for (int e = 0; e < 3; ++e) {
      h.side[c][e] = dot(face.inward[e], corners.corner[c] - face.corner[e]);
    }
    h.height[c] = dot(face.normal, corners.corner[c] - face.corner[0]);
  }
}

template <bool kPoints, bool kCornersOfA>
PALPATE_LANES void corners_and_face(const Triangles& corners, const Triangles& face,
                                    const Heights& h, Closest& best) noexcept {
  const Floats none = all(std::numeric_limits<float>::max());
  for (int c = 0; c < 3; ++c) {
    const Floats innermost = least(h.side[c][0], least(h.side[c][1], h.side[c][2]));
    const Ints above = (innermost >= Floats{}) & (face.normal_inverse > Floats{});
    const Floats share = h.height[c] * face.normal_inverse;
    const Floats squared = above ? h.height[c] * share : none;
    const Vectors up = share * face.normal;
    if constexpr (kCornersOfA) {
      keep<kPoints>(best, squared, corners.corner[c], up);
    } else {
      keep<kPoints>(best, squared, corners.corner[c] - up, Vectors{-up.x, -up.y, -up.z});
    }
  }
}

/// Lanes where an edge of the triangle whose heights are given passes through the face.
PALPATE_LANES Ints piercing(const Heights& h) noexcept {
  Ints any = {};
  for (int c = 0; c < 3; ++c) {
    const int d = (c + 1) % 3;
    const Ints up = h.height[c] > Floats{};
    const Ints through =
        up ? h.height[d] < Floats{} : (h.height[d] > Floats{}) & (h.height[c] < Floats{});
    Floats innermost = all(std::numeric_limits<float>::max());
    for (int e = 0; e < 3; ++e) {
      const Floats at = h.side[d][e] * h.height[c] - h.side[c][e] * h.height[d];
      innermost = least(up ? at : -at, innermost);
    }
    any |= through & (innermost >= Floats{});
  }
  return any;
}

/// What one pass over the lanes works on. Too large for the stack.
struct Work {
  Triangles a;
  Triangles b;
  Heights of_a;  ///< of a's corners above b
  Heights of_b;
  Closest best;
};
static_assert(sizeof(Work) <= sizeof(KernelScratch::rows));

Work& work_in(KernelScratch& scratch) noexcept { return *::new (scratch.rows) Work; }

// The stages are functions of their own, so that none has more values at hand than registers and a
// small frame can hold.

[[gnu::noinline]] void complete_both(Work& w) noexcept {
  complete(w.a);
  complete(w.b);
}

/// Edges that all fit in registers are held there; where they do not, copies of them are not to be
/// held on the stack.
constexpr int kTogether = kLanes == 16 ? 3 : 1;

template <bool kPoints>
[[gnu::noinline]] void edges(Work& w) noexcept {
  Closest best{all(std::numeric_limits<float>::max()), {}, {}};
  for (int i = 0; i < 3; ++i) {
#pragma GCC unroll kTogether
    for (int k = 0; k < 3; ++k) edge_and_edge<kPoints>(w.a, i, w.b, k, best);
  }
  w.best.squared = best.squared;
  if constexpr (kPoints) w.best = best;
}

template <bool kPoints>
[[gnu::noinline]] void corners(Work& w) noexcept {
  find_heights(w.a, w.b, w.of_a);
  corners_and_face<kPoints, true>(w.a, w.b, w.of_a, w.best);
  find_heights(w.b, w.a, w.of_b);
  corners_and_face<kPoints, false>(w.b, w.a, w.of_b, w.best);
}

/// @return lanes that cross
template <bool kPoints>
PALPATE_LANES Ints closest(Work& w) noexcept {
  complete_both(w);
  edges<kPoints>(w);
  corners<kPoints>(w);
  return piercing(w.of_a) | piercing(w.of_b);
}

PALPATE_LANES Vectors shrunk(Vectors v) noexcept { return all(1.0f / kStretch) * v; }

PALPATE_LANES Vectors corner(const float (&lanes)[9][kBatch], int which, int lane) noexcept {
  return {load(lanes[3 * which] + lane), load(lanes[3 * which + 1] + lane),
          load(lanes[3 * which + 2] + lane)};
}

PALPATE_LANES Vectors mapped(Vectors p, const Transform& map) noexcept {
  const Vectors s = all(map.scale) * p;
  const float* r = map.rotation;
  return {r[0] * s.x + r[1] * s.y + r[2] * s.z + map.translation[0],
          r[3] * s.x + r[4] * s.y + r[5] * s.z + map.translation[1],
          r[6] * s.x + r[7] * s.y + r[8] * s.z + map.translation[2]};
}

/// Corners of as many pairs as there are lanes, stretched, near the pairs.
PALPATE_LANES void bring_together(const image::RegionTriangle* const* a,
                                  const image::RegionTriangle* const* b, const Transform& a_to_b,
                                  Work& out) noexcept {
  const CornerLanes of_a = corners_of(a);
  const CornerLanes of_b = corners_of(b);
  const Vectors origin = of_b.corner[0];
  for (int i = 0; i < 3; ++i) {
    out.a.corner[i] = all(kStretch) * (mapped(of_a.corner[i], a_to_b) - origin);
    out.b.corner[i] = all(kStretch) * (of_b.corner[i] - origin);
  }
}

PALPATE_LANES void store_vectors(Vectors v, float (&out)[3][kBatch], int lane) noexcept {
  store(v.x, out[0] + lane);
  store(v.y, out[1] + lane);
  store(v.z, out[2] + lane);
}

/// Bounds from below, squared, of the distances of the pairs while a goes a course: no point of b
/// is nearer to one of a than along the way that the pair is apart. 0 where there is no such way.
PALPATE_LANES Floats least_along(const Work& w, Vectors course) noexcept {
  const Vectors way = w.best.apart;
  const Floats length2 = dot(way, way);
  Floats least_a = all(std::numeric_limits<float>::max());
  Floats most_b = Floats{};  // the origin is one of its corners
  for (int i = 0; i < 3; ++i) {
    least_a = least(dot(way, w.a.corner[i]), least_a);
    most_b = most(dot(way, w.b.corner[i]), most_b);
  }
  const Floats apart = most(least_a - most_b + least(dot(way, course), Floats{}), Floats{});
  return length2 > Floats{} ? apart * apart / length2 : Floats{};
}

/// What is asked of the pairs beside their distances.
enum class Asked { nothing, ways, courses };

/// @param out_apart  of ways
/// @param out_least  of courses
template <Asked kAsked>
PALPATE_LANES std::uint32_t distances(const image::RegionTriangle* const (&a)[kBatch],
                                      const image::RegionTriangle* const (&b)[kBatch],
                                      const Transform& a_to_b, KernelScratch& scratch,
                                      float (&out_squared)[kBatch], float (*out_apart)[3][kBatch],
                                      Vec3f course, float (*out_least)[kBatch]) noexcept {
  constexpr bool kPoints = kAsked != Asked::nothing;
  Work& work = work_in(scratch);
  std::uint32_t crossing = 0;
  for (int lane = 0; lane < static_cast<int>(kBatch); lane += kLanes) {
    bring_together(a + lane, b + lane, a_to_b, work);
    const Ints cross = closest<kPoints>(work);
    const Floats squared = work.best.squared * kShrunk2;
    store(cross ? Floats{} : squared, out_squared + lane);
    if constexpr (kAsked == Asked::ways) {
      store_vectors(shrunk(work.best.apart), *out_apart, lane);
    }
    if constexpr (kAsked == Asked::courses) {
      const Vectors stretched = {all(kStretch * course.x), all(kStretch * course.y),
                                 all(kStretch * course.z)};
      const Floats least = least_along(work, stretched) * kShrunk2;
      store(cross ? Floats{} : least, *out_least + lane);
    }
    crossing |= bits(cross) << lane;
  }
  return crossing;
}

std::uint32_t triangle_distances(const image::RegionTriangle* const (&a)[kBatch],
                                 const image::RegionTriangle* const (&b)[kBatch],
                                 const Transform& a_to_b, KernelScratch& scratch,
                                 float (&out_squared)[kBatch]) noexcept {
  return distances<Asked::nothing>(a, b, a_to_b, scratch, out_squared, nullptr, {}, nullptr);
}

std::uint32_t triangle_ways(const image::RegionTriangle* const (&a)[kBatch],
                            const image::RegionTriangle* const (&b)[kBatch],
                            const Transform& a_to_b, KernelScratch& scratch,
                            float (&out_squared)[kBatch], float (&out_apart)[3][kBatch]) noexcept {
  return distances<Asked::ways>(a, b, a_to_b, scratch, out_squared, &out_apart, {}, nullptr);
}

std::uint32_t triangle_courses(const image::RegionTriangle* const (&a)[kBatch],
                               const image::RegionTriangle* const (&b)[kBatch],
                               const Transform& a_to_b, Vec3f course, KernelScratch& scratch,
                               float (&out_squared)[kBatch], float (&out_least)[kBatch]) noexcept {
  return distances<Asked::courses>(a, b, a_to_b, scratch, out_squared, nullptr, course, &out_least);
}

void separations(const image::RegionTriangle* const (&a)[kBatch],
                 const image::RegionTriangle* const (&b)[kBatch], const Transform& a_to_b,
                 Vec3f along, float (&out)[kBatch]) noexcept {
  const Vectors n = {all(along.x), all(along.y), all(along.z)};
  for (int lane = 0; lane < static_cast<int>(kBatch); lane += kLanes) {
    // Near the pair: what lies far from its body's origin is no less exact.
    const CornerLanes of_a = corners_of(a + lane);
    const CornerLanes of_b = corners_of(b + lane);
    const Vectors origin = of_b.corner[0];
    Floats least_a = all(std::numeric_limits<float>::max());
    Floats least_b = Floats{};  // of the way back: the origin is one of its corners
    for (int i = 0; i < 3; ++i) {
      least_a = least(dot(n, mapped(of_a.corner[i], a_to_b) - origin), least_a);
      least_b = least(dot(n, origin - of_b.corner[i]), least_b);
    }
    store(least_a + least_b, out + lane);
  }
}

void witnesses(KernelScratch& scratch, WitnessLanes& out) noexcept {
  Work& work = work_in(scratch);
  const TriangleLanes& lanes = scratch.lanes;
  out.crossing = 0;
  for (int lane = 0; lane < static_cast<int>(kBatch); lane += kLanes) {
    for (int i = 0; i < 3; ++i) {
      work.a.corner[i] = all(kStretch) * corner(lanes.a, i, lane);
      work.b.corner[i] = all(kStretch) * corner(lanes.b, i, lane);
    }
    out.crossing |= bits(closest<true>(work)) << lane;
    store_vectors(shrunk(work.best.on_a), out.on_a, lane);
    store_vectors(shrunk(work.best.apart), out.apart, lane);
  }
}

}  // namespace
}  // namespace palpate::regions
