// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/simplify/patch_bodies.hpp"

#include "host_bake/decompose/geometry.hpp"

namespace palpate::bake {

bool enters(ShrunkHull& hull, const Corners& t) {
  return hull.entered_by(position(t[0]), position(t[1]), position(t[2]));
}

PatchBodies::PatchBodies(const PatchLists& patches, ShapeGatherer& gatherer, HullBuilder& builder)
    : patches_(patches),
      gatherer_(gatherer),
      builder_(builder),
      hulls_(patches.count()),
      kinds_(patches.count(), HullKind::unknown),
      outers_(patches.count()) {}

/// Builds the hull where nothing is known.
ShrunkHull* PatchBodies::find(std::uint32_t patch) {
  if (kinds_[patch] != HullKind::unknown) return hulls_[patch].get();
  const std::array<std::uint32_t, 1> one = {patch};
  gatherer_.gather(patches_, one, nullptr, shape_);
  forget(patch);
  std::unique_ptr<OuterHull> outer;
  HullKind kind;
  if (is_large(shape_.faces.size())) {
    outer = std::make_unique<OuterHull>();
    kind = outer->build(shape_, gatherer_, hull_);
  } else {
    FaceBox all;
    kind = builder_.build(shape_, nullptr, gatherer_, hull_, all);
  }
  kinds_[patch] = kind;
  if (kind != HullKind::solid) return nullptr;
  outers_[patch] = std::move(outer);
  hulls_[patch] = std::make_unique<ShrunkHull>(hull_);  // without the scratch's capacity
  return hulls_[patch].get();
}

ShrunkHull* PatchBodies::known(std::uint32_t patch) { return hulls_[patch].get(); }

OuterHull* PatchBodies::growing(std::uint32_t patch) {
  if (outers_[patch] && outers_[patch]->full()) forget(patch);
  const ShrunkHull* hull = find(patch);
  return hull == nullptr || hull->thin() ? nullptr : outers_[patch].get();
}

bool PatchBodies::body_entered_by(std::uint32_t patch, const Corners& triangle) {
  return enters(*hulls_[patch], triangle) ||
         (outers_[patch] && outers_[patch]->parts_entered_by(triangle));
}

bool PatchBodies::entered_by(std::uint32_t patch, const Corners& triangle) {
  if (find(patch) == nullptr || !body_entered_by(patch, triangle)) return false;
  if (kinds_[patch] != HullKind::outer) return true;
  forget(patch);
  return find(patch) != nullptr && body_entered_by(patch, triangle);
}

void PatchBodies::forget(std::uint32_t patch) {
  kinds_[patch] = HullKind::unknown;
  hulls_[patch].reset();
  outers_[patch].reset();
}

void PatchBodies::set(std::uint32_t patch, HullKind kind, std::size_t faces,
                      const ShrunkHull& hull) {
  forget(patch);
  if (is_large(faces)) return;  // which find() makes one that grows
  kinds_[patch] = kind;
  if (kind == HullKind::solid) hulls_[patch] = std::make_unique<ShrunkHull>(hull);
}

void PatchBodies::keep(std::uint32_t patch) {
  kinds_[patch] = HullKind::outer;
  if (outers_[patch]) outers_[patch]->keep();
}

}  // namespace palpate::bake
