// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/report.hpp"

#include "rt_core/geometry/smooth_step.hpp"
#include "rt_core/regions/around.hpp"
#include "rt_core/regions/border.hpp"
#include "rt_core/regions/region_triangle.hpp"

namespace palpate::regions {
namespace {

using image::RegionTriangle;
using levels::PairState;

/// Directions of so short a vector are rounding.
constexpr double kTouching = static_cast<double>(kRounding);

class Report {
 public:
  explicit Report(Work& work) noexcept
      : work_(work), memory_(work.memory), active_(work.active()), result_(work.result) {}

  /// Witnesses nearer than delta become contacts, sixteen at a time.
  void run() noexcept {
    std::uint32_t batch[kBatch];
    std::uint32_t pending = 0;
    for (std::uint32_t i = 0; i < active_.size(); ++i) {
      if (work_.is_contact(active_[i])) batch[pending++] = i;
      if (pending == kBatch || (i + 1 == active_.size() && pending > 0)) {
        report_batch(batch, pending);
        pending = 0;
      }
    }
    for (std::uint32_t i = 0; i < memory_.pairs.size(); ++i) {
      if (memory_.containment[i].leaving != 0) report_leaving(i);
    }
    share_by_ways_out(memory_.ways_out.first(ways_out_), memory_.contacts.first(result_.contacts));
  }

 private:
  void report_batch(const std::uint32_t (&batch)[kBatch], std::uint32_t count) noexcept {
    Vec3d origin[kBatch];
    TriangleLanes& lanes = memory_.search->kernel.lanes;
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      const Active& item = active_[batch[i < count ? i : 0]];
      origin[i] = place(work_.pair_of(item), work_.witness_of(item), i, lanes);
    }
    WitnessLanes found;
    memory_.kernels->witnesses(memory_.search->kernel, found);
    for (std::uint32_t i = 0; i < count; ++i) {
      const Active& item = active_[batch[i]];
      const Vec3d apart = lane(found.apart, i);
      const bool crosses = (found.crossing >> i & 1u) != 0;
      // What is nearest may touch while others cross: where edges meet edges exactly.
      if ((crosses || norm(apart) <= kTouching) && report_crossing(item, crosses)) continue;
      report_apart(item, origin[i] + lane(found.on_a, i), apart);
    }
  }

