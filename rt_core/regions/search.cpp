// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/search.hpp"

#include <cstddef>
#include <limits>

#include "rt_core/base/assert.hpp"
#include "rt_core/regions/region_state.hpp"

namespace palpate::regions {
namespace {

using image::RegionNode;
using image::RegionTriangle;

constexpr float kFar = std::numeric_limits<float>::max();

/// The pairs of a batch.
struct Batch {
  Batch(const PairFrame& frame, const std::uint32_t (&of_a)[kBatch],
        const std::uint32_t (&of_b)[kBatch]) noexcept {
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      a[i] = &frame.a->region_triangles[of_a[i]];
      b[i] = &frame.b->region_triangles[of_b[i]];
    }
  }
  const RegionTriangle* a[kBatch];
  const RegionTriangle* b[kBatch];
};

/// A course of a in the coordinates of b's image, as that of b in those of a's.
Vec3f course_of_b(const PairFrame& frame, Vec3f course) noexcept {
  const Transform& map = frame.b_to_a;
  const float* r = map.rotation;
  return -map.scale * Vec3f{r[0] * course.x + r[1] * course.y + r[2] * course.z,
                            r[3] * course.x + r[4] * course.y + r[5] * course.z,
                            r[6] * course.x + r[7] * course.y + r[8] * course.z};
}

/// Distances of sixteen pairs at once, in units.
std::uint32_t evaluate(const Kernels& kernels, const PairFrame& frame, SearchScratch& scratch,
                       float (&out_squared)[kBatch]) noexcept {
  const Batch pairs(frame, scratch.batch_a, scratch.batch_b);
  const std::uint32_t crossing =
      kernels.triangle_distances(pairs.a, pairs.b, frame.a_to_b, scratch.kernel, out_squared);
  for (float& squared : out_squared) squared *= frame.scale2_b;
  return crossing;
}

/// The lanes that are left repeat the first.
void fill_up(SearchScratch& scratch, std::uint32_t count) noexcept {
  PALPATE_ASSERT(count > 0 && count <= kBatch);
  for (std::uint32_t i = count; i < kBatch; ++i) {
    scratch.batch_a[i] = scratch.batch_a[0];
    scratch.batch_b[i] = scratch.batch_b[0];
  }
}

class Search {
 public:
  Search(const Kernels& kernels, const PairFrame& frame, SearchScratch& scratch, Pace& pace,
         const Witness& witness, const Reach& reach) noexcept
      : kernels_(kernels),
        frame_(frame),
        trees_{{*frame.a, frame.b_to_a, course_of_b(frame, reach.course), frame.scale2_a},
               {*frame.b, frame.a_to_b, reach.course, frame.scale2_b}},
        scratch_(scratch),
        pace_(pace),
        reach_(reach),
        moves_(squared_norm(reach.course) > 0) {
    const float scale = frame.a_to_b.scale;
    volume_a_ = scale * scale * scale;
    out_.best = witness;
    best_squared_ = witness.known() ? witness.distance * witness.distance : kFar;
    scratch_.near.count = 0;
    scratch_.near.room = reach.room;
    lower_threshold();
  }

  /// @param top  the child of a node of a below which everything is searched
  Bounds run(std::uint32_t top) noexcept {
    visit_root(top);
    return finish();
  }

 private:
  /// One of the two, and how boxes of the other get into its coordinates.
  struct Tree {
    const ImageView& image;
    const Transform& to_here;
    Vec3f course;  ///< of those boxes
    float scale2;  ///< squared units of its squared coordinates
  };

  Bounds finish() noexcept {
    while (size_ > 0 || pending_ > 0) {
      if (crowded_) return given_up();
      if (!pace_.go_on()) return interrupted();
      if (size_ == 0) {
        flush();
        continue;
      }
      const Candidate top = scratch_.stack[--size_];
      if (top.squared < threshold_squared_) {
        descend(top);
      } else {
        note_passed_over(top.squared);
      }
    }
    out_.rest = proved(passed_over());
    return out_;
  }

  /// The root of b against a region: the one pair whose second box is not stored.
  void visit_root(std::uint32_t a) noexcept {
    open(false, 0, a, frame_.a->region_nodes[node_of(a)]);
  }

  /// Into the box with the larger volume: of two as long, the thinner one bounds what it holds
  /// better already, and its children bound it little better.
  void descend(const Candidate& pair) noexcept {
    const RegionNode& over_a = frame_.a->region_nodes[node_of(pair.a)];
    const RegionNode& over_b = frame_.b->region_nodes[node_of(pair.b)];
    const std::uint32_t slot_a = slot_of(pair.a);
    const std::uint32_t slot_b = slot_of(pair.b);
    const bool split_a =
        over_a.leaf == 0 &&
        (over_b.leaf != 0 || volume_a_ * volume_of(over_a, slot_a) > volume_of(over_b, slot_b));
    if (split_a) {
      open(true, over_a.first + slot_a, pair.b, over_b);
    } else {
      open(false, over_b.first + slot_b, pair.a, over_a);
    }
  }

