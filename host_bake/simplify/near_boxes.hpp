// SPDX-License-Identifier: GPL-3.0-or-later
// The boxes of a tree about one place, for many searches there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "host_bake/simplify/box_tree.hpp"

namespace palpate::bake {

/// Answers as the tree does, but for boxes that do not count, as long as the tree stays as it is.
/// The first search looks up what is near the place and counts; what those after it need is then in
/// one short list.
class NearBoxes {
 public:
  explicit NearBoxes(const BoxTree& tree) : tree_(tree) {}

  /// The place of the searches to come, and with it a new beginning.
  void move_to(const FaceBox& place) {
    region_ = place;
    found_ = false;
    // As far again on each side: so far reach the hulls of most small patches at the place.
    for (std::size_t i = 0; i < 3; ++i) {
      const float margin = 0.1F * (place.high[i] - place.low[i]);
      region_.low[i] -= margin;
      region_.high[i] += margin;
    }
  }

  /// As BoxTree::search(), for those for which counts(id) -> bool: always the same at one place.
  template <class Counts, class Visit>
  bool search(const FaceBox& query, Counts counts, Visit visit) {
    if (!holds(query))
      return tree_.search(query, [&](std::uint32_t id) { return counts(id) && visit(id); });
    if (!found_) find(counts);
    for (const Near& near : near_)
      if (near.box.meets(query) && visit(near.id)) return true;
    return false;
  }

 private:
  struct Near {
    FaceBox box;
    std::uint32_t id;
  };
  [[nodiscard]] bool holds(const FaceBox& query) const {
    for (std::size_t i = 0; i < 3; ++i)
      if (query.low[i] < region_.low[i] || query.high[i] > region_.high[i]) return false;
    return true;
  }
  template <class Counts>
  void find(Counts counts) {
    near_.clear();
    tree_.search(region_, [&](std::uint32_t id) {
      if (counts(id)) near_.push_back({tree_.box(id), id});
      return false;
    });
    found_ = true;
  }

  const BoxTree& tree_;
  FaceBox region_;
  bool found_ = false;
  std::vector<Near> near_;
};

}  // namespace palpate::bake
