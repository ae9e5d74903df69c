// SPDX-License-Identifier: GPL-3.0-or-later
// Grows one convex patch after another over the plates of a surface.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "host_bake/decompose/face_tree.hpp"
#include "host_bake/decompose/plates.hpp"
#include "host_bake/decompose/shrunk_hull.hpp"
#include "host_bake/decompose/surface_edges.hpp"
#include "host_bake/hull/growing_hull.hpp"

namespace palpate::bake {

/// A patch takes its seed's neighbours breadth-first over crossable edges, each as far as the three
/// constraints of Sec. 4.3 allow. Once refused, a plate stays refused for this patch: a larger
/// patch would refuse it too.
///
/// Constraints 1 and 2 are exact and decided plate by plate on the growing hull. A plate that lies
/// below no plane of the patch, and the patch below its plane, also makes every edge between them
/// convex, so 2 implies 1. Constraint 3 asks all faces near the hull and would cost O(n^2) on large
/// smooth patches if it were asked for each plate. It is asked for batches, which double while they
/// hold; a batch that fails is taken back and halved.
class PatchGrower {
 public:
  static constexpr std::uint32_t kFree = std::numeric_limits<std::uint32_t>::max();

  PatchGrower(const NormalMesh& mesh, const SurfaceEdges& edges, const Plates& plates,
              const std::vector<std::uint32_t>& most_faces);

  /// Grows a patch from a free plate and gives it the number `id`. The patch, its faces and its
  /// hull are readable until the next call.
  void grow(std::uint32_t seed, std::uint32_t id);

  [[nodiscard]] bool is_free(std::uint32_t plate) const { return patch_of_plate_[plate] == kFree; }
  [[nodiscard]] std::span<const std::uint32_t> plates() const { return members_; }
  [[nodiscard]] const std::vector<std::uint32_t>& faces() const { return faces_; }
  /// Solid or flat; not started for a seed without area.
  [[nodiscard]] const GrowingHull& hull() const { return hull_; }
  [[nodiscard]] bool has_area() const { return has_area_; }

 private:
  /// A state that satisfies all constraints.
  struct Checkpoint {
    std::size_t members, faces, queue, head;
  };
  [[nodiscard]] bool fits(std::uint32_t plate) const;
  [[nodiscard]] bool add_to_hull(std::uint32_t plate);
  void take(std::uint32_t plate);
  void queue_neighbours(std::uint32_t plate, EdgeKind over);
  [[nodiscard]] Checkpoint checkpoint() const;
  void take_back(const Checkpoint& checkpoint, std::size_t head);
  [[nodiscard]] bool is_clear();
  [[nodiscard]] bool enters(std::uint32_t face);

  const NormalMesh& mesh_;
  const SurfaceEdges& edges_;
  const Plates& plates_;
  const std::vector<std::uint32_t>& most_faces_;
  FaceTree tree_;  // the patch's faces are hidden
  GrowingHull hull_;
  ShrunkHull shrunk_;

  std::vector<std::uint32_t> patch_of_plate_, patch_of_face_;
  std::vector<std::uint32_t> seen_by_;  // the patch whose queue a plate is in, or was
  std::uint32_t id_ = 0;
  bool has_area_ = false;
  std::vector<std::uint32_t> members_, faces_, queue_;
  std::size_t head_ = 0;
  std::vector<std::uint32_t> intruders_;  // faces that entered lately: likely to enter again
};

}  // namespace palpate::bake
