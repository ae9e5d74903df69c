// SPDX-License-Identifier: GPL-3.0-or-later
// The boxes of a tree about one place, for many searches there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "host_bake/simplify/box_tree.hpp"

namespace palpate::bake {

/// Answers as the tree does, as long as that stays as it is. The first search looks up what is near
/// the place; what those after it need is then in one short list.
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

  /// As BoxTree::search().
  template <class Visit>
  bool search(const FaceBox& query, Visit visit) {
    if (!holds(query)) return tree_.search(query, visit);
    if (!found_) find();
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
  void find() {
    near_.clear();
    tree_.search(region_, [&](std::uint32_t id) {
      near_.push_back({tree_.box(id), id});
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
