// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/search.hpp"

#include <cstddef>
#include <limits>

#include "rt_core/base/assert.hpp"
#include "rt_core/regions/named_box.hpp"

namespace palpate::regions {
namespace {

using image::RegionNode;
using image::RegionTriangle;

constexpr float kFar = std::numeric_limits<float>::max();

/// Distances of sixteen pairs at once, in units.
std::uint32_t evaluate(const Kernels& kernels, const PairFrame& frame, SearchScratch& scratch,
                       float (&out_squared)[kBatch]) noexcept {
  const RegionTriangle* a[kBatch];
  const RegionTriangle* b[kBatch];
  for (std::uint32_t i = 0; i < kBatch; ++i) {
    a[i] = &frame.a->region_triangles[scratch.batch_a[i]];
    b[i] = &frame.b->region_triangles[scratch.batch_b[i]];
  }
  const std::uint32_t crossing =
      kernels.triangle_distances(a, b, frame.a_to_b, scratch.kernel, out_squared);
  for (float& squared : out_squared) squared *= frame.scale2_b;
  return crossing;
}

/// Of a box.
struct Centre {
  float x, y, z;
};

Centre centre_in(const Box& box, const Transform& map) noexcept {
  const float* r = map.rotation;
  const float* t = map.translation;
  const float x = box.x[3];
  const float y = box.y[3];
  const float z = box.z[3];
  return {map.scale * (r[0] * x + r[1] * y + r[2] * z) + t[0],
          map.scale * (r[3] * x + r[4] * y + r[5] * z) + t[1],
          map.scale * (r[6] * x + r[7] * y + r[8] * z) + t[2]};
}

/// Of a centre and that of a child.
float apart_squared(const Centre& centre, const RegionNode& node, std::uint32_t slot) noexcept {
  const float x = node.centre[0][slot] - centre.x;
  const float y = node.centre[1][slot] - centre.y;
  const float z = node.centre[2][slot] - centre.z;
  return x * x + y * y + z * z;
}

/// Trees of a scene are larger than the near caches.
void fetch(const RegionNode& node) noexcept {
  constexpr std::size_t kLine = 64;
  const auto* bytes = reinterpret_cast<const std::byte*>(&node);
  for (std::size_t i = 0; i < sizeof(RegionNode); i += kLine) __builtin_prefetch(bytes + i);
}

class Search {
 public:
  Search(const Kernels& kernels, const PairFrame& frame, SearchScratch& scratch, Pace& pace,
         const Witness& witness, const Reach& reach) noexcept
      : kernels_(kernels), frame_(frame), scratch_(scratch), pace_(pace), reach_(reach) {
    const float scale = frame.a_to_b.scale;
    volume_a_ = scale * scale * scale;
    out_.best = given_ = witness;
    best_squared_ = witness.known() ? witness.distance * witness.distance : kFar;
    scratch_.near.count = 0;
    if (witness.known()) scratch_.near.add(witness, 0);
    lower_threshold();
  }

  Bounds run(const image::Region& region) noexcept {
    visit_root(child_name(region.parent, region.slot));
    return finish();
  }

  /// Looks at everything within the limit, and keeps what crosses.
  void collect(const levels::PairState& pair, const image::Region& region,
               CrossingList& list) noexcept {
    if (!pace_.go_on()) return;
    pair_ = &pair;
    crossings_ = &list;
    visit_root(child_name(region.parent, region.slot));
    static_cast<void>(finish());
  }

