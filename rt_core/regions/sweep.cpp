// SPDX-License-Identifier: Apache-2.0
#include "rt_core/regions/sweep.hpp"

#include <limits>

#include "rt_core/base/assert.hpp"

namespace palpate::regions {
namespace {

using image::RegionNode;

/// Parts of b are divided until they are no larger than this many times the part of a, squared:
/// dividing them further tells few more regions apart, and costs most of the sweep.
constexpr float kCoarse2 = 16;

class Sweep {
 public:
  Sweep(const Kernels& kernels, const PairFrame& frame, SearchScratch& scratch, Pace& pace,
        float limit, std::span<float> out_squared) noexcept
      : kernels_(kernels),
        frame_(frame),
        scratch_(scratch),
        pace_(pace),
        limit_squared_(limit * limit),
        out_squared_(out_squared) {}

  void run() noexcept {
    for (float& squared : out_squared_) squared = std::numeric_limits<float>::max();
    const RegionNode& root = frame_.a->region_nodes[0];
    for (std::uint32_t slot = 0; slot < root.children; ++slot) {
      const std::uint32_t child = child_name(0, slot);
      if (pace_.go_on()) {
        split_b(child, 0);
      } else {
        cover(child, 0);
      }
    }
    while (size_ > 0) {
      const Candidate top = scratch_.stack[--size_];
      if (tells_nothing(top)) continue;
      if (pace_.go_on()) {
        descend(top);
      } else {
        cover(top.a, top.squared);
      }
    }
  }

 private:
  /// Children of a are nodes here: nothing below regions is looked at.
  const RegionNode& node_below_a(std::uint32_t a) const noexcept {
    return frame_.a->region_nodes[frame_.a->region_nodes[node_of(a)].first + slot_of(a)];
  }

  /// Of the regions below a child of a.
  std::span<float> bounds_below(std::uint32_t a) const noexcept {
    const RegionNode& below = node_below_a(a);
    return out_squared_.subspan(below.first_region, below.regions);
  }

  /// All regions that it is about are known to be no farther.
  bool tells_nothing(const Candidate& pair) const noexcept {
    for (const float least : bounds_below(pair.a)) {
      if (least > pair.squared) return false;
    }
    return true;
  }

  void descend(const Candidate& pair) noexcept {
    const RegionNode& over_a = frame_.a->region_nodes[node_of(pair.a)];
    const RegionNode& over_b = frame_.b->region_nodes[node_of(pair.b)];
    const bool b_larger = frame_.scale2_b * size2_of(over_b, slot_of(pair.b)) >
                          kCoarse2 * frame_.scale2_a * size2_of(over_a, slot_of(pair.a));
    const bool whole_b = over_b.leaf != 0 || !b_larger;
    if (!whole_b) {
      split_b(pair.a, over_b.first + slot_of(pair.b));
    } else if (node_below_a(pair.a).region != image::kNone) {
      cover(pair.a, pair.squared);
    } else {
      split_a(over_a.first + slot_of(pair.a), pair.b);
    }
  }

  void split_a(std::uint32_t node, std::uint32_t b) noexcept {
    const RegionNode& over_b = frame_.b->region_nodes[node_of(b)];
    const RegionNode& parent = frame_.a->region_nodes[node];
    const std::uint32_t near =
        test(box_of(over_b, slot_of(b)), frame_.b_to_a, parent, frame_.scale2_a);
    for (std::uint32_t i = 0; i < parent.children; ++i) {
      const Candidate child = {child_name(node, i), b, test_.squared[i]};
      if ((near >> i & 1u) != 0) {
        push(child);
      } else {
        cover(child.a, child.squared);
      }
    }
  }

  void split_b(std::uint32_t a, std::uint32_t node) noexcept {
    const RegionNode& over_a = frame_.a->region_nodes[node_of(a)];
    const RegionNode& parent = frame_.b->region_nodes[node];
    const std::uint32_t near =
        test(box_of(over_a, slot_of(a)), frame_.a_to_b, parent, frame_.scale2_b);
    float far = std::numeric_limits<float>::max();
    for (std::uint32_t i = 0; i < parent.children; ++i) {
      const float s = test_.squared[i];
      if ((near >> i & 1u) != 0) {
        push({a, child_name(node, i), s});
      } else {
        far = s < far ? s : far;
      }
    }
    cover(a, far);
  }

  std::uint32_t test(const Box& box, const Transform& to_node, const RegionNode& node,
                     float scale2) noexcept {
    pace_.charge(1);
    return kernels_.test_boxes(box, to_node, {}, node, scale2, limit_squared_, Order::any, test_);
  }

  void push(const Candidate& c) noexcept {
    PALPATE_ASSERT(size_ < kMaxCandidates);
    scratch_.stack[size_++] = c;
  }

  /// A part of b that is `squared` or more from everything below a child of a.
  void cover(std::uint32_t a, float squared) noexcept {
    for (float& least : bounds_below(a)) least = squared < least ? squared : least;
  }

  const Kernels& kernels_;
  const PairFrame& frame_;
  SearchScratch& scratch_;
  Pace& pace_;
  float limit_squared_;
  std::span<float> out_squared_;
  BoxTest test_;
  std::uint32_t size_ = 0;
};

}  // namespace

void sweep(const Kernels& kernels, const PairFrame& frame, SearchScratch& scratch, Pace& pace,
           float limit, std::span<float> out_squared) noexcept {
  Sweep(kernels, frame, scratch, pace, limit, out_squared).run();
}

}  // namespace palpate::regions