  /// A node's children against one box of the other tree: those that may hold something nearer are
  /// kept, the nearest on top. Whole sorted is half the work until the nearest pair is met, against
  /// the nearest on top and the others in any order.
  /// @param other  the box, of node `over_other`
  void open(bool of_a, std::uint32_t node, std::uint32_t other,
            const RegionNode& over_other) noexcept {
    const Tree& tree = trees_[of_a ? 0 : 1];
    const RegionNode& parent = tree.image.region_nodes[node];
    const bool of_triangles = parent.leaf != 0 && over_other.leaf != 0;
    pace_.charge(1);
    std::uint32_t near = kernels_.test_boxes(box_of(over_other, slot_of(other)), tree.to_here,
                                             tree.course, parent, tree.scale2, threshold_squared_,
                                             of_triangles ? Order::any : Order::by_distance, test_);
    if (of_triangles) {
      const std::uint32_t single = over_other.first + slot_of(other);
      for (; near != 0; near &= near - 1) {
        const auto slot = static_cast<std::uint32_t>(__builtin_ctz(near));
        const std::uint32_t child = parent.first + slot;
        add_pair(of_a ? child : single, of_a ? single : child, test_.squared[slot]);
      }
      return;
    }
    Candidate* const kept = scratch_.stack + size_;
    for (; near != 0; near &= near - 1) {
      PALPATE_ASSERT(size_ < kMaxCandidates);
      const auto slot = static_cast<std::uint32_t>(__builtin_ctz(near));
      const std::uint32_t child = child_name(node, slot);
      kept[test_.place[slot]] = {of_a ? child : other, of_a ? other : child, test_.squared[slot]};
      ++size_;
    }
  }

  /// Only while nothing within the limit is known does it matter how far what is passed over is:
  /// a region that is far rests for as long.
  void note_passed_over(float squared) noexcept {
    passed_squared_ = squared < passed_squared_ ? squared : passed_squared_;
  }

  void add_pair(std::uint32_t a, std::uint32_t b, float squared) noexcept {
    if (pending_ == kBatch) flush();
    __builtin_prefetch(&frame_.a->region_triangles[a]);
    __builtin_prefetch(&frame_.b->region_triangles[b]);
    scratch_.batch_a[pending_] = a;
    scratch_.batch_b[pending_] = b;
    scratch_.batch_squared[pending_] = squared;
    ++pending_;
  }

  void flush() noexcept {
    fill_up(scratch_, pending_);
    pace_.charge(kBatchUnits);
    float squared[kBatch];
    if (moves_) {
      float least[kBatch];
      evaluate_along(squared, least);
      keep_nearest(squared, least);
    } else {
      evaluate(kernels_, frame_, scratch_, squared);
      keep_nearest(squared, squared);
    }
    pending_ = 0;
  }

  /// The same as evaluate(), and along the course at least.
  void evaluate_along(float (&out_squared)[kBatch], float (&out_least)[kBatch]) noexcept {
    const Batch pairs(frame_, scratch_.batch_a, scratch_.batch_b);
    kernels_.triangle_courses(pairs.a, pairs.b, frame_.a_to_b, reach_.course, scratch_.kernel,
                              out_squared, out_least);
    for (float& squared : out_squared) squared *= frame_.scale2_b;
    for (float& squared : out_least) squared *= frame_.scale2_b;
  }

  void keep_nearest(const float (&squared)[kBatch], const float (&least)[kBatch]) noexcept {
    for (std::uint32_t i = 0; i < pending_; ++i) {
      if (squared[i] < best_squared_) {
        best_squared_ = squared[i];
        out_.best = {scratch_.batch_a[i], scratch_.batch_b[i], sqrt_of(squared[i])};
        lower_threshold();
      }
    }
    for (std::uint32_t i = 0; i < pending_; ++i) {
      if (least[i] < threshold_squared_) {
        keep({scratch_.batch_a[i], scratch_.batch_b[i], sqrt_of(least[i])});
      } else {
        note_passed_over(least[i]);
      }
    }
  }

  void keep(const Witness& pair) noexcept {
    const float dropped = scratch_.near.add(pair, most_);
    if (dropped < most_) {
      most_ = dropped;
      crowded_ = moves_ && most_ < upper() - reach_.widest;
      lower_threshold();
    }
  }

  float upper() const noexcept {
    return out_.best.nearer_than(reach_.limit) ? out_.best.distance : reach_.limit;
  }

