// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/containment.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/regions/named_box.hpp"
#include "rt_core/regions/work.hpp"

namespace palpate::regions {
namespace {

using image::RegionNode;
using image::RegionTriangle;

/// Bodies lie within this distance of their centre (image::Region::reach).
constexpr double kMostReach = 1.5;
/// Where the kernel's rounding may see a gap between the ray and a box that it touches.
constexpr float kRoom = 1e-5f;

/// Rows: two directions across a ray, and its own. Odd ones: along the axes, where models have
/// their edges, rays would often meet one.
constexpr Mat3d kRays[] = {{{0.8, -0.6, 0.0}, {0.36, 0.48, -0.8}, {0.48, 0.64, 0.6}},
                           {{0.28, 0.96, 0.0}, {-0.768, 0.224, -0.6}, {-0.576, 0.168, 0.8}},
                           {{-0.6, 0.0, 0.8}, {0.64, -0.6, 0.48}, {0.48, 0.8, 0.36}}};

bool is_one(const ImageView& body) noexcept { return body.header->source_components == 1; }

/// A box without width, from a point on.
/// @param axes  rows: two directions across the way, and its own
Box box_along(Vec3d from, const Mat3d& axes, double length) noexcept {
  const Vec3d middle = from + (0.5 * length) * axes.row2;
  const Vec3d columns[4] = {axes.row0, axes.row1, axes.row2, middle};
  Box box{};
  for (std::uint32_t k = 0; k < 4; ++k) {
    box.x[k] = static_cast<float>(columns[k].x);
    box.y[k] = static_cast<float>(columns[k].y);
    box.z[k] = static_cast<float>(columns[k].z);
  }
  box.half[2] = static_cast<float>(0.5 * length) + kRoom;
  return box;
}

/// Triangles whose boxes a box touches, while pass(triangle) says so.
/// @return false where the pace ended it
template <class Pass>
bool visit_touched(const Kernels& kernels, const ImageView& body, const Box& box,
                   SearchScratch& scratch, Pace& pace, Pass pass) noexcept {
  constexpr Transform kStay = {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}, 1};
  BoxTest test;
  std::uint32_t size = 0;
  scratch.stack[size++].a = 0;
  while (size > 0) {
    if (!pace.go_on()) return false;
    pace.charge(1);
    const RegionNode& node = body.region_nodes[scratch.stack[--size].a];
    std::uint32_t met = kernels.test_boxes(box, kStay, {}, node, 1, kRoom * kRoom, test);
    for (; met != 0; met &= met - 1) {
      const auto child = node.first + static_cast<std::uint32_t>(__builtin_ctz(met));
      if (node.leaf != 0) {
        if (!pass(body.region_triangles[child])) return true;
      } else {
        PALPATE_ASSERT(size < kMaxCandidates);
        scratch.stack[size++].a = child;
      }
    }
  }
  return true;
}

/// How a ray meets a triangle.
struct Meeting {
  bool passed = false;    ///< through its inside, or exactly through its edge
  bool edge = false;      ///< exactly; or it begins in its plane
  bool outwards = false;  ///< else inwards
  double way = 0;         ///< to there; < 0: behind where the ray begins
};

/// Twice the area of the ray and an edge, seen along the ray; exactly the opposite for the triangle
/// on the edge's other side.
double area(Vec3d p, Vec3d q) noexcept { return p.x * q.y - q.x * p.y; }

Meeting meet(const RegionTriangle& t, Vec3d from, const Mat3d& axes) noexcept {
  const Vec3d p[3] = {axes * (vec3d(t.corners) - from), axes * (vec3d(t.corners + 3) - from),
                      axes * (vec3d(t.corners + 6) - from)};
  const double e[3] = {area(p[1], p[2]), area(p[2], p[0]), area(p[0], p[1])};
  const bool left = e[0] > 0 || e[1] > 0 || e[2] > 0;
  const bool right = e[0] < 0 || e[1] < 0 || e[2] < 0;
  if (left && right) return {};
  const double ahead = e[0] * p[0].z + e[1] * p[1].z + e[2] * p[2].z;
  const bool edge = e[0] == 0 || e[1] == 0 || e[2] == 0 || ahead == 0;
  const double whole = e[0] + e[1] + e[2];
  return {true, edge, left, whole != 0 ? ahead / whole : 0};
}

Side side_along(const Kernels& kernels, const ImageView& body, Vec3d from, const Mat3d& axes,
                SearchScratch& scratch, Pace& pace) noexcept {
  int winding = 0;  // triangles passed outwards less those passed inwards
  bool met_edge = false;
  const Box box = box_along(from, axes, norm(from) + kMostReach);
  const bool complete =
      visit_touched(kernels, body, box, scratch, pace, [&](const RegionTriangle& t) {
        const Meeting m = meet(t, from, axes);
        if (m.passed && !m.edge && m.way > 0) winding += m.outwards ? 1 : -1;
        met_edge = m.edge;
        return !met_edge;
      });
  if (!complete || met_edge) return Side::unknown;
  return winding > 0 ? Side::inside : Side::outside;
}

}  // namespace

Side side_of(const Kernels& kernels, const ImageView& body, Vec3d point, SearchScratch& scratch,
             Pace& pace) noexcept {
  if ((body.header->flags & static_cast<std::uint32_t>(image::HeaderFlag::open)) != 0) {
    return Side::outside;
  }
  if (squared_norm(point) > kMostReach * kMostReach) return Side::outside;
  for (const Mat3d& axes : kRays) {
    const Side side = side_along(kernels, body, point, axes, scratch, pace);
    if (side != Side::unknown) return side;
  }
  return Side::unknown;
}

