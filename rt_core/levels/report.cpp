// SPDX-License-Identifier: Apache-2.0
#include "rt_core/levels/report.hpp"

#include <limits>

#include "rt_core/levels/levels_engine.hpp"
#include "rt_core/levels/probe.hpp"

namespace palpate::levels {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// A normal of this length is that of a contact felt whole: it is rounded to float.
constexpr double kWholeShare = 1 - 1e-6;

/// Nothing less is kept: the normal has to stay a direction.
constexpr double kLeastShare = 1e-6;

Vec3d in_world(const PairState& pair, Vec3d point) noexcept {
  return pair.centre_a_m + pair.rotation_a * (pair.unit_m * point);
}

/// Radius from which pieces are wide, in deltas: within smaller ones a contact's place is as good
/// as another.
constexpr double kWide = 8;
/// Simplified pieces of more vertices are round, and their faces not those of the surface.
constexpr std::uint32_t kMostSimplified = 32;

/// And its hull is surface wherever it is met.
bool is_wide(const image::Piece& piece, double scale, double delta) noexcept {
  return scale * static_cast<double>(piece.radius) >= kWide * delta &&
         !has(piece, image::PieceFlag::back_open) &&
         (!is_simplified(piece) || piece.hull_vertices <= kMostSimplified);
}

}  // namespace

void keep_contact(const PairState& pair, const image::Piece& a, const image::Piece& b,
                  const LeafContact& contact, Node& node) noexcept {
  node.contact = kFound;
  node.witness_a = vec_cast<float>(contact.point_a);
  node.witness_b = vec_cast<float>(to_b(pair, contact.point_b));
  const double share = contact.share > kLeastShare ? contact.share : kLeastShare;
  node.normal = vec_cast<float>(share * contact.normal);
  constexpr double kRoundingUp = 1 + 1e-6;
  node.slack =
      static_cast<float>(kRoundingUp * (pair.scale_a * static_cast<double>(a.surface_deviation) +
                                        pair.scale_b * static_cast<double>(b.surface_deviation)));
}

LeafContact remeasured(const PairState& pair, const Node& node) noexcept {
  LeafContact contact;
  contact.point_a = vec_cast<double>(node.witness_a);
  contact.point_b =
      pair.b_in_a.rotation * vec_cast<double>(node.witness_b) + pair.b_in_a.translation;
  const Vec3d apart = contact.point_a - contact.point_b;
  const Vec3d normal = vec_cast<double>(node.normal);
  const double length = norm(normal);
  contact.found = true;
  contact.normal = (1 / length) * normal;
  contact.share = length < kWholeShare ? length : 1;
  contact.upper_bound = norm(apart);
  const double along = dot(apart, contact.normal);
  const double slid = norm(apart - along * contact.normal);
  const double guess = along >= 0 ? contact.upper_bound : along + slid;
  // Points that have slid past each other may look deep where it is proved that nothing is.
  const double certified = certified_now(pair, node);
  contact.distance = guess < certified ? certified : guess;
  return contact;
}

void Report::note_upper(const PairState& pair, const Node& node,
                        const LeafContact& contact) noexcept {
  const double upper_m = (contact.upper_bound + static_cast<double>(node.slack)) * pair.unit_m;
  if (upper_m < upper_m_) upper_m_ = upper_m;
}

bool Report::add(const PairState& pair, const Node& node, const LeafContact& contact) noexcept {
  note_upper(pair, node, contact);
  if (count_ == contacts_.size()) return false;
  Contact& out = contacts_[count_++];
  out.point_a_m = in_world(pair, contact.point_a);
  out.point_b_m = in_world(pair, contact.point_b);
  out.centre_m = centre_m(pair, node, contact);
  out.normal = pair.rotation_a * contact.normal;
  out.distance_m = contact.distance * pair.unit_m;
  out.share = contact.share;
  out.weight = 0;
  out.pair = node.pair;
  out.piece_a = node.piece_a;
  out.level_a = piece_a(pair, node).level;
  out.piece_b = node.piece_b;
  out.level_b = piece_b(pair, node).level;
  return true;
}

Vec3d Report::centre_m(const PairState& pair, const Node& node,
                       const LeafContact& contact) const noexcept {
  const Vec3d middle = 0.5 * (contact.point_a + contact.point_b);
  const image::Piece& a = piece_a(pair, node);
  const image::Piece& b = piece_b(pair, node);
  convex::PressureCentre centre;
  if (is_wide(a, pair.scale_a, pair.delta) && is_wide(b, pair.scale_b, pair.delta)) {
    const convex::Hull hull_a = hull_of(*pair.image_a, a, pair.scale_a);
    const convex::Hull hull_b = hull_of(*pair.image_b, b, pair.scale_b);
    centre = convex::centre_of_pressure({hull_a, hull_b, pair.b_in_a}, contact.normal,
                                        pair.delta - contact.distance, middle, scratch_);
  }
  return in_world(pair, middle + centre.share * (centre.at - middle));
}

void Report::finish(QueryResult& result) noexcept {
  result.min_distance_m = kInfinity;
  result.upper_m = upper_m_;
  for (const Contact& c : contacts_.first(count_)) {
    if (c.distance_m < result.min_distance_m) result.min_distance_m = c.distance_m;
  }
  result.contacts = count_;
}

}  // namespace palpate::levels
