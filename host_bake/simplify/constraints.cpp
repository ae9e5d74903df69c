// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/simplify/constraints.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "host_bake/decompose/geometry.hpp"
#include "host_bake/hull/predicates.hpp"
#include "host_bake/mesh/crossings.hpp"

namespace palpate::bake {
namespace {

// Of a patch that is not much larger than a ring.
constexpr std::size_t kSmallPatch = 24;

int side(const Corners& plane, const PointF& p) {
  if (p == plane[0] || p == plane[1] || p == plane[2]) return 0;
  return orient_3d(plane[0], plane[1], plane[2], p);
}

Vec3d normal_of(const Corners& c) {
  const Vec3d a = position(c[0]);
  return cross(position(c[1]) - a, position(c[2]) - a);
}

/// All corners of b that are not corners of a lie strictly on one side of a's plane.
bool apart(const Corners& a, const Corners& b) {
  int seen = 0;
  for (const PointF& p : b) {
    if (p == a[0] || p == a[1] || p == a[2]) continue;
    const int s = orient_3d(a[0], a[1], a[2], p);
    if (s == 0 || s == -seen) return false;
    seen = s;
  }
  return seen != 0;
}

bool cross_each_other(const Corners& a, const Corners& b) {
  if (apart(a, b) || apart(b, a)) return false;
  const auto exact = [](const Corners& c) {
    std::array<Point, 3> out{};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k) out[i][k] = static_cast<double>(c[i][k]);
    return out;
  };
  return triangles_cross(exact(a), exact(b));
}

FaceBox box_of(const Corners& c) { return palpate::bake::box_of(c[0], c[1], c[2]); }

}  // namespace

const char* name_of(Refusal refusal) {
  constexpr std::array<const char*, kRefusals> kNames = {
      "none",     "link",       "frozen", "local",      "flip",
      "rounding", "visibility", "hull",   "other hull", "crossing"};
  return kNames[static_cast<std::size_t>(refusal)];
}

Constraints::Constraints(const Surface& surface, const PatchLists& patches)
    : surface_(surface),
      patches_(patches),
      gatherer_(surface),
      faces_(surface.faces.size()),
      boxes_(patches.count()),
      near_faces_(faces_),
      bodies_(patches, gatherer_, builder_) {
  for (std::uint32_t f = 0; f < surface.faces.size(); ++f) faces_.put(f, box_of(corners(f)));
  for (std::uint32_t p = 0; p < patches.count(); ++p) {
    const std::array<std::uint32_t, 1> one = {p};
    gatherer_.gather(patches_, one, nullptr, merged_.shape);
    place(p, palpate::bake::box_of(merged_.shape.points));
  }
}

void Constraints::place(std::uint32_t patch, const FaceBox& box) {
  // Single faces have hulls without interior: nothing can enter them.
  if (patches_.size(patch) > 1) {
    boxes_.put(patch, box);
  } else {
    boxes_.take(patch);
  }
}

Corners Constraints::corners_after(std::size_t ring_face) const {
  return {position_, surface_.points[ring_->left(ring_face)],
          surface_.points[ring_->right(ring_face)]};
}

Corners Constraints::corners(std::uint32_t face) const {
  const Face& f = surface_.faces[face];
  return {surface_.points[f[0]], surface_.points[f[1]], surface_.points[f[2]]};
}

bool Constraints::is_affected(std::uint32_t patch) const {
  for (std::size_t i = 0; i < affected_count_; ++i)
    if (affected_[i].shape.patch == patch) return true;
  return false;
}