bool in_sight(const Kernels& kernels, const ImageView& body, Vec3d from, Vec3d to,
              SearchScratch& scratch, Pace& pace) noexcept {
  constexpr double kEnd = 1e-3;  // of the way
  const double length = norm(to - from);
  if (!(length > 0)) return true;
  const double end = (1 - kEnd) * length;
  const double beyond = (1 + kEnd) * length;
  const Vec3d way = (1 / length) * (to - from);
  const Vec3d side = across(way);
  const Mat3d axes{side, cross(way, side), way};
  bool met = false;
  const Box box = box_along(from, axes, beyond);
  const bool complete =
      visit_touched(kernels, body, box, scratch, pace, [&](const RegionTriangle& t) {
        const Meeting m = meet(t, from, axes);
        const bool before_end = m.way >= 0 && m.way < end;
        const bool enters = !m.edge && !m.outwards && m.way >= end && m.way < beyond;
        met = m.passed && (before_end || enters);
        return !met;
      });
  return complete && !met;
}

Side contained(const Kernels& kernels, const levels::PairState& pair, SearchScratch& scratch,
               Pace& pace) noexcept {
  const Mat3d& r = pair.b_in_a.rotation;
  const Vec3d t = pair.b_in_a.translation;
  if (is_one(*pair.image_a)) {
    const Vec3d of_a = pair.scale_a * vec3d(pair.image_a->region_triangles[0].corners);
    const Vec3d in_b = (1.0 / pair.scale_b) * (transpose(r) * (of_a - t));
    const Side side = side_of(kernels, *pair.image_b, in_b, scratch, pace);
    if (side != Side::outside) return side;
  }
  if (is_one(*pair.image_b)) {
    const Vec3d of_b = pair.scale_b * vec3d(pair.image_b->region_triangles[0].corners);
    const Vec3d in_a = (1.0 / pair.scale_a) * (r * of_b + t);
    return side_of(kernels, *pair.image_a, in_a, scratch, pace);
  }
  return Side::outside;
}

namespace {

bool crosses(const Work& work, std::uint32_t pair) noexcept {
  for (const Active& item : work.active()) {
    if (item.pair == pair && work.is_crossing(item)) return true;
  }
  return false;
}

bool is_near(const Work& work, std::uint32_t pair) noexcept {
  for (const Active& item : work.active()) {
    if (item.pair == pair && work.is_felt(item)) return true;
  }
  return false;
}

void settle_side(Work& work, std::uint32_t pair) noexcept {
  QueryMemory& memory = work.memory;
  Containment& kept = memory.containment[pair];
  if (!kept.doubtful || crosses(work, pair)) return;
  const Side side = contained(*memory.kernels, memory.pairs[pair], *memory.search, work.pace);
  kept.inside = side == Side::inside;
  kept.doubtful = side == Side::unknown;
  kept.nearest = {};
}

/// Makes a witness known to the report.
void activate(Work& work, std::uint32_t pair, const Witness& witness) noexcept {
  QueryMemory& memory = work.memory;
  const std::uint32_t region = memory.frames[pair].a->region_triangles[witness.a].region;
  const std::uint32_t state = memory.first_state[pair] + region;
  memory.witnesses[state] = witness;
  memory.crowd.absence[state] = 0;
  for (const Active& item : work.active()) {
    if (item.state == state) return;
  }
  const auto rest = static_cast<float>(memory.pairs[pair].delta);
  memory.active[work.count++] = {
      .rest = rest, .way = {}, .state = state, .region = region, .pair = pair};
}

/// The nearest of all pairs of triangles, or of those that the budget does for.
Witness nearest_of_all(Work& work, std::uint32_t pair, Witness best) noexcept {
  const Kernels& kernels = *work.memory.kernels;
  const PairFrame& frame = work.memory.frames[pair];
  SearchScratch& scratch = *work.memory.search;
  if (best.known()) {
    float distances[kBatch];
    scratch.batch_a[0] = best.a;
    scratch.batch_b[0] = best.b;
    measure(kernels, frame, scratch, work.pace, 1, distances);
    best.distance = distances[0];
  }
  for (std::uint32_t i = 0; i < frame.a->regions.size() && work.pace.go_on(); ++i) {
    const Reach reach{best.known() ? best.distance : kFarthest, 0};
    const Bounds found = search(kernels, frame, scratch, work.pace, i, {}, reach);
    if (found.best.known() && found.best.distance < reach.limit) best = found.best;
  }
  return best;
}

void find_way_out(Work& work, std::uint32_t pair) noexcept {
  Containment& kept = work.memory.containment[pair];
  if (crosses(work, pair)) {
    kept.inside = false;
    kept.doubtful = true;
  }
  if (!kept.inside || is_near(work, pair)) return;
  kept.nearest = nearest_of_all(work, pair, kept.nearest);
  if (kept.nearest.known()) activate(work, pair, kept.nearest);
}

}  // namespace

void settle_sides(Work& work) noexcept {
  for (std::uint32_t i = 0; i < work.memory.pairs.size(); ++i) settle_side(work, i);
}

void find_ways_out(Work& work) noexcept {
  for (std::uint32_t i = 0; i < work.memory.pairs.size(); ++i) find_way_out(work, i);
}

}  // namespace palpate::regions
