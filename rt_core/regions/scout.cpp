// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/scout.hpp"

#include "rt_core/base/queue.hpp"
#include "rt_core/convex/simplex.hpp"
#include "rt_core/regions/close.hpp"
#include "rt_core/regions/look_into.hpp"
#include "rt_core/regions/named_box.hpp"
#include "rt_core/regions/region_triangle.hpp"

namespace palpate::regions {
namespace {

using image::RegionNode;

/// What is below a box is about as near as its centre, less this share of its radius. With less,
/// places that are not quite near enough are gone through to their ends; with more, all places are
/// gone into alike.
constexpr float kNearerBelow = 0.7f;
/// A box that is so many times as long as it is wide is looked up at so many places along it: those
/// of CAD models' needles may be near at one end alone.
constexpr float kLongBox = 4;
constexpr std::uint32_t kAlongBox = 4;
/// Boxes that wait; what would be more is not looked into.
constexpr std::uint32_t kMostWaiting = 128;
/// A region whose sixteen looks have found nothing near enough is not looked at again before it may
/// have come near, but for no more than so many delta of motion: looks do not see all of it.
constexpr float kLasts = 2;
/// Then it waits to be searched as if it were so many times as far as the nearest that the looks
/// have met: a search finds what there is, and takes as much as the looks at three regions.
constexpr float kSearchLater = 1.5f;
/// Not in ticks of fewer units, which would get to nothing else.
constexpr double kFewestToSearch = 128;
/// Looks tell little about a body so small that a cell of b's grid is as wide as so many delta.
constexpr float kCoarseCell = 8;

struct Place {
  float apart = 0;         ///< of what is nearest below it, about
  std::uint32_t node = 0;  ///< with kLooked where it is a region that has been looked at in vain
};
constexpr std::uint32_t kLooked = 1u << 31;
static_assert(image::kMaxRegionNodes <= kLooked);

struct Nearer {
  bool operator()(const Place& x, const Place& y) const noexcept {
    return x.apart < y.apart || (x.apart == y.apart && x.node < y.node);
  }
};

Vec3d widened(Vec3f v) noexcept {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

/// Of a place from a triangle, in image coordinates.
float distance_from(Vec3f place, const image::RegionTriangle& t) noexcept {
  const Vec3d from = widened(place);
  const Vec3d corners[3] = {corner(t, 0, 1) - from, corner(t, 1, 1) - from, corner(t, 2, 1) - from};
  return static_cast<float>(sqrt_of(convex::nearest_on_triangle(corners, 0, 1, 2).squared));
}

class Scout {
 public:
  Scout(Work& work, std::uint32_t pair) noexcept
      : work_(work),
        pair_(pair),
        frame_(work.memory.frames[pair]),
        pace_(work.pace),
        first_state_(work.memory.first_state[pair]),
        way_(most_way_of(work.memory.pairs[pair])),
        limit_(static_cast<float>(work.memory.pairs[pair].delta)),
        unit_of_b_(sqrt_of(frame_.scale2_b)),
        searches_(work.units_left() > kFewestToSearch),
        waiting_(places_, Nearer{}) {}

  void run() noexcept {
    bool found = look_everywhere();
    if (!found && pace_.go_on()) found = visit(0);
    while (!found && !waiting_.empty() && pace_.go_on()) {
      const std::uint32_t node = waiting_.top().node;
      waiting_.pop();
      found = (node & kLooked) != 0 ? search_in(node & ~kLooked) : visit(node);
    }
    if (!found && work_.swept && is_coarse()) search_all();
  }

 private:
  /// @return whether a contact is found; so do visit(), search_in() and take()
  bool look_everywhere() noexcept {
    Looks looks;
    regions::look_everywhere(frame_, looks);
    const Witness nearest = nearest_of(work_, frame_, looks);
    std::uint32_t behind = 0;
    for (std::uint32_t i = 0; i < looks.count; ++i) behind += is_behind(looks.pair(i)) ? 1u : 0u;
    work_.memory.containment[pair_].suspected = 2 * behind > looks.count;
    return take(nearest);
  }

  /// Whether the middle of a triangle of a is on the inner side of one of b.
  bool is_behind(const Witness& pair) const noexcept {
    const image::RegionTriangle& near = frame_.b->region_triangles[pair.b];
    const Vec3f place = at_place(frame_.a_to_b, centre_of(frame_.a->region_triangles[pair.a]));
    return dot(normal_of(near), widened(place - centre_of(near))) < 0;
  }

  bool visit(std::uint32_t node) noexcept {
    const std::uint32_t region = frame_.a->region_nodes[node].region;
    if (region == image::kNone) {
      push_below(node);
      return false;
    }
    const std::uint32_t state = first_state_ + region;
    if (work_.memory.lasting[state] - way_ >= static_cast<double>(limit_)) return false;
    double& far_until = work_.memory.scouted[state];
    if (way_ < far_until) {
      const Witness& known = work_.memory.witnesses[state];
      search_later(node, known.known() ? known.distance : Work::kClimbReach * limit_);
      return false;
    }
    Looks looks;
    look_over(frame_, region, 0, kMostLooks, looks);
    const Witness nearest = nearest_of(work_, frame_, looks);
    if (take(nearest)) return true;
    search_later(node, nearest.distance);
    const float more = nearest.distance - limit_;
    const float most = kLasts * limit_;
    far_until = way_ + static_cast<double>(more < most ? more : most);
    return false;
  }

  void search_later(std::uint32_t node, float apart) noexcept {
    if (!searches_ || waiting_.items().size() == kMostWaiting) return;
    waiting_.push({kSearchLater * apart, node | kLooked});
  }

  bool search_in(std::uint32_t node) noexcept {
    const std::uint32_t region = frame_.a->region_nodes[node].region;
    const std::uint32_t state = first_state_ + region;
    const std::uint32_t index = work_.active_of(state);
    if (index != image::kNone) {
      search_for_any(work_, work_.active()[index]);
      return work_.is_felt(work_.active()[index]);
    }
    if (!work_.swept) return false;
    const Reach reach{.limit = limit_ + kClosed, .first = true};
    SearchScratch& scratch = *work_.memory.search;
    const Bounds found = search(*work_.memory.kernels, frame_, scratch, pace_, region, {}, reach);
    // Of pairs that it has kept the bound says nothing.
    if (scratch.near.count == 0) {
      work_.memory.lasting[state] = static_cast<double>(found.rest) + way_;
    }
    return found.best.known() && take(found.best);
  }

  [[nodiscard]] bool is_coarse() const noexcept {
    return unit_of_b_ * frame_.b->proximity_grid->cell > kCoarseCell * limit_;
  }

  void search_all() noexcept {
    const Witness found =
        find_any(*work_.memory.kernels, frame_, *work_.memory.search, pace_, limit_);
    if (found.known()) take(found);
  }

  /// What is not near enough by itself may have a neighbour that is: the rest of the tick goes on
  /// from there. After a jump no witness of before is better.
  bool take(const Witness& pair) noexcept {
    const bool found = pair.nearer_than(limit_);
    if (!pair.nearer_than(Work::kClimbReach * limit_)) return false;
    const std::uint32_t state = first_state_ + frame_.a->region_triangles[pair.a].region;
    Witness& known = work_.memory.witnesses[state];
    const std::uint32_t index = work_.active_of(state);
    const bool of_before = work_.swept && index == image::kNone;
    if (!of_before && known.nearer_than(pair.distance)) return false;
    known = pair;
    if (index != image::kNone) {
      work_.active()[index].climbed = false;
      work_.widen(work_.active()[index]);
    }
    return found;
  }

  void push_below(std::uint32_t index) noexcept {
    const RegionNode& node = frame_.a->region_nodes[index];
    std::uint32_t looks = 0;
    for (std::uint32_t i = 0; i < node.children; ++i) {
      const Along along = along_box(node, i);
      float apart = kFarthest;
      for (std::uint32_t k = 0; k < along.places; ++k) {
        const float here = apart_at(along.first + static_cast<float>(k) * along.step);
        apart = here < apart ? here : apart;
      }
      looks += along.places;
      if (apart - along.radius < limit_ && waiting_.items().size() < kMostWaiting) {
        waiting_.push({apart - kNearerBelow * along.radius, node.first + i});
      }
    }
    pace_.charge(looks / kLooksPerUnit);
  }

  /// Places in a's image coordinates, evenly along a box, and what is about each of them.
  struct Along {
    Vec3f first;
    Vec3f step{};
    std::uint32_t places = 1;
    float radius = 0;  ///< in units
  };

  Along along_box(const RegionNode& node, std::uint32_t i) const noexcept {
    std::uint32_t longest = 0;
    for (std::uint32_t k = 1; k < 3; ++k) {
      longest = node.half[k][i] > node.half[longest][i] ? k : longest;
    }
    const float half = node.half[longest][i];
    const float across2 = size2_of(node, i) - half * half;
    Along out{.first = {node.centre[0][i], node.centre[1][i], node.centre[2][i]}};
    if (half * half <= kLongBox * kLongBox * across2) {
      out.radius = sqrt_of(frame_.scale2_a * size2_of(node, i));
      return out;
    }
    constexpr float kPart = 1.0f / kAlongBox;
    const std::uint32_t row = 3 * longest;
    const Vec3f axis = {node.axes[row][i], node.axes[row + 1][i], node.axes[row + 2][i]};
    out.first = out.first - (1 - kPart) * half * axis;
    out.step = 2 * kPart * half * axis;
    out.places = kAlongBox;
    out.radius = sqrt_of(frame_.scale2_a * (kPart * kPart * half * half + across2));
    return out;
  }

  /// From the triangle that is named there.
  float apart_at(Vec3f place_in_a) const noexcept {
    const Vec3f place = at_place(frame_.a_to_b, place_in_a);
    const image::RegionTriangle& near = frame_.b->region_triangles[near_place(frame_, place)];
    const bool wide = is_long(near, frame_.b->proximity_grid->cell);
    return unit_of_b_ * (wide ? distance_from(place, near) : norm(place - centre_of(near)));
  }

  Work& work_;
  std::uint32_t pair_;
  const PairFrame& frame_;
  Pace& pace_;
  std::uint32_t first_state_;
  double way_;
  float limit_;
  float unit_of_b_;
  bool searches_;  // there are units for it
  Place places_[kMostWaiting];
  MinQueue<Place, Nearer> waiting_;
};

}  // namespace

void scout(Work& work, std::uint32_t pair, double most_units) noexcept {
  if (!can_look(work.memory.frames[pair]) || !work.pace.go_on()) return;
  const double left = work.units_left();
  const double units = left < most_units ? left : most_units;
  if (units < static_cast<double>(kUnitsOfLooks)) return;
  work.pace.limit(static_cast<std::uint64_t>(units));
  Scout(work, pair).run();
  work.pace.no_limit();
}

}  // namespace palpate::regions