  /// What is deep inside a pair's other body, and the nearest way out of there.
  void report_leaving(std::uint32_t index) noexcept {
    const PairState& pair = memory_.pairs[index];
    const Containment& kept = memory_.containment[index];
    const Contained* of[kBatch];
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < kept.count; ++i) {
      if ((kept.leaving >> i & 1u) != 0) of[count++] = &kept.contained[i];
    }
    Vec3d origin[kBatch];
    TriangleLanes& lanes = memory_.search->kernel.lanes;
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      origin[i] = place(pair, of[i < count ? i : 0]->nearest, i, lanes);
    }
    WitnessLanes found;
    memory_.kernels->witnesses(memory_.search->kernel, found);
    for (std::uint32_t i = 0; i < count; ++i) {
      const Witness& nearest = of[i]->nearest;
      const Vec3d on_a = origin[i] + lane(found.on_a, i);
      const Vec3d apart = lane(found.apart, i);
      const double distance = norm(apart);
      const Vec3d normal = direction_of(pair, nearest, on_a, apart);
      if (kept.is_open(*of[i])) leave_open(pair, distance);
      result_.open_m += pair.deviation * pair.unit_m;  // as of what is not felt (certify.cpp)
      add(index, 1,
          {on_a, on_a - apart, distance > kTouching ? -normal : normal, -distance,
           pair.image_a->region_triangles[nearest.a].piece,
           pair.image_b->region_triangles[nearest.b].piece});
    }
  }

  static Vec3d lane(const float (&rows)[3][kBatch], std::uint32_t i) noexcept {
    return {static_cast<double>(rows[0][i]), static_cast<double>(rows[1][i]),
            static_cast<double>(rows[2][i])};
  }

  /// The witness's triangles in the coordinates of a, relative to a corner that is returned: in
  /// double up to there, so that only the size of the pair is rounded.
  static Vec3d place(const PairState& pair, const Witness& witness, std::uint32_t i,
                     TriangleLanes& lanes) noexcept {
    const RegionTriangle& a = pair.image_a->region_triangles[witness.a];
    const RegionTriangle& b = pair.image_b->region_triangles[witness.b];
    const Vec3d origin = corner(a, 0, pair.scale_a);
    for (std::uint32_t c = 0; c < 3; ++c) {
      put(corner(a, c, pair.scale_a) - origin, c, i, lanes.a);
      const Vec3d of_b = pair.b_in_a.rotation * corner(b, c, pair.scale_b);
      put(of_b + pair.b_in_a.translation - origin, c, i, lanes.b);
    }
    return origin;
  }

  static void put(Vec3d p, std::uint32_t corner, std::uint32_t i,
                  float (&rows)[9][kBatch]) noexcept {
    rows[3 * corner][i] = static_cast<float>(p.x);
    rows[3 * corner + 1][i] = static_cast<float>(p.y);
    rows[3 * corner + 2][i] = static_cast<float>(p.z);
  }

  void report_apart(const Active& item, Vec3d on_a, Vec3d apart) noexcept {
    const PairState& pair = work_.pair_of(item);
    const Witness& witness = work_.witness_of(item);
    const double distance = norm(apart);
    const Vec3d normal = direction_of(pair, witness, on_a, apart);
    const Containment& kept = memory_.containment[item.pair];
    const Contained* const inside = contained_of(kept, work_.frame_of(item), witness);
    const bool flip =
        distance > kTouching && (inside != nullptr || is_behind(item, on_a, on_a - apart, normal));
    if (flip && inside != nullptr && kept.is_open(*inside)) leave_open(pair, distance);
    const Felt felt = flip ? Felt{-normal, 1} : at_border(item, on_a, on_a - apart, normal);
    add(item, {on_a, on_a - apart, felt.normal, flip ? -distance : distance,
               pair.image_a->region_triangles[witness.a].piece,
               pair.image_b->region_triangles[witness.b].piece, felt.share});
  }

  /// From b to a. Touching, the outward normal of b's is right whichever side a comes from.
  static Vec3d direction_of(const PairState& pair, const Witness& witness, Vec3d on_a,
                            Vec3d apart) noexcept {
    const double distance = norm(apart);
    return distance > kTouching ? (1 / distance) * apart : facing_at(pair, witness.b, on_a);
  }

  /// It may be as far from b's surface on the outer side.
  void leave_open(const PairState& pair, double distance) noexcept {
    const double less = distance < pair.delta ? distance : pair.delta;
    result_.open_m += (distance + less) * pair.unit_m;
    result_.maybe_apart = true;
  }

  /// The region is nearest to the inner side of b's surface: it has passed through, beside others
  /// of its body that cross the surface or not. At an edge or a corner one face may mislead; the
  /// mean of their normals, weighted by the angles that they take up there, does not (Baerentzen
  /// and Aanaes 2005). While the interval is open the nearest may be a face before this one, on a
  /// thinner wall or a blade's edge: then the point of a has to see the back of a face, too. Not
  /// told where it is so open that the depth would be a guess; nor from a surface that is open to
  /// its back. Most contacts meet their witness's face from before it and are told at once; so is,
  /// wrongly, what is inside just beyond the tip of a pit as sharp as a needle, or of more than
  /// kMostAround triangles.
  bool is_behind(const Active& item, Vec3d on_a, Vec3d on_b, Vec3d normal) noexcept {
    constexpr double kSquare = 0.5;    // where none is met so squarely, blades meet
    constexpr double kLeast = 1e-3;    // of the mean: less is rounding, on a blade's edge
    constexpr double kMostOpen = 0.1;  // of delta
    const PairState& pair = work_.pair_of(item);
    if (static_cast<double>(item.width) > kMostOpen * pair.delta) return false;
    const ImageView& b = *pair.image_b;
    const RegionTriangle& met = b.region_triangles[work_.witness_of(item).b];
    const Vec3d of_met = pair.b_in_a.rotation * normal_of(met);
    const double squarely = dot(normal, of_met);
    const double least2 = kSquare * kSquare * squared_norm(of_met);
    if (squarely > 0 && squarely * squarely > least2) return false;
    const Vec3d point = in_image_of_b(pair, on_b);
    const Foot foot = foot_at(b, work_.witness_of(item).b, point);
    std::uint32_t from_behind = foot.triangle;
    double least = 1;
    double angles = 0;
    double mean = 0;
    bool closed = is_closed(b, met);
    const auto see = [&](const Sector& sector) {
      closed = closed && is_closed(b, b.region_triangles[sector.triangle]);
      const double beside = dot(normal, facing(pair, sector.normal));
      const double angle = angle_of(sector);
      if (beside < least) {
        least = beside;
        from_behind = sector.triangle;
      }
      angles += angle;
      mean += angle * beside;
    };
    see(sector_at(b, foot.triangle, foot.at));
    // Half of a tip's faces lean to one side: what is before it would seem to be behind the others.
    if (!visit_around(b, foot, point, see)) return false;
    return least < -kSquare && mean < -kLeast * angles && closed &&
           (item.width <= kClosed || sees_inside_of(pair, on_a, on_b, from_behind));
  }

  /// Whether nothing of b lies between a point and the inside of a triangle near another point on
  /// it. Out of a budget of its own: a force must not turn round because the tick's has ended.
  bool sees_inside_of(const PairState& pair, Vec3d point, Vec3d on_b,
                      std::uint32_t triangle) noexcept {
    constexpr std::uint64_t kMostUnits = 64;
    constexpr double kAside = 0.25;  // of the way there
    const ImageView& b = *pair.image_b;
    const RegionTriangle& t = b.region_triangles[triangle];
    const Vec3d from = in_image_of_b(pair, point);
    const Vec3d edge = in_image_of_b(pair, on_b);
    const Vec3d inwards = (1.0 / 3) * (corner(t, 0, 1) + corner(t, 1, 1) + corner(t, 2, 1)) - edge;
    const double aside = kAside * norm(edge - from);
    const double length = norm(inwards);
    const Vec3d to = edge + (aside < length ? aside / length : 1) * inwards;
    Meter meter({.units = kMostUnits}, {});
    Pace pace(meter);
    return in_sight(*memory_.kernels, b, from, to, pace);
  }

  static Vec3d in_image_of_b(const PairState& pair, Vec3d point) noexcept {
    return (1 / pair.scale_b) * to_b(pair, point);
  }

  /// The direction of an outward normal of b; 0 where that is.
  static Vec3d facing(const PairState& pair, Vec3d of_b) noexcept {
    const Vec3d n = pair.b_in_a.rotation * of_b;
    const double length = norm(n);
    return length > 0 ? (1 / length) * n : Vec3d{};
  }

  /// Of a triangle of b at a point; any direction where it and all around it are slivers.
  static Vec3d facing_at(const PairState& pair, std::uint32_t triangle, Vec3d on_b) noexcept {
    const Foot foot = foot_at(*pair.image_b, triangle, in_image_of_b(pair, on_b));
    const Vec3d n = facing(pair, normal_of(pair.image_b->region_triangles[foot.triangle]));
    return squared_norm(n) > 0 ? n : Vec3d{1, 0, 0};
  }

  struct Felt {
    Vec3d normal{};
    double share = 1;
  };

  /// A region that ends beside a nearer place has its nearest point on its own border, in a
  /// direction that leans: it would push along an edge that it lies on. The lean is taken off as
  /// far as the other surface has such normals, and less of the contact is felt the faster the
  /// distance falls where the surface goes on: both if what goes on is known to be nearer.
  Felt at_border(const Active& item, Vec3d on_a, Vec3d on_b, Vec3d normal) noexcept {
    constexpr double kAll = 0.1;  // sines of the lean
    constexpr double kNone = 0.5;
    const PairState& pair = work_.pair_of(item);
    const Witness& witness = work_.witness_of(item);
    const Place a{*pair.image_a, witness.a, (1 / pair.scale_a) * on_a};
    const Fall fall = fall_across(a, normal);
    if (!(fall.rate > 0)) return {normal};
    const Witness& beside = memory_.witnesses[memory_.first_state[item.pair] + fall.region];
    if (!beside.known() || !(beside.distance < witness.distance)) return {normal};
    const double share = smooth_step((kNone - fall.rate) / (kNone - kAll));
    if (!(share > 0)) return {normal, 0};
    const Place b{*pair.image_b, witness.b, in_image_of_b(pair, on_b)};
    return {common_normal(a, b, pair.b_in_a.rotation, normal), share};
  }

  /// @param witness_crosses  found or not, there is a pair that does
  /// @return false where none crosses
  bool report_crossing(const Active& item, bool witness_crosses) noexcept {
    const PairState& pair = work_.pair_of(item);
    const PairFrame& frame = work_.frame_of(item);
    const Witness& witness = work_.witness_of(item);
    CrossingScratch& scratch = *memory_.crossing;
    scratch.list = {};
    const std::uint64_t before = work_.pace.used();
    const bool complete = find_crossings(*memory_.kernels, pair, frame, *memory_.search, work_.pace,
                                         item.region, scratch.list);
    memory_.pursuit.learn_listing(static_cast<double>(work_.pace.used() - before), complete);
    if (scratch.list.count == 0) {
      if (!witness_crosses) return false;
      // Only where the budget or rounding kept the search from finding any: the list shall not
      // depend on how the witness came about.
      note_crossing(pair, witness.a, witness.b, scratch.list);
    }
    if (scratch.list.count == kMaxCrossings) result_.iteration_cap_met = true;
    const Crossing c = overlap(pair, scratch);
    if (!c.exact) result_.iteration_cap_met = true;
    const std::uint32_t contact = result_.contacts;
    add(item, {c.point_a, c.point_b, c.normal, -c.depth, c.piece_a, c.piece_b});
    if (result_.contacts == contact) return true;
    ++result_.crossings;
    note_ways_out(scratch, contact);
    return true;
  }

  void note_ways_out(const CrossingScratch& scratch, std::uint32_t contact) noexcept {
    for (std::uint32_t i = 0; i < scratch.list.count; ++i) {
      const CrossingOfPieces& found = scratch.of_pieces[i];
      if (!(found.way_length > 0)) continue;
      if (ways_out_ == memory_.ways_out.size()) {
        result_.iteration_cap_met = true;
        return;
      }
      memory_.ways_out[ways_out_++] = {found.way_length, found.part, contact, found.overlap.piece_a,
                                       found.overlap.piece_b};
    }
  }

  /// In the coordinates of a, lengths in units.
  struct Found {
    Vec3d point_a;
    Vec3d point_b;
    Vec3d normal;
    double distance;
    std::uint32_t piece_a;
    std::uint32_t piece_b;
    double share = 1;
  };

  void add(const Active& item, const Found& found) noexcept {
    add(item.pair, memory_.crowd.presence(item.state), found);
  }
  /// @param presence  Crowd::presence()
  void add(std::uint32_t index, double presence, const Found& found) noexcept {
    const PairState& pair = memory_.pairs[index];
    if (result_.contacts == memory_.contacts.size()) {
      result_.truncated_by_memory = true;
      return;
    }
    Contact& out = memory_.contacts[result_.contacts++];
    out.point_a_m = pair.centre_a_m + pair.rotation_a * (pair.unit_m * found.point_a);
    out.point_b_m = pair.centre_a_m + pair.rotation_a * (pair.unit_m * found.point_b);
    out.centre_m = 0.5 * (out.point_a_m + out.point_b_m);
    out.normal = pair.rotation_a * found.normal;
    out.distance_m = found.distance * pair.unit_m;
    out.share = found.share * presence;
    out.weight = 0;
    out.pair = index;
    out.piece_a = found.piece_a;
    out.level_a = 0;
    out.piece_b = found.piece_b;
    out.level_b = 0;
    if (out.distance_m < result_.min_distance_m) result_.min_distance_m = out.distance_m;
  }

  Work& work_;
  QueryMemory& memory_;
  std::span<const Active> active_;
  QueryResult& result_;
  std::uint32_t ways_out_ = 0;
};

}  // namespace

void report(Work& work) noexcept { Report(work).run(); }

}  // namespace palpate::regions
