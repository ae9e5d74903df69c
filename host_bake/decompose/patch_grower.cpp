// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/decompose/patch_grower.hpp"

#include <algorithm>
#include <cassert>

#include "host_bake/decompose/flat_cover.hpp"
#include "host_bake/decompose/geometry.hpp"

namespace palpate::bake {
namespace {

constexpr std::size_t kIntruders = 8;

}  // namespace

PatchGrower::PatchGrower(const NormalMesh& mesh, const SurfaceEdges& edges, const Plates& plates,
                         const std::vector<std::uint32_t>& most_faces)
    : mesh_(mesh),
      edges_(edges),
      plates_(plates),
      most_faces_(most_faces),
      tree_(mesh),
      hull_(mesh.points),
      patch_of_plate_(plates.size(), kFree),
      patch_of_face_(mesh.faces.size(), kFree),
      seen_by_(plates.size(), kFree) {}

void PatchGrower::take(std::uint32_t plate) {
  patch_of_plate_[plate] = id_;
  members_.push_back(plate);
  for (const std::uint32_t f : plates_.faces_of(plate)) {
    patch_of_face_[f] = id_;
    faces_.push_back(f);
    tree_.hide(f);
  }
  // While the patch is flat, what makes it solid comes first: nothing in its plane can join it
  // before.
  queue_neighbours(plate, EdgeKind::convex);
  queue_neighbours(plate, EdgeKind::flat);
}

void PatchGrower::queue_neighbours(std::uint32_t plate, EdgeKind over) {
  for (const std::uint32_t f : plates_.faces_of(plate))
    for (std::size_t h = 3 * std::size_t{f}; h < 3 * std::size_t{f} + 3; ++h) {
      if (edges_.kind[h] != over) continue;
      const std::uint32_t next = plates_.of_face[edges_.twin[h] / 3];
      if (!is_free(next) || plates_.fixed[next] || seen_by_[next] == id_) continue;
      seen_by_[next] = id_;
      queue_.push_back(next);
    }
}

bool PatchGrower::fits(std::uint32_t plate) const {
  const std::span<const std::uint32_t> added = plates_.faces_of(plate);
  return faces_.size() + added.size() <= most_faces_[added.front()];
}

/// Constraints 1 and 2. Leaves the hull as it was where they do not hold.
bool PatchGrower::add_to_hull(std::uint32_t plate) {
  const std::span<const std::uint32_t> corners = plates_.corners_of(plate);
  const Triangle plane = {corners[0], corners[1], corners[2]};
  const auto on_hull =
      std::find_if(corners.begin(), corners.end(), [&](std::uint32_t v) { return hull_.has(v); });
  std::uint32_t near = on_hull == corners.end() ? GrowingHull::kNone : *on_hull;
  if (!hull_.supported_by(plane, near)) return false;

  const GrowingHull::Mark mark = hull_.mark();
  std::size_t at = static_cast<std::size_t>(on_hull - corners.begin()) % corners.size();
  const std::size_t rounds =
      hull_.flat() ? 2 : 1;  // corners in the plane of a flat hull wait for one off it
  for (std::size_t i = 0; i < rounds * corners.size(); ++i, at = (at + 1) % corners.size()) {
    if (!hull_.insert(corners[at], near)) {
      hull_.rollback(mark);
      return false;
    }
    if (hull_.has(corners[at])) near = corners[at];
  }
  if (hull_.flat()) return false;
  hull_.mark_real(plane, near);
  return true;
}

bool PatchGrower::enters(std::uint32_t face) {
  const Face& f = mesh_.faces[face];
  return patch_of_face_[face] != id_ &&
         shrunk_.entered_by(position(mesh_, f[0]), position(mesh_, f[1]), position(mesh_, f[2]));
}

/// Constraint 3.
bool PatchGrower::is_clear() {
  shrunk_.build(hull_);
  if (shrunk_.thin() && !fills_convex_polygon(mesh_, edges_, faces_, patch_of_face_, id_))
    return false;
  if (std::any_of(intruders_.begin(), intruders_.end(), [&](std::uint32_t f) { return enters(f); }))
    return false;
  return !tree_.search([&](const FaceBox& box) { return !shrunk_.surely_outside(box); },
                       [&](std::uint32_t face) {
                         if (!enters(face)) return false;
                         if (intruders_.size() == kIntruders) intruders_.pop_back();
                         intruders_.insert(intruders_.begin(), face);
                         return true;
                       });
}

PatchGrower::Checkpoint PatchGrower::checkpoint() const {
  return {members_.size(), faces_.size(), queue_.size(), head_};
}

/// The queue goes on at `head`.
void PatchGrower::take_back(const Checkpoint& checkpoint, std::size_t head) {
  hull_.rollback(0);
  for (std::size_t i = checkpoint.members; i < members_.size(); ++i)
    patch_of_plate_[members_[i]] = kFree;
  for (std::size_t i = checkpoint.faces; i < faces_.size(); ++i) {
    patch_of_face_[faces_[i]] = kFree;
    tree_.show(faces_[i]);
  }
  for (std::size_t i = checkpoint.queue; i < queue_.size(); ++i) seen_by_[queue_[i]] = kFree;
  members_.resize(checkpoint.members);
  faces_.resize(checkpoint.faces);
  queue_.resize(checkpoint.queue);
  head_ = head;
}

void PatchGrower::grow(std::uint32_t seed, std::uint32_t id) {
  assert(is_free(seed));
  id_ = id;
  for (const std::uint32_t f : faces_) tree_.show(f);
  members_.clear();
  faces_.clear();
  queue_.clear();
  intruders_.clear();
  head_ = 0;
  const std::span<const std::uint32_t> corners = plates_.corners_of(seed);
  has_area_ = corners.size() >= 3;
  if (has_area_) hull_.start(corners, true);
  take(seed);
  if (plates_.fixed[seed]) return;

  std::size_t batch = 1;
  Checkpoint valid = checkpoint();
  for (;;) {
    std::size_t after_last = head_;
    while (head_ < queue_.size() && members_.size() - valid.members < batch) {
      const std::uint32_t plate = queue_[head_++];
      if (!fits(plate) || !add_to_hull(plate)) continue;
      take(plate);
      after_last = head_;
    }
    const std::size_t added = members_.size() - valid.members;
    if (added == 0) return;
    if (!hull_.grown() || is_clear()) {
      hull_.commit();
      valid = checkpoint();
      batch = std::min(2 * added, members_.size() / 4 + 1);
    } else if (added > 1) {
      // What was refused since then was so by a patch that is no more: all are tried again.
      take_back(valid, valid.head);
      batch = added / 2;
    } else {
      take_back(valid, after_last);
    }
  }
}

}  // namespace palpate::bake