void Constraints::begin(const Ring& ring) {
  for (std::size_t i = 0; i < affected_count_; ++i)
    if (OuterHull* outer = bodies_.known_growing(affected_[i].shape.patch)) outer->take_back();
  ring_ = &ring;
  affected_count_ = 0;
  const auto add = [this](std::uint32_t half_edge) {
    if (half_edge == kNothing) return;
    const std::uint32_t patch = patches_.of(half_edge / 3);
    if (is_affected(patch)) return;
    if (affected_.size() == affected_count_) affected_.emplace_back();
    affected_[affected_count_++].shape.patch = patch;
  };
  for (const std::uint32_t s : ring.spokes) add(s);
  add(ring.edge);
  add(ring.twin);
  for (std::size_t i = 0; i < affected_count_; ++i) {
    Affected& a = affected_[i];
    const std::uint32_t patch = a.shape.patch;
    a.kind = HullKind::unknown;
    a.closed = patches_.closed(patch);
    a.within = false;
    if (a.closed) continue;
    const std::array<std::uint32_t, 1> one = {patch};
    gatherer_.gather(patches_, one, &ring, a.shape);
    a.planes.set(a.shape);
  }
  near_faces_.move_to(place_of_hulls());
}

/// Where most of the searches for a collapse will be: about its ring and the patches there.
FaceBox Constraints::place_of_hulls() const {
  FaceBox place = palpate::bake::box_of({});
  for (const std::uint32_t v : ring_->vertices) place.add(surface_.points[v]);
  for (std::size_t i = 0; i < affected_count_; ++i) {
    const Affected& a = affected_[i];
    if (a.closed || a.shape.points.size() > kSmallPatch) continue;
    for (const PointF& p : a.shape.points) place.add(p);
  }
  return place;
}

Refusal Constraints::judge(const PointF& position) {
  position_ = position;
  if (const Refusal r = judge_faces(); r != Refusal::none) return r;
  if (const Refusal r = judge_edges(); r != Refusal::none) return r;
  for (std::size_t i = 0; i < affected_count_; ++i) {
    Affected& a = affected_[i];
    if (a.closed || a.shape.apex == kNothing) continue;
    a.shape.points[a.shape.apex] = position;
    a.planes.move(a.shape.apex, position);
    if (visible(a)) return Refusal::visibility;
  }
  for (std::size_t i = 0; i < affected_count_; ++i)
    if (hull_is_entered(affected_[i])) return Refusal::hull;
  set_star();
  if (enters_others()) return Refusal::other_hull;
  return crosses() ? Refusal::crossing : Refusal::none;
}

Refusal Constraints::judge_faces() const {
  for (std::size_t i = 0; i < ring_->faces(); ++i) {
    const Corners now = corners_after(i);
    if (now[0] == now[1] || now[0] == now[2] || collinear(now[0], now[1], now[2]))
      return Refusal::flip;
    const std::uint32_t f = ring_->spokes[i] / 3;
    const Vec3d before = normal_of(corners(f));
    if (squared_norm(before) > 0 && !(dot(before, normal_of(now)) > 0)) return Refusal::flip;
  }
  return Refusal::none;
}

/// Eq. 2 on rounded positions, exactly; coplanar neighbours must not be folded onto each other.
Refusal Constraints::judge_edges() const {
  const Ring& ring = *ring_;
  const auto reflex = [](const Corners& a, const Corners& b, const PointF& apex_of_b) {
    const int s = side(a, apex_of_b);
    return s > 0 || (s == 0 && dot(normal_of(a), normal_of(b)) < 0);
  };
  for (std::size_t i = 0; i < ring.faces(); ++i) {
    const std::uint32_t patch = patches_.of(ring.spokes[i] / 3);
    const Corners here = corners_after(i);
    if (ring.far[i] != kNothing && patches_.of(ring.far[i] / 3) == patch &&
        reflex(corners(ring.far[i] / 3), here, position_))
      return Refusal::rounding;
    if (i == 0 && !ring.closed) continue;
    const std::size_t before = i == 0 ? ring.faces() - 1 : i - 1;
    if (patches_.of(ring.spokes[before] / 3) == patch &&
        reflex(here, corners_after(before), surface_.points[ring.left(before)]))
      return Refusal::rounding;
  }
  return Refusal::none;
}

/// Some vertex is strictly above a face, and one of the two is new.
bool Constraints::visible(const Affected& affected) const {
  const PatchShape& shape = affected.shape;
  const auto points = static_cast<std::uint32_t>(shape.points.size());
  for (std::uint32_t f = 0; f < shape.faces.size(); ++f) {
    if (shape.changed[f]) {
      if (affected.planes.any_above(shape, f, 0, points)) return true;
    } else if (affected.planes.above(shape, f, shape.apex)) {
      return true;
    }
  }
  return false;
}

