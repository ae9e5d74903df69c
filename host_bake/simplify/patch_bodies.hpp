// SPDX-License-Identifier: GPL-3.0-or-later
// What is known about the hull of each patch, kept until the patch changes beyond it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "host_bake/simplify/outer_hull.hpp"
#include "host_bake/simplify/patch_hulls.hpp"
#include "host_bake/simplify/patch_lists.hpp"
#include "host_bake/simplify/patch_shape.hpp"

namespace palpate::bake {

using Corners = std::array<PointF, 3>;

/// Some part of the triangle enters the hull.
bool enters(ShrunkHull& hull, const Corners& triangle);

/// The body of a patch holds its hull: it is that hull, or for a while a larger one. Large patches
/// have bodies that grow (OuterHull).
class PatchBodies {
 public:
  PatchBodies(const PatchLists& patches, ShapeGatherer& gatherer, HullBuilder& builder);

  /// A patch of so many faces has a body that grows.
  [[nodiscard]] static bool is_large(std::size_t faces) { return faces >= kLarge; }

  /// The body as far as it is known now; nullptr where it is not, or has no interior. Of bodies
  /// that grow, what they were at first.
  [[nodiscard]] ShrunkHull* known(std::uint32_t patch);
  /// The body of a large patch, to grow it; nullptr where it has not the interior for it.
  [[nodiscard]] OuterHull* growing(std::uint32_t patch);
  /// The body of a large patch, where it is known.
  [[nodiscard]] OuterHull* known_growing(std::uint32_t patch) { return outers_[patch].get(); }

  /// Some part of a triangle enters the known body.
  [[nodiscard]] bool body_entered_by(std::uint32_t patch, const Corners& triangle);
  /// Some part of a triangle enters the patch's hull.
  [[nodiscard]] bool entered_by(std::uint32_t patch, const Corners& triangle);

  /// The patch has changed: nothing is known;
  void forget(std::uint32_t patch);
  /// its hull has been built; or
  void set(std::uint32_t patch, HullKind kind, std::size_t faces, const ShrunkHull& hull);
  /// the body known, as grown since, holds its hull.
  void keep(std::uint32_t patch);

 private:
  static constexpr std::size_t kLarge = 48;
  ShrunkHull* find(std::uint32_t patch);

  const PatchLists& patches_;
  ShapeGatherer& gatherer_;
  HullBuilder& builder_;
  std::vector<std::unique_ptr<ShrunkHull>> hulls_;  // by patch, where solid
  std::vector<HullKind> kinds_;
  std::vector<std::unique_ptr<OuterHull>> outers_;
  PatchShape shape_;
  ShrunkHull hull_;
};

}  // namespace palpate::bake
