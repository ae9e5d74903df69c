// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/containment.hpp"

#include <iterator>

#include "rt_core/base/assert.hpp"
#include "rt_core/regions/component.hpp"
#include "rt_core/regions/look_into.hpp"
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
/// @return false where the pace ended it: then another call goes on from there
template <class Pass>
bool visit_touched(const Kernels& kernels, const ImageView& body, const Box& box, Walk& walk,
                   Pace& pace, Pass pass) noexcept {
  constexpr Transform kStay = {{1, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 0, 0}, 1};
  BoxTest test;
  while (walk.size > 0) {
    if (!pace.go_on()) return false;
    pace.charge(1);
    const RegionNode& node = body.region_nodes[walk.nodes[--walk.size]];
    std::uint32_t met =
        kernels.test_boxes(box, kStay, {}, node, 1, kRoom * kRoom, Order::any, test);
    for (; met != 0; met &= met - 1) {
      const auto child = node.first + static_cast<std::uint32_t>(__builtin_ctz(met));
      if (node.leaf != 0) {
        if (!pass(body.region_triangles[child])) return true;
      } else {
        PALPATE_ASSERT(walk.size < std::size(walk.nodes));
        walk.nodes[walk.size++] = child;
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

/// How a question's ray ends.
enum class End : std::uint8_t { of_pace, at_edge, outside, inside };

End follow_ray(const Kernels& kernels, const ImageView& body, SideQuestion& q,
               Pace& pace) noexcept {
  const Mat3d& axes = kRays[q.ray];
  bool met_edge = false;
  const Box box = box_along(q.point, axes, norm(q.point) + kMostReach);
  const bool complete =
      visit_touched(kernels, body, box, q.walk, pace, [&](const RegionTriangle& t) {
        const Meeting m = meet(t, q.point, axes);
        if (m.passed && !m.edge && m.way > 0) q.winding += m.outwards ? 1 : -1;
        met_edge = m.edge;
        return !met_edge;
      });
  if (met_edge) return End::at_edge;
  if (!complete) return End::of_pace;
  return q.winding > 0 ? End::inside : End::outside;
}

}  // namespace

Side side_of(const Kernels& kernels, const ImageView& body, SideQuestion& question,
             Pace& pace) noexcept {
  if ((body.header->flags & static_cast<std::uint32_t>(image::HeaderFlag::open)) != 0) {
    return Side::outside;
  }
  if (squared_norm(question.point) > kMostReach * kMostReach) return Side::outside;
  while (question.ray < kRayCount) {
    switch (follow_ray(kernels, body, question, pace)) {
      case End::of_pace:
        return Side::unknown;
      case End::outside:
        return Side::outside;
      case End::inside:
        return Side::inside;
      case End::at_edge:
        ++question.ray;
        question.winding = 0;
        question.walk = {};
    }
  }
  return Side::unknown;
}

bool in_sight(const Kernels& kernels, const ImageView& body, Vec3d from, Vec3d to,
              Pace& pace) noexcept {
  constexpr double kEnd = 1e-3;  // of the way
  const double length = norm(to - from);
  if (!(length > 0)) return true;
  const double end = (1 - kEnd) * length;
  const double beyond = (1 + kEnd) * length;
  const Vec3d way = (1 / length) * (to - from);
  const Vec3d side = across(way);
  const Mat3d axes{side, cross(way, side), way};
  bool met = false;
  Walk walk;
  const Box box = box_along(from, axes, beyond);
  const bool complete = visit_touched(kernels, body, box, walk, pace, [&](const RegionTriangle& t) {
    const Meeting m = meet(t, from, axes);
    const bool before_end = m.way >= 0 && m.way < end;
    const bool enters = !m.edge && !m.outwards && m.way >= end && m.way < beyond;
    met = m.passed && (before_end || enters);
    return !met;
  });
  return complete && !met;
}

namespace {

/// In a warm tick that a budget limits, of what it has left: questions can wait, and bodies may
/// touch elsewhere.
constexpr double kMostAsked = 0.5;

bool is_of(const PairFrame& frame, Component component, const Witness& pair) noexcept {
  const ImageView& body = component.of_b ? *frame.b : *frame.a;
  return first_of_component(body, component.of_b ? pair.b : pair.a) == component.first;
}

/// Which components of a pair cross the other body, as far as witnesses tell.
class CrossingComponents {
 public:
  CrossingComponents(const Work& work, std::uint32_t pair) noexcept
      : frame_(work.memory.frames[pair]) {
    for (const Active& item : work.active()) {
      if (item.pair == pair && work.is_crossing(item)) note(work.witness_of(item));
    }
  }

  [[nodiscard]] bool any() const noexcept { return count_ > 0; }

  /// True of all where there are more than there is room for.
  [[nodiscard]] bool of(Component component) const noexcept {
    for (std::uint32_t i = 0; i < count_; ++i) {
      if (is_of(frame_, component, pairs_[i])) return true;
    }
    return full_;
  }

 private:
  static constexpr std::uint32_t kMost = 32;  // pairs of components

  void note(const Witness& pair) noexcept {
    const Component a{false, first_of_component(*frame_.a, pair.a)};
    const Component b{true, first_of_component(*frame_.b, pair.b)};
    for (std::uint32_t i = 0; i < count_; ++i) {
      if (is_of(frame_, a, pairs_[i]) && is_of(frame_, b, pairs_[i])) return;
    }
    full_ = full_ || count_ == kMost;
    if (!full_) pairs_[count_++] = pair;
  }

  const PairFrame& frame_;
  Witness pairs_[kMost];
  std::uint32_t count_ = 0;
  bool full_ = false;
};

/// Calls with the place of each bit that is set.
void for_each(std::uint32_t bits, auto call) noexcept {
  for (; bits != 0; bits &= bits - 1) call(static_cast<std::uint32_t>(__builtin_ctz(bits)));
}

/// Bits of Containment::contained.
std::uint32_t all_of(const Containment& kept) noexcept { return (1u << kept.count) - 1; }

/// Those of which something is near the other's surface, and felt.
std::uint32_t those_near(const Work& work, std::uint32_t pair) noexcept {
  const Containment& kept = work.memory.containment[pair];
  std::uint32_t near = 0;
  if (kept.count == 0) return near;
  for (const Active& item : work.active()) {
    if (item.pair != pair || !work.is_felt(item)) continue;
    const Contained* const one = contained_of(kept, work.frame_of(item), work.witness_of(item));
    if (one != nullptr) near |= 1u << (one - kept.contained);
    if (near == all_of(kept)) break;
  }
  return near;
}

std::uint32_t those_far(const Work& work, std::uint32_t pair) noexcept {
  return all_of(work.memory.containment[pair]) & ~those_near(work, pair);
}

bool feels_any(const Work& work, std::uint32_t pair) noexcept {
  for (const Active& item : work.active()) {
    if (item.pair == pair && work.is_felt(item)) return true;
  }
  return false;
}

/// Whether everything of a pair that is inside is felt near the surface; where nothing is inside,
/// whether anything is felt.
bool is_near(const Work& work, std::uint32_t pair) noexcept {
  const bool inside = work.memory.containment[pair].count > 0;
  return inside ? those_far(work, pair) == 0 : feels_any(work, pair);
}

/// Whether a contact of a pair is certain.
bool touches(const Work& work, std::uint32_t pair) noexcept {
  const Containment& kept = work.memory.containment[pair];
  bool certain = feels_any(work, pair);
  for (std::uint32_t i = 0; i < kept.count; ++i) {
    const Contained& one = kept.contained[i];
    certain |= one.nearest.known() && !kept.is_open(one);
  }
  return certain;
}

/// Whether something of a pair may be inside and is not felt.
bool may_be_inside(const Work& work, std::uint32_t pair) noexcept {
  const Containment& kept = work.memory.containment[pair];
  bool known = !kept.is_open();
  for_each(those_far(work, pair),
           [&](std::uint32_t i) { known &= kept.contained[i].nearest.known(); });
  return !known && !is_near(work, pair);
}

const ImageView& body_of(const levels::PairState& pair, bool of_b) noexcept {
  return of_b ? *pair.image_b : *pair.image_a;
}

void ask(Containment& kept, const levels::PairState& pair, Component component) noexcept {
  const Mat3d& r = pair.b_in_a.rotation;
  const Vec3d t = pair.b_in_a.translation;
  const bool of_b = component.of_b;
  const float* corners = body_of(pair, of_b).region_triangles[component.first].corners;
  const Vec3d vertex = (of_b ? pair.scale_b : pair.scale_a) * vec3d(corners);
  kept.asked = true;
  kept.asking = component;
  kept.question = {.point = of_b ? (1.0 / pair.scale_a) * (r * vertex + t)
                                 : (1.0 / pair.scale_b) * (transpose(r) * (vertex - t)),
                   .walk = {}};
}

/// Of a's first component, or of b's.
void ask_first(Containment& kept, const levels::PairState& pair, bool of_b) noexcept {
  kept.asked = false;
  for (; !kept.asked; of_b = true) {
    if (tells_components(body_of(pair, of_b))) ask(kept, pair, {of_b, 0});
    if (of_b) return;
  }
}

void ask_next(Containment& kept, const levels::PairState& pair, Pace& pace) noexcept {
  const bool of_b = kept.asking.of_b;
  const std::uint32_t next = next_component(body_of(pair, of_b), kept.asking.first);
  if (next != image::kNone) {
    pace.charge(1);
    ask(kept, pair, {of_b, next});
  } else if (!of_b && !kept.all_inside) {
    ask_first(kept, pair, true);
  } else {
    kept.asked = false;
  }
}

void remove(Containment& kept, std::uint32_t i) noexcept {
  kept.contained[i] = kept.contained[--kept.count];
}

/// Of the component that is asked for. One that stays inside keeps its way out.
void note(Containment& kept, bool inside) noexcept {
  std::uint32_t i = 0;
  while (i < kept.count && kept.contained[i].component != kept.asking) ++i;
  kept.all_inside &= inside;
  if (!inside) {
    if (i < kept.count) remove(kept, i);
    return;
  }
  if (i == kMostContained) {
    kept.unanswered = true;
    return;
  }
  if (i == kept.count) kept.contained[kept.count++] = {.component = kept.asking, .nearest = {}};
  kept.contained[i].told = true;
}

/// Goes on with what is asked, until nothing is left to be asked, or the pace ends it. What crosses
/// is not inside.
void answer(Work& work, Containment& kept, std::uint32_t index) noexcept {
  const levels::PairState& pair = work.memory.pairs[index];
  const CrossingComponents crossing(work, index);
  while (kept.asked) {
    const bool in_time = kept.asking.first == 0 || work.pace.go_on();
    if (!in_time) return;
    const ImageView& around = body_of(pair, !kept.asking.of_b);
    const Side side = crossing.of(kept.asking)
                          ? Side::outside
                          : side_of(*work.memory.kernels, around, kept.question, work.pace);
    const bool unknown = side == Side::unknown;
    if (unknown && kept.question.ray < kRayCount) return;
    kept.unanswered |= unknown;
    note(kept, side == Side::inside);
    ask_next(kept, pair, work.pace);
  }
}

/// Asks, or goes on with what has been asked.
void settle_side(Work& work, std::uint32_t index) noexcept {
  const levels::PairState& pair = work.memory.pairs[index];
  Containment& kept = work.memory.containment[index];
  if (!kept.asked) {
    ask_first(kept, pair, false);
    kept.doubtful = kept.unseen = kept.unanswered = kept.crossed = false;
    kept.all_inside = true;
    for (Contained& one : kept.contained) one.told = false;
  }
  if (work.demand.limited && !work.swept && !work.result.on_reserve) work.limit_to(kMostAsked);
  answer(work, kept, index);
  work.pace.no_limit();
  if (kept.asked) return;
  for (std::uint32_t i = kept.count; i-- > 0;) {
    if (!kept.contained[i].told) remove(kept, i);
  }
  kept.doubtful |= kept.unanswered;
}

/// Looks from the component that is inside, where it is one of several: from its first triangles.
void look_from_component(const ImageView& body, std::uint32_t first, Looks& looks) noexcept {
  constexpr std::uint32_t kMostPassed = 64;  // of others that lie between them
  const auto triangles = static_cast<std::uint32_t>(body.region_triangles.size());
  const std::uint32_t left = triangles - first;
  const std::uint32_t end = first + (left < kMostPassed ? left : kMostPassed);
  for (std::uint32_t i = first; i < end && looks.count < kMostLooks; ++i) {
    if (first_of_component(body, i) == first) looks.add(i, looks.count);
  }
}

/// b from a's side.
PairFrame turned(const PairFrame& frame) noexcept {
  return {frame.b, frame.a, frame.b_to_a, frame.a_to_b, frame.scale2_b, frame.scale2_a};
}

Witness turned(const Witness& pair) noexcept { return {pair.b, pair.a, pair.distance}; }

/// About the nearest pair of sixteen looks.
Witness look_out(Work& work, Component component, const PairFrame& frame) noexcept {
  const auto [of_b, first] = component;
  const ImageView& body = of_b ? *frame.b : *frame.a;
  Looks looks;
  if (next_component(body, 0) == image::kNone) {
    look_everywhere(frame, looks);
    return nearest_of(work, frame, looks);
  }
  look_from_component(body, first, looks);
  if (!of_b) return nearest_of(work, frame, looks);
  return turned(nearest_of(work, turned(frame), looks));
}

/// At the present poses, all pairs at once.
/// @param which  bits of Containment::contained; those that have one
void measure_nearest(Work& work, std::uint32_t pair, std::uint32_t which) noexcept {
  Containment& kept = work.memory.containment[pair];
  SearchScratch& scratch = *work.memory.search;
  Witness* of[kMostContained];
  std::uint32_t count = 0;
  for_each(which, [&](std::uint32_t i) {
    Witness& nearest = kept.contained[i].nearest;
    if (!nearest.known()) return;
    scratch.batch_a[count] = nearest.a;
    scratch.batch_b[count] = nearest.b;
    of[count++] = &nearest;
  });
  if (count == 0) return;
  float distances[kBatch];
  measure(*work.memory.kernels, work.memory.frames[pair], scratch, work.pace, count, distances);
  for (std::uint32_t k = 0; k < count; ++k) of[k]->distance = distances[k];
}

/// Of each that is inside and not near a surface a pair that leads out, measured at the present
/// poses: that of the tick before, else about the nearest of sixteen that lie apart, where there
/// are units for it.
void look_for_ways_out(Work& work, std::uint32_t pair) noexcept {
  Containment& kept = work.memory.containment[pair];
  const PairFrame& frame = work.memory.frames[pair];
  const std::uint32_t far = those_far(work, pair);
  measure_nearest(work, pair, far);
  if (!can_look(frame) || !can_look(turned(frame))) return;
  for_each(far, [&](std::uint32_t i) {
    Contained& one = kept.contained[i];
    const bool affordable = work.units_left() >= static_cast<double>(kUnitsOfLooks);
    if (!one.nearest.known() && affordable) one.nearest = look_out(work, one.component, frame);
  });
}

/// What has been asked already goes on in the next tick.
void settle_unseen(Work& work, std::uint32_t pair) noexcept {
  if (work.memory.containment[pair].asked) return;
  settle_side(work, pair);
  look_for_ways_out(work, pair);
}

/// The nearest of all pairs of a component's triangles and the other body's, or of those that the
/// budget does for. Of regions of which another component is nearer, none.
/// @param best  of the present poses
Witness nearest_of_all(Work& work, std::uint32_t pair, Component component, Witness best) noexcept {
  const bool of_b = component.of_b;
  const PairFrame& frame = work.memory.frames[pair];
  const PairFrame from = of_b ? turned(frame) : frame;
  for (std::uint32_t i = 0; i < from.a->regions.size() && work.pace.go_on(); ++i) {
    const Reach reach{best.known() ? best.distance : kFarthest, 0};
    const Bounds found =
        search(*work.memory.kernels, from, *work.memory.search, work.pace, i, {}, reach);
    if (!found.best.known() || !(found.best.distance < reach.limit)) continue;
    const Witness nearer = of_b ? turned(found.best) : found.best;
    if (is_of(frame, component, nearer)) best = nearer;
  }
  return best;
}

void find_ways_out(Work& work, std::uint32_t pair) noexcept {
  Containment& kept = work.memory.containment[pair];
  kept.leaving = 0;
  const CrossingComponents crossing(work, pair);
  if (crossing.any()) {
    for (std::uint32_t i = kept.count; i-- > 0;) {
      if (crossing.of(kept.contained[i].component)) remove(kept, i);
    }
    kept.doubtful |= kept.asked;
    kept.asked = false;
    kept.crossed = true;
  }
  if (is_near(work, pair)) return;
  if (kept.unseen && work.pace.go_on()) settle_unseen(work, pair);
  for_each(those_far(work, pair), [&](std::uint32_t i) {
    Contained& one = kept.contained[i];
    one.nearest = nearest_of_all(work, pair, one.component, one.nearest);
    kept.leaving |= one.nearest.known() ? 1u << i : 0u;
  });
}

}  // namespace

const Contained* contained_of(const Containment& kept, const PairFrame& frame,
                              const Witness& pair) noexcept {
  for (std::uint32_t i = 0; i < kept.count; ++i) {
    if (is_of(frame, kept.contained[i].component, pair)) return &kept.contained[i];
  }
  return nullptr;
}

void settle_sides(Work& work) noexcept {
  for (std::uint32_t i = 0; i < work.memory.pairs.size(); ++i) {
    const Containment& kept = work.memory.containment[i];
    const bool left_unseen = kept.count > 0 && kept.unseen;
    if (kept.doubtful || kept.crossed || kept.asked || left_unseen) settle_side(work, i);
    look_for_ways_out(work, i);
  }
}

void settle_suspected_sides(Work& work) noexcept {
  for (std::uint32_t i = 0; i < work.memory.pairs.size(); ++i) {
    const Containment& kept = work.memory.containment[i];
    if (kept.unseen && kept.suspected && !is_near(work, i)) settle_unseen(work, i);
  }
}

void settle_open_sides(Work& work) noexcept {
  constexpr int kQuestions = 2;  // what was asked in a tick before, and of the present poses
  for (std::uint32_t i = 0; i < work.memory.pairs.size(); ++i) {
    const Containment& kept = work.memory.containment[i];
    if (!kept.is_open() || touches(work, i)) continue;
    for (int k = 0; k < kQuestions && kept.is_open(); ++k) settle_side(work, i);
    look_for_ways_out(work, i);
  }
}

void find_ways_out(Work& work) noexcept {
  for (std::uint32_t i = 0; i < work.memory.pairs.size(); ++i) find_ways_out(work, i);
}

bool may_be_inside(const Work& work) noexcept {
  for (std::uint32_t i = 0; i < work.memory.pairs.size(); ++i) {
    if (may_be_inside(work, i)) return true;
  }
  return false;
}

bool may_touch_inside(const Work& work) noexcept {
  for (std::uint32_t i = 0; i < work.memory.pairs.size(); ++i) {
    if (may_be_inside(work, i) && !touches(work, i)) return true;
  }
  return false;
}

}  // namespace palpate::regions
