// SPDX-License-Identifier: GPL-3.0-or-later
// The constraints of Sec. 4.3 on one collapse or merge at a time.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "host_bake/simplify/box_tree.hpp"
#include "host_bake/simplify/lazy_hull.hpp"
#include "host_bake/simplify/near_boxes.hpp"
#include "host_bake/simplify/patch_bodies.hpp"
#include "host_bake/simplify/patch_hulls.hpp"
#include "host_bake/simplify/patch_lists.hpp"
#include "host_bake/simplify/patch_shape.hpp"
#include "host_bake/simplify/shape_planes.hpp"
#include "host_bake/simplify/surface.hpp"

namespace palpate::bake {

/// Why an edge is not collapsed, in the order in which the tests are made.
enum class Refusal : std::uint8_t {
  none,
  link,        ///< the topology would change, or the vertex has too many neighbours
  frozen,      ///< next to faces that cross
  local,       ///< no position meets eqs. 2 to 4
  flip,        ///< a face would turn over or lose its area
  rounding,    ///< eqs. 2 to 4 fail once the position is rounded to float
  visibility,  ///< constraint 2
  hull,        ///< constraint 3: a face enters the hull of a changed patch
  other_hull,  ///< constraint 3: a changed face enters the hull of another patch
  crossing,    ///< the surface would cross itself
};
inline constexpr std::size_t kRefusals = 10;
const char* name_of(Refusal refusal);

/// Judges positions of the new vertex, exactly on float coordinates, and keeps what it needs for
/// that: places of faces and patches, and hulls of patches until they change.
///
/// Hulls are judged as in decompose(): a face enters where something is left of it after clipping
/// by the hull shrunk by kShrink_rel. A patch that is a whole convex component can only be entered
/// by a face that crosses it, and grows only by the hull of the new vertex and its ring.
class Constraints {
 public:
  Constraints(const Surface& surface, const PatchLists& patches);

  /// Begins to judge the collapse of a ring.
  void begin(const Ring& ring);
  [[nodiscard]] Refusal judge(const PointF& position);

  /// After the surface and the patches have been changed as judged last.
  void follow_collapse();

  /// May two neighbouring patches be one? Where so, and after patches.merge(), follow_merge().
  [[nodiscard]] bool may_merge(std::uint32_t a, std::uint32_t b);
  void follow_merge(std::uint32_t kept, std::uint32_t gone);

 private:
  struct Affected {
    PatchShape shape;
    ShapePlanes planes;
    ShrunkHull hull;
    HullKind kind = HullKind::unknown;
    bool closed = false;
    bool within = false;  // the body known before, and grown, holds the new hull
  };

  struct StarFace {
    Corners corners;
    FaceBox box;
    std::uint32_t patch;
  };

  [[nodiscard]] Corners corners_after(std::size_t ring_face) const;
  [[nodiscard]] Corners corners(std::uint32_t face) const;
  [[nodiscard]] bool is_affected(std::uint32_t patch) const;
  [[nodiscard]] Refusal judge_faces() const;
  [[nodiscard]] Refusal judge_edges() const;
  [[nodiscard]] bool visible(const Affected& affected) const;
  [[nodiscard]] bool hull_is_entered(Affected& affected);
  [[nodiscard]] bool stays(std::uint32_t face) const;
  template <class Visit>
  bool search_unchanged(const FaceBox& box, Visit visit);
  [[nodiscard]] bool entered_by_unchanged(std::uint32_t patch, ShrunkHull& hull,
                                          const FaceBox& box);
  [[nodiscard]] Entry admit(const PatchShape& shape, std::uint32_t face, const Corners& at);
  [[nodiscard]] FaceBox place_of_hulls() const;
  void set_star();
  [[nodiscard]] bool below_each_other(std::uint32_t large, std::uint32_t small);
  [[nodiscard]] bool merges_within(std::uint32_t large, std::uint32_t small);
  [[nodiscard]] bool enters_others();
  [[nodiscard]] bool crosses();
  [[nodiscard]] bool stays_within(const Affected& affected);
  [[nodiscard]] Entry large_hull_is_entered(const Affected& affected);
  [[nodiscard]] bool grown_part_is_entered(Affected& affected);
  void place(std::uint32_t patch, const FaceBox& box);

  const Surface& surface_;
  const PatchLists& patches_;
  ShapeGatherer gatherer_;
  HullBuilder builder_;
  BoxTree faces_, boxes_;
  NearBoxes near_faces_;
  PatchBodies bodies_;

  const Ring* ring_ = nullptr;
  PointF position_{};
  std::vector<Affected> affected_;
  std::size_t affected_count_ = 0;
  std::vector<StarFace> star_;
  FaceBox star_box_;
  Affected merged_;
  std::uint32_t merged_first_ = 0;  // points of the larger one; they come first
  LazyHull lazy_;
  bool lazy_started_ = false;        // for the patch judged now
  std::vector<std::uint32_t> near_;  // local vertices, for lazy_
};

}  // namespace palpate::bake