/// The face is alive, and the collapse leaves it as it is.
bool Constraints::stays(std::uint32_t face) const {
  if (!surface_.alive(face) || face == ring_->edge / 3 || face == ring_->twin / 3) return false;
  const Face& corners = surface_.faces[face];
  return std::none_of(corners.begin(), corners.end(),
                      [this](std::uint32_t v) { return v == ring_->kept || v == ring_->removed; });
}

/// As BoxTree::search(), for faces that stay as they are.
template <class Visit>
bool Constraints::search_unchanged(const FaceBox& box, Visit visit) {
  return near_faces_.search(
      box, [this](std::uint32_t f) { return stays(f); }, visit);
}

bool Constraints::entered_by_unchanged(std::uint32_t patch, ShrunkHull& hull, const FaceBox& box) {
  return search_unchanged(
      box, [&](std::uint32_t f) { return patches_.of(f) != patch && enters(hull, corners(f)); });
}

/// The patch stays convex all over, so the hull grows by no more than that of the new vertex and
/// its ring.
bool Constraints::grown_part_is_entered(Affected& affected) {
  std::vector<PointF> points = {position_};
  for (const std::uint32_t v : ring_->vertices) points.push_back(surface_.points[v]);
  if (builder_.build(points, affected.hull) == HullKind::empty) return false;
  return entered_by_unchanged(affected.shape.patch, affected.hull, palpate::bake::box_of(points));
}

/// The new vertex is in the hull known before, so nothing but changed faces of others can enter the
/// new one. False decides nothing.
bool Constraints::stays_within(const Affected& affected) {
  const std::uint32_t patch = affected.shape.patch;
  ShrunkHull* hull = bodies_.known(patch);
  if (hull == nullptr || hull->thin() || !hull->holds(palpate::bake::position(position_)))
    return false;
  for (std::size_t i = 0; i < ring_->faces(); ++i)
    if (patches_.of(ring_->spokes[i] / 3) != patch && enters(*hull, corners_after(i))) return false;
  return true;
}

/// A face enters the body about the new hull: does it enter that hull?
Entry Constraints::admit(const PatchShape& shape, std::uint32_t face, const Corners& at) {
  if (!lazy_started_) {
    near_.clear();
    for (std::uint32_t f = 0; f < shape.faces.size(); ++f)
      if (shape.changed[f])
        near_.insert(near_.end(), shape.corners[f].begin(), shape.corners[f].end());
    lazy_.start(shape.points, near_);
    lazy_started_ = true;
  }
  const Entry entry = lazy_.entered_by(at);
  if (entry == Entry::no) bodies_.known_growing(shape.patch)->admit(face, lazy_.keepers());
  return entry;
}

/// The body known before grows by the new vertex. What enters the body is asked whether it enters
/// the new hull: changed faces, guests that the new vertex may have reached, and what is where the
/// body grows.
Entry Constraints::large_hull_is_entered(const Affected& affected) {
  const PatchShape& shape = affected.shape;
  const std::uint32_t patch = shape.patch;
  OuterHull* outer = bodies_.growing(patch);
  if (outer == nullptr) return Entry::unknown;
  lazy_started_ = false;
  OuterHull::Part* part = outer->grow(position_, builder_);
  for (std::size_t i = 0; i < ring_->faces(); ++i) {
    const std::uint32_t face = ring_->spokes[i] / 3;
    const Corners now = corners_after(i);
    if (patches_.of(face) == patch || !bodies_.body_entered_by(patch, now)) continue;
    if (const Entry entry = admit(shape, face, now); entry != Entry::no) return entry;
  }
  for (const OuterHull::Guest& guest : outer->guests()) {
    if (guest.stays_out(position_) || !stays(guest.face) || patches_.of(guest.face) == patch)
      continue;
    if (const Entry entry = admit(shape, guest.face, corners(guest.face)); entry != Entry::no)
      return entry;
  }
  Entry entry = Entry::no;
  if (part != nullptr)
    search_unchanged(part->grown, [&](std::uint32_t f) {
      if (patches_.of(f) != patch && enters(part->hull, corners(f)))
        entry = admit(shape, f, corners(f));
      return entry != Entry::no;
    });
  return entry;
}