  void lower_threshold() noexcept {
    const float wanted = upper() + reach_.margin;
    threshold_ = wanted < most_ ? wanted : most_;
    threshold_ = threshold_ > 0 ? threshold_ : 0;
    threshold_squared_ = threshold_ * threshold_;
  }

  /// Everything that was passed over is at least this far.
  float passed_over() const noexcept {
    const float now = passed_over_now();
    return now < most_ ? now : most_;
  }
  float passed_over_now() const noexcept {
    if (best_squared_ < threshold_squared_) return threshold_;
    float passed2 = passed_squared_;
    for (const float least : test_.passed) passed2 = least < passed2 ? least : passed2;
    const float passed = sqrt_of(passed2);
    return passed < out_.best.distance || !out_.best.known() ? passed : out_.best.distance;
  }

  static float proved(float bound) noexcept { return bound > kRounding ? bound - kRounding : 0; }

  Bounds interrupted() noexcept {
    float least = threshold_squared_;
    for (std::uint32_t i = 0; i < size_; ++i) {
      least = scratch_.stack[i].squared < least ? scratch_.stack[i].squared : least;
    }
    for (std::uint32_t i = 0; i < pending_; ++i) {
      least = scratch_.batch_squared[i] < least ? scratch_.batch_squared[i] : least;
    }
    out_.rest = proved(sqrt_of(least));
    out_.complete = false;
    return out_;
  }

  /// Of the present place alone more can be proved.
  Bounds given_up() noexcept {
    out_.complete = false;
    out_.crowded = true;
    return out_;
  }

  const Kernels& kernels_;
  const PairFrame& frame_;
  Tree trees_[2];
  SearchScratch& scratch_;
  Pace& pace_;
  Reach reach_;
  bool moves_;              // along a course
  float volume_a_ = 1;      // a's unit of volume, in b's
  float most_ = kFarthest;  // pairs from here on have been dropped
  bool crowded_ = false;    // and so the interval stays too wide
  Bounds out_;
  float best_squared_ = kFar;
  float threshold_ = 0;
  float threshold_squared_ = 0;
  float passed_squared_ = kFar;
  BoxTest test_;  // of the children looked at last
  std::uint32_t size_ = 0;
  std::uint32_t pending_ = 0;
};

}  // namespace

void measure(const Kernels& kernels, const PairFrame& frame, SearchScratch& scratch, Pace& pace,
             std::uint32_t count, float (&out_distances)[kBatch]) noexcept {
  fill_up(scratch, count);
  pace.charge(kBatchUnits);
  evaluate(kernels, frame, scratch, out_distances);
  for (float& d : out_distances) d = sqrt_of(d);
}

void measure_ways(const Kernels& kernels, const PairFrame& frame, SearchScratch& scratch,
                  Pace& pace, std::uint32_t count, float (&out_distances)[kBatch],
                  WayLanes& out_ways) noexcept {
  fill_up(scratch, count);
  pace.charge(kBatchUnits);
  const Batch pairs(frame, scratch.batch_a, scratch.batch_b);
  kernels.triangle_ways(pairs.a, pairs.b, frame.a_to_b, scratch.kernel, out_distances,
                        out_ways.apart);
  for (float& d : out_distances) d = sqrt_of(frame.scale2_b * d);
}

Way way_of(const WayLanes& ways, std::uint32_t lane, const Witness& measured) noexcept {
  const Vec3f way = {ways.apart[0][lane], ways.apart[1][lane], ways.apart[2][lane]};
  const float length = sqrt_of(squared_norm(way));
  if (!(length > 0) || measured.crosses()) return {};
  return {(1 / length) * way, measured.a, measured.b};
}

void separate(const Kernels& kernels, const PairFrame& frame, Pace& pace,
              const Witness (&pairs)[kBatch], Vec3f along, float (&out)[kBatch]) noexcept {
  const RegionTriangle* a[kBatch];
  const RegionTriangle* b[kBatch];
  for (std::uint32_t i = 0; i < kBatch; ++i) {
    a[i] = &frame.a->region_triangles[pairs[i].a];
    b[i] = &frame.b->region_triangles[pairs[i].b];
  }
  pace.charge(kSeparationUnits);
  kernels.separations(a, b, frame.a_to_b, along, out);
  const float scale_b = sqrt_of(frame.scale2_b);
  for (float& apart : out) apart *= scale_b;
}

Bounds search(const Kernels& kernels, const PairFrame& frame, SearchScratch& scratch, Pace& pace,
              std::uint32_t region, const Witness& witness, const Reach& reach) noexcept {
  const image::Region& top = frame.a->regions[region];
  const Bounds found =
      Search(kernels, frame, scratch, pace, witness, reach).run(child_name(top.parent, top.slot));
  scratch.near.sort();
  return found;
}

}  // namespace palpate::regions
