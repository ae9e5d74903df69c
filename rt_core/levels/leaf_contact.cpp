// SPDX-License-Identifier: Apache-2.0
#include "rt_core/levels/leaf_contact.hpp"

#include <limits>

#include "rt_core/levels/facing.hpp"
#include "rt_core/levels/rules.hpp"

namespace palpate::levels {
namespace {

using image::Piece;
using image::PieceFlag;
using image::Triangle;

/// Is every one of the hull vertices a corner of the triangle?
bool holds(const Triangle& t, const std::uint32_t (&vertices)[3], std::uint32_t count) noexcept {
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t v = vertices[k];
    if (v != t.vertices[0] && v != t.vertices[1] && v != t.vertices[2]) return false;
  }
  return true;
}

/// Is a point (piece coordinates) that combines `count` hull vertices on the patch of the piece?
bool on_patch(const ImageView& image, const Piece& piece, Vec3d point, const std::uint32_t (&of)[3],
              std::uint32_t count) noexcept {
  if (count == 1 || has(piece, PieceFlag::all_real))
    return true;  // hull vertices are vertices of the mesh
  const Triangle* triangles = image.triangles.data() + piece.first_triangle;
  for (std::uint32_t i = 0; i < piece.triangles; ++i) {
    if (holds(triangles[i], of, count)) return true;
  }
  // Faces of the hull may be cut into other triangles than the patch is.
  return levels::on_patch(image, piece, point);
}

/// One piece as a run of convex parts: its hull, or the triangles of its patch.
struct Parts {
  const ImageView* image = nullptr;
  const Piece* piece = nullptr;
  double scale = 1;
  bool triangles = false;
  std::uint32_t count = 1;
};

Parts parts_of(const ImageView& image, const Piece& piece, double scale,
               bool by_triangle) noexcept {
  return {&image, &piece, scale, by_triangle, by_triangle ? piece.triangles : 1};
}

convex::Hull part(const Parts& parts, std::uint32_t i, image::Vertex (&storage)[3]) noexcept {
  if (!parts.triangles) return hull_of(*parts.image, *parts.piece, parts.scale);
  const Triangle& t = parts.image->triangles[parts.piece->first_triangle + i];
  const image::Vertex* vertices = parts.image->vertices.data() + parts.piece->first_vertex;
  for (int k = 0; k < 3; ++k) storage[k] = vertices[t.vertices[k]];
  convex::Hull hull;
  hull.vertices = storage;
  hull.count = 3;
  hull.scale = parts.scale;
  return hull;
}

bool witness_a_real(const PairState& pair, const Piece& a, const convex::Distance& d) noexcept {
  return on_patch(*pair.image_a, a, (1.0 / pair.scale_a) * d.point_a, d.vertices_a, d.count_a);
}

bool witness_b_real(const PairState& pair, const Piece& b, const convex::Distance& d) noexcept {
  return on_patch(*pair.image_b, b, (1.0 / pair.scale_b) * to_b(pair, d.point_b), d.vertices_b,
                  d.count_b);
}

LeafContact from_distance(const convex::Distance& d) noexcept {
  LeafContact contact;
  contact.found = true;
  contact.distance = contact.upper_bound = d.distance;
  contact.lower_bound = d.lower_bound;
  contact.point_a = d.point_a;
  contact.point_b = d.point_b;
  contact.normal = d.normal;
  contact.capped = d.state == convex::State::gave_up;
  return contact;
}

/// How far parts reach along a direction, so that most pairs of parts are told apart without a
/// query.
struct Extents {
  double least[image::kMaxOpenPatchTriangles] = {};
  double most[image::kMaxOpenPatchTriangles] = {};
};

/// `direction` and `offset` in the coordinates of the parts' body.
Extents extents_of(const Parts& parts, Vec3d direction, double offset) noexcept {
  Extents extents;
  image::Vertex storage[3];
  for (std::uint32_t i = 0; i < parts.count; ++i) {
    const convex::Hull hull = part(parts, i, storage);
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (std::uint32_t k = 0; k < hull.count; ++k) {
      const double along = offset + dot(direction, hull.scale * vec3d(hull.vertices[k].position));
      least = along < least ? along : least;
      most = along > most ? along : most;
    }
    extents.least[i] = least;
    extents.most[i] = most;
  }
  return extents;
}

/// The nearest pair of real surface of two patches of which at least one has no inside. found is
/// false where none is within reach, or where the triangles cross (distance 0): then the hulls tell
/// depth and direction. Nothing is left out but where most_queries end it.
LeafContact nearest_parts(const PairState& pair, const Piece& a, const Piece& b, Vec3d normal,
                          double reach, std::uint32_t most_queries, bool& out_crossing) noexcept {
  const Parts parts_a = parts_of(*pair.image_a, a, pair.scale_a, has(a, PieceFlag::back_open));
  const Parts parts_b = parts_of(*pair.image_b, b, pair.scale_b, has(b, PieceFlag::back_open));
  const Extents extents_a = extents_of(parts_a, normal, 0);
  const Extents extents_b = extents_of(parts_b, transpose(pair.b_in_a.rotation) * normal,
                                       dot(normal, pair.b_in_a.translation));
  image::Vertex storage_a[3];
  image::Vertex storage_b[3];
  LeafContact best;
  best.distance = reach;
  best.lower_bound = reach;
  std::uint32_t queries = 0;
  bool interrupted = false;
  out_crossing = false;
  for (std::uint32_t i = 0; i < parts_a.count; ++i) {
    const convex::Hull hull_a = part(parts_a, i, storage_a);
    for (std::uint32_t j = 0; j < parts_b.count; ++j) {
      if (extents_a.least[i] - extents_b.most[j] >= best.distance) continue;
      if (queries == most_queries) {
        interrupted = true;
        break;
      }
      const convex::Hull hull_b = part(parts_b, j, storage_b);
      convex::Cache cold;
      const convex::Distance d =
          convex::distance(hull_a, hull_b, pair.b_in_a, {.above = best.distance}, cold);
      ++queries;
      if (convex::overlaps(d)) out_crossing = true;
      if (d.distance >= best.distance) continue;
      if (!parts_a.triangles && !witness_a_real(pair, a, d)) continue;
      if (!parts_b.triangles && !witness_b_real(pair, b, d)) continue;
      best = from_distance(d);
    }
  }
  best.queries = queries;
  best.interrupted = interrupted;
  return best;
}

LeafContact overlapping(const PairState& pair, const Piece& a, const Piece& b,
                        const convex::Cache& cache, convex::PenetrationScratch& scratch) noexcept {
  const convex::Penetration p =
      convex::penetration(hull_of(*pair.image_a, a, pair.scale_a),
                          hull_of(*pair.image_b, b, pair.scale_b), pair.b_in_a, cache, scratch);
  LeafContact contact;
  contact.found = true;
  contact.distance = contact.lower_bound = contact.upper_bound = -p.depth;
  contact.share = facing(pair, a, b, p.normal);
  contact.normal = p.normal;
  contact.point_a = p.point_a;
  contact.point_b = p.point_b;
  contact.capped = !p.exact;
  return contact;
}

}  // namespace