bool Constraints::hull_is_entered(Affected& affected) {
  const PatchShape& shape = affected.shape;
  affected.within = false;
  if (affected.closed) return grown_part_is_entered(affected);
  if (shape.faces.empty()) return false;
  OuterHull* outer = bodies_.known_growing(shape.patch);
  if (outer != nullptr) outer->take_back();
  if (clearly_solid(shape.points)) {  // else it must fill a polygon
    Entry entry = Entry::unknown;
    if (outer != nullptr || PatchBodies::is_large(shape.faces.size())) {
      entry = large_hull_is_entered(affected);
    } else if (stays_within(affected)) {
      entry = Entry::no;
    }
    affected.within = entry == Entry::no;
    if (entry != Entry::unknown) return entry == Entry::yes;
  }
  FaceBox grown;
  affected.kind = builder_.build(shape, ring_, gatherer_, affected.hull, grown);
  if (affected.kind == HullKind::empty) return false;
  if (affected.kind == HullKind::refused) return true;
  for (std::size_t i = 0; i < ring_->faces(); ++i)
    if (patches_.of(ring_->spokes[i] / 3) != shape.patch && enters(affected.hull, corners_after(i)))
      return true;
  return entered_by_unchanged(affected.shape.patch, affected.hull, grown);
}

/// The changed faces, and a box about them all.
void Constraints::set_star() {
  star_.clear();
  star_box_ = palpate::bake::box_of(position_, position_, position_);
  for (std::size_t i = 0; i < ring_->faces(); ++i) {
    const Corners now = corners_after(i);
    star_.push_back({now, box_of(now), patches_.of(ring_->spokes[i] / 3)});
    for (const PointF& p : now) star_box_.add(p);
  }
}

bool Constraints::enters_others() {
  return boxes_.search(star_box_, [&](std::uint32_t patch) {
    if (is_affected(patch) || patches_.closed(patch)) return false;
    const FaceBox& box = boxes_.box(patch);
    return std::any_of(star_.begin(), star_.end(), [&](const StarFace& face) {
      if (!face.box.meets(box)) return false;
      return bodies_.entered_by(patch, face.corners);
    });
  });
}

bool Constraints::crosses() {
  for (std::size_t i = 1; i < star_.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (star_[i].patch != star_[j].patch && cross_each_other(star_[i].corners, star_[j].corners))
        return true;
  return search_unchanged(star_box_, [&](std::uint32_t f) {
    const FaceBox& box = faces_.box(f);
    return std::any_of(star_.begin(), star_.end(), [&](const StarFace& face) {
      return face.patch != patches_.of(f) && face.box.meets(box) &&
             cross_each_other(face.corners, corners(f));
    });
  });
}

void Constraints::follow_collapse() {
  for (const std::uint32_t e : {ring_->edge, ring_->twin})
    if (e != kNothing) faces_.take(e / 3);
  for (const std::uint32_t s : ring_->spokes) faces_.put(s / 3, box_of(corners(s / 3)));
  for (std::size_t i = 0; i < affected_count_; ++i) {
    Affected& a = affected_[i];
    const std::uint32_t patch = a.shape.patch;
    if (a.closed) {
      FaceBox box = boxes_.box(patch);  // may be too large from now on, never too small
      box.add(position_);
      place(patch, box);
      continue;
    }
    if (a.shape.faces.empty()) {
      boxes_.take(patch);
      bodies_.forget(patch);
      continue;
    }
    place(patch, palpate::bake::box_of(a.shape.points));
    if (a.within) {
      bodies_.keep(patch);
    } else {
      bodies_.set(patch, a.kind, a.shape.faces.size(), a.hull);
    }
  }
}

}  // namespace palpate::bake