 private:
  Bounds finish() noexcept {
    while (size_ > 0 || pending_ > 0) {
      if (!pace_.go_on() || has_first()) return interrupted();
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

  bool has_first() const noexcept {
    return reach_.first && out_.best.known() && out_.best.distance < reach_.limit;
  }

  /// The root of b against a region: the one pair whose second box is not stored.
  void visit_root(std::uint32_t a) noexcept {
    const Box box = box_of(frame_.a->region_nodes[node_of(a)], slot_of(a));
    keep_children_of_b(a, 0, false,
                       expand(box, frame_.a_to_b, frame_.b->region_nodes[0], frame_.scale2_b));
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
      const std::uint32_t node = over_a.first + slot_a;
      fetch(frame_.a->region_nodes[node]);
      const std::uint32_t near = expand(box_of(over_b, slot_b), frame_.b_to_a,
                                        frame_.a->region_nodes[node], frame_.scale2_a);
      keep_children_of_a(node, pair.b, over_b.leaf != 0, near);
    } else {
      const std::uint32_t node = over_b.first + slot_b;
      fetch(frame_.b->region_nodes[node]);
      const std::uint32_t near = expand(box_of(over_a, slot_a), frame_.a_to_b,
                                        frame_.b->region_nodes[node], frame_.scale2_b);
      keep_children_of_b(pair.a, node, over_a.leaf != 0, near);
    }
  }

  /// One box against the children of a node; leaves their bounds in squared_.
  /// @return the children that may hold something nearer
  std::uint32_t expand(const Box& box, const Transform& to_node, const RegionNode& node,
                       float scale2) noexcept {
    pace_.charge(1);
    centre_ = centre_in(box, to_node);
    const std::uint32_t children = children_of(node);
    const std::uint32_t near =
        children & kernels_.test_boxes(box, to_node, node, threshold_squared_ / scale2, squared_);
    if (best_squared_ >= threshold_squared_) {
      for (std::uint32_t far = children & ~near; far != 0; far &= far - 1) {
        note_passed_over(squared_[__builtin_ctz(far)] * scale2);
      }
    }
    return near;
  }

  /// Only while nothing within the limit is known does it matter how far what is passed over is:
  /// a region that is far rests for as long.
  void note_passed_over(float squared) noexcept {
    passed_squared_ = squared < passed_squared_ ? squared : passed_squared_;
  }

  void keep_children_of_a(std::uint32_t node, std::uint32_t b, bool b_is_triangle,
                          std::uint32_t near) noexcept {
    const RegionNode& parent = frame_.a->region_nodes[node];
    const bool pairs = parent.leaf != 0 && b_is_triangle;
    const std::uint32_t bottom = size_;
    for (; near != 0; near &= near - 1) {
      const auto slot = static_cast<std::uint32_t>(__builtin_ctz(near));
      const float squared = squared_[slot] * frame_.scale2_a;
      if (pairs) {
        add_pair(parent.first + slot, triangle_of(*frame_.b, b), squared);
      } else {
        push({child_name(node, slot), b, squared, centres(parent, slot, squared)});
      }
    }
    nearest_to_top(bottom);
  }

  void keep_children_of_b(std::uint32_t a, std::uint32_t node, bool a_is_triangle,
                          std::uint32_t near) noexcept {
    const RegionNode& parent = frame_.b->region_nodes[node];
    const bool pairs = parent.leaf != 0 && a_is_triangle;
    const std::uint32_t bottom = size_;
    for (; near != 0; near &= near - 1) {
      const auto slot = static_cast<std::uint32_t>(__builtin_ctz(near));
      const float squared = squared_[slot] * frame_.scale2_b;
      if (pairs) {
        add_pair(triangle_of(*frame_.a, a), parent.first + slot, squared);
      } else {
        push({a, child_name(node, slot), squared, centres(parent, slot, squared)});
      }
    }
    nearest_to_top(bottom);
  }

  /// Of the box looked at last and a child; asked for where the boxes overlap only.
  float centres(const RegionNode& node, std::uint32_t slot, float squared) const noexcept {
    if (squared > 0) return 0;
    return apart_squared(centre_, node, slot);
  }

  static bool goes_first(const Candidate& p, const Candidate& q) noexcept {
    return p.squared < q.squared || (p.squared == q.squared && p.centres < q.centres);
  }

  /// Sorts the candidates from `bottom` on, at most a node's children. Half the work until the
  /// nearest pair is met, against the nearest child on top and the others in any order.
  void nearest_to_top(std::uint32_t bottom) noexcept {
    for (std::uint32_t i = bottom + 1; i < size_; ++i) {
      const Candidate next = scratch_.stack[i];
      std::uint32_t hole = i;
      for (; hole > bottom && goes_first(scratch_.stack[hole - 1], next); --hole) {
        scratch_.stack[hole] = scratch_.stack[hole - 1];
      }
      scratch_.stack[hole] = next;
    }
  }

  static std::uint32_t triangle_of(const ImageView& image, std::uint32_t name) noexcept {
    return image.region_nodes[node_of(name)].first + slot_of(name);
  }

  void push(const Candidate& c) noexcept {
    PALPATE_ASSERT(size_ < kMaxCandidates);
    scratch_.stack[size_++] = c;
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
    for (std::uint32_t i = pending_; i < kBatch; ++i) {
      scratch_.batch_a[i] = scratch_.batch_a[0];
      scratch_.batch_b[i] = scratch_.batch_b[0];
    }
    pace_.charge(kBatchUnits);
    float squared[kBatch];
    const std::uint32_t crossing = evaluate(kernels_, frame_, scratch_, squared);
    if (crossings_ != nullptr) {
      note_crossings(crossing);
      pending_ = 0;
      return;
    }
    keep_nearest(squared);
    pending_ = 0;
  }

  void keep_nearest(const float (&squared)[kBatch]) noexcept {
    for (std::uint32_t i = 0; i < pending_; ++i) {
      if (squared[i] < best_squared_) {
        best_squared_ = squared[i];
        out_.best = {scratch_.batch_a[i], scratch_.batch_b[i], sqrt_of(squared[i])};
        lower_threshold();
      }
    }
    for (std::uint32_t i = 0; i < pending_; ++i) {
      if (squared[i] >= threshold_squared_) continue;
      const Witness pair{scratch_.batch_a[i], scratch_.batch_b[i], sqrt_of(squared[i])};
      if (pair.same_pair(given_)) continue;
      const float dropped = scratch_.near.add(pair, most_);
      if (dropped < most_) {
        most_ = dropped;
        lower_threshold();
      }
    }
  }

  void note_crossings(std::uint32_t crossing) noexcept {
    for (std::uint32_t left = crossing & ((1u << pending_) - 1u); left != 0; left &= left - 1) {
      const int i = __builtin_ctz(left);
      note_crossing(*pair_, scratch_.batch_a[i], scratch_.batch_b[i], *crossings_);
    }
  }

  void lower_threshold() noexcept {
    const float best =
        out_.best.known() && out_.best.distance < reach_.limit ? out_.best.distance : reach_.limit;
    const float wanted = best + reach_.margin;
    threshold_ = wanted < most_ ? wanted : most_;
    threshold_ = threshold_ > 0 ? threshold_ : 0;
    threshold_squared_ = threshold_ * threshold_;
  }

  /// Everything that was passed over is at least this far.
  float passed_over() const noexcept {
    if (best_squared_ < threshold_squared_) return threshold_;
    const float passed = sqrt_of(passed_squared_);
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

  const Kernels& kernels_;
  const PairFrame& frame_;
  SearchScratch& scratch_;
  Pace& pace_;
  Reach reach_;
  Witness given_;
  float volume_a_ = 1;      // a's unit of volume, in b's
  float most_ = kFarthest;  // pairs from here on have been dropped
  Bounds out_;
  float best_squared_ = kFar;
  float threshold_ = 0;
  float threshold_squared_ = 0;
  float passed_squared_ = kFar;
  float squared_[kBatch];  // of the children looked at last, in their image's unit
  Centre centre_{};        // of the single box, beside them
  std::uint32_t size_ = 0;
  std::uint32_t pending_ = 0;
  const levels::PairState* pair_ = nullptr;
  CrossingList* crossings_ = nullptr;  // null: distances are asked for
};

std::uint32_t neighbour(const ImageView& image, std::uint32_t triangle, std::uint32_t i) noexcept {
  const std::uint32_t n = image.region_triangles[triangle].neighbours[i];
  return n == image::kNone ? triangle : n;
}

/// Itself and its neighbours within its region.
void around_a(const ImageView& image, std::uint32_t t, std::uint32_t (&out)[4]) noexcept {
  out[0] = t;
  for (std::uint32_t i = 0; i < 3; ++i) {
    const std::uint32_t n = neighbour(image, t, i);
    const bool same = image.region_triangles[n].region == image.region_triangles[t].region;
    out[i + 1] = same ? n : t;
  }
}

void around_b(const ImageView& image, std::uint32_t t, std::uint32_t (&out)[4]) noexcept {
  out[0] = t;
  for (std::uint32_t i = 0; i < 3; ++i) out[i + 1] = neighbour(image, t, i);
}

/// The nearest of a node's children, and of those that overlap the one whose centre is.
std::uint32_t nearest_child(const Kernels& kernels, const Box& box, const Transform& to_node,
                            const RegionNode& node, Pace& pace) noexcept {
  pace.charge(1);
  float squared[kBatch];
  static_cast<void>(kernels.test_boxes(box, to_node, node, kFar, squared));
  const Centre centre = centre_in(box, to_node);
  std::uint32_t best = 0;
  float best_apart = kFar;
  for (std::uint32_t i = 0; i < node.children; ++i) {
    if (squared[i] > squared[best]) continue;
    const float apart = apart_squared(centre, node, i);
    if (squared[i] < squared[best] || apart < best_apart) {
      best = i;
      best_apart = apart;
    }
  }
  return best;
}

/// A leaf of a region as a child of the node above it.
std::uint32_t leaf_of(const ImageView& image, const image::Region& region,
                      std::uint32_t which) noexcept {
  std::uint32_t name = child_name(region.parent, region.slot);
  for (std::uint32_t depth = 0; depth < image::kMaxRegionDepth; ++depth) {
    const std::uint32_t below = image.region_nodes[node_of(name)].first + slot_of(name);
    const RegionNode& node = image.region_nodes[below];
    if (node.leaf != 0) break;
    name = child_name(below, which % node.children);
    which /= node.children;
  }
  return name;
}

}  // namespace

Witness dive(const Kernels& kernels, const PairFrame& frame, Pace& pace, std::uint32_t region,
             std::uint32_t which) noexcept {
  const std::uint32_t leaf = leaf_of(*frame.a, frame.a->regions[region], which);
  const RegionNode& over_a = frame.a->region_nodes[node_of(leaf)];
  const Box box = box_of(over_a, slot_of(leaf));
  std::uint32_t node = 0;
  std::uint32_t slot = 0;
  for (std::uint32_t depth = 0; depth < image::kMaxRegionDepth; ++depth) {
    const RegionNode& over_b = frame.b->region_nodes[node];
    slot = nearest_child(kernels, box, frame.a_to_b, over_b, pace);
    if (over_b.leaf != 0) break;
    node = over_b.first + slot;
  }
  const RegionNode& over_b = frame.b->region_nodes[node];
  const RegionNode& in_a = frame.a->region_nodes[over_a.first + slot_of(leaf)];
  const std::uint32_t of_a = nearest_child(kernels, box_of(over_b, slot), frame.b_to_a, in_a, pace);
  return {in_a.first + of_a, over_b.first + slot, 0};
}

void measure(const Kernels& kernels, const PairFrame& frame, SearchScratch& scratch, Pace& pace,
             std::uint32_t count, float (&out_distances)[kBatch]) noexcept {
  PALPATE_ASSERT(count > 0 && count <= kBatch);
  for (std::uint32_t i = count; i < kBatch; ++i) {
    scratch.batch_a[i] = scratch.batch_a[0];
    scratch.batch_b[i] = scratch.batch_b[0];
  }
  pace.charge(kBatchUnits);
  evaluate(kernels, frame, scratch, out_distances);
  for (float& d : out_distances) d = sqrt_of(d);
}

void climb(const Kernels& kernels, const PairFrame& frame, SearchScratch& scratch, Pace& pace,
           Witness& witness) noexcept {
  for (std::uint32_t step = 0; step < kMaxClimb && pace.go_on(); ++step) {
    std::uint32_t of_a[4];
    std::uint32_t of_b[4];
    around_a(*frame.a, witness.a, of_a);
    around_b(*frame.b, witness.b, of_b);
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      scratch.batch_a[i] = of_a[i / 4];
      scratch.batch_b[i] = of_b[i % 4];
    }
    pace.charge(kBatchUnits);
    float squared[kBatch];
    evaluate(kernels, frame, scratch, squared);
    std::uint32_t nearest = 0;  // the witness itself
    for (std::uint32_t i = 1; i < kBatch; ++i)
      nearest = squared[i] < squared[nearest] ? i : nearest;
    witness = {scratch.batch_a[nearest], scratch.batch_b[nearest], sqrt_of(squared[nearest])};
    if (nearest == 0) return;
  }
}

Bounds search(const Kernels& kernels, const PairFrame& frame, SearchScratch& scratch, Pace& pace,
              std::uint32_t region, const Witness& witness, const Reach& reach) noexcept {
  return Search(kernels, frame, scratch, pace, witness, reach).run(frame.a->regions[region]);
}

void find_crossings(const Kernels& kernels, const levels::PairState& pair, const PairFrame& frame,
                    SearchScratch& scratch, Pace& pace, std::uint32_t region,
                    CrossingList& list) noexcept {
  Search(kernels, frame, scratch, pace, {}, {kRounding, 0})
      .collect(pair, frame.a->regions[region], list);
}

}  // namespace palpate::regions