LeafContact leaf_contact(const PairState& pair, const Piece& a, const Piece& b,
                         const convex::Distance& query, const convex::Cache& cache, double reach,
                         std::uint32_t most_queries, convex::PenetrationScratch& scratch) noexcept {
  const bool overlap = convex::overlaps(query);
  const bool virtual_a = overlap ? !has(a, PieceFlag::all_real) : !witness_a_real(pair, a, query);
  const bool virtual_b = overlap ? !has(b, PieceFlag::all_real) : !witness_b_real(pair, b, query);
  const bool exposed =
      (virtual_a && has(a, PieceFlag::back_open)) || (virtual_b && has(b, PieceFlag::back_open));
  if (exposed) {
    bool crossing = false;
    const Vec3d normal = overlap ? Vec3d{} : query.normal;
    const LeafContact nearest = nearest_parts(pair, a, b, normal, reach, most_queries, crossing);
    if (!crossing) return nearest;
    LeafContact contact = overlapping(pair, a, b, cache, scratch);
    contact.queries = nearest.queries;
    return contact;
  }
  if (overlap) return overlapping(pair, a, b, cache, scratch);
  if (virtual_a || virtual_b) return {.hidden_a = virtual_a, .hidden_b = virtual_b};
  LeafContact contact = from_distance(query);
  contact.share = facing(pair, a, b, contact.normal);
  return contact;
}

}  // namespace palpate::levels
