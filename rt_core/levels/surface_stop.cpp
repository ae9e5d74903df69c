// SPDX-License-Identifier: Apache-2.0
#include "rt_core/levels/surface_stop.hpp"

#include "rt_core/levels/facing.hpp"

namespace palpate::levels {
namespace {

using image::Piece;
using image::Vertex;

/// Corners of a feature of a culling hull.
struct Feature {
  const Vertex* corners[3] = {};
  std::uint32_t count = 0;
};

Feature feature_of(const ImageView& image, const Piece& piece, const std::uint32_t (&vertices)[3],
                   std::uint32_t count) noexcept {
  const Vertex* first = piece.culling_vertices != 0
                            ? image.culling_vertices.data() + piece.first_culling_vertex
                            : image.vertices.data() + piece.first_vertex;
  Feature feature;
  for (std::uint32_t i = 0; i < count; ++i) feature.corners[i] = first + vertices[i];
  feature.count = count;
  return feature;
}

bool same_place(const Vertex& p, const Vertex& q) noexcept {
  return p.position[0] == q.position[0] && p.position[1] == q.position[1] &&
         p.position[2] == q.position[2];
}

bool in_sphere(const Piece& piece, const Feature& feature) noexcept {
  for (std::uint32_t i = 0; i < feature.count; ++i) {
    const float* p = feature.corners[i]->position;
    double square = 0;
    for (int k = 0; k < 3; ++k) {
      const double d = static_cast<double>(p[k]) - static_cast<double>(piece.centre[k]);
      square += d * d;
    }
    // As on_patch: baked points are rounded.
    const double reach = static_cast<double>(piece.radius) + kOnSurface;
    if (square > reach * reach) return false;
  }
  return true;
}

bool triangle_has(const Vertex* vertices, const image::Triangle& triangle,
                  const Feature& feature) noexcept {
  std::uint32_t found = 0;
  for (std::uint32_t i = 0; i < feature.count; ++i) {
    for (const std::uint32_t v : triangle.vertices) {
      if (!same_place(vertices[v], *feature.corners[i])) continue;
      ++found;
      break;
    }
  }
  return found == feature.count;
}

bool patch_has(const ImageView& image, const Piece& piece, const Feature& feature) noexcept {
  const Vertex* vertices = image.vertices.data() + piece.first_vertex;
  for (std::uint32_t i = 0; i < piece.triangles; ++i) {
    if (triangle_has(vertices, image.triangles[piece.first_triangle + i], feature)) return true;
  }
  return false;
}

/// Is the feature a part of one triangle of the original surface below the piece? False too where
/// it was not found within kMaxFeaturePieces.
bool is_original(const ImageView& image, std::uint32_t top, const Feature& feature) noexcept {
  if (feature.count == 1) return true;
  std::uint32_t stack[kMaxFeaturePieces];
  std::uint32_t size = 0;
  stack[size++] = top;
  for (std::uint32_t seen = 0; size > 0 && seen < kMaxFeaturePieces; ++seen) {
    const Piece& piece = image.pieces[stack[--size]];
    if (piece.children == 0 && patch_has(image, piece, feature)) return true;
    for (std::uint32_t c = 0; c < piece.children && size < kMaxFeaturePieces; ++c) {
      if (in_sphere(image.pieces[piece.first_child + c], feature)) {
        stack[size++] = piece.first_child + c;
      }
    }
  }
  return false;
}

/// Its culling hull is spanned by points of the original surface.
bool spans_original(const ImageView& image, const Piece& piece) noexcept {
  return image.header->dropped_levels == 0 &&
         (piece.culling_vertices != 0 || !is_simplified(piece));
}

double residual(const PairState& pair, const Node& node) noexcept {
  return pair.scale_a * static_cast<double>(piece_a(pair, node).culling_residual) +
         pair.scale_b * static_cast<double>(piece_b(pair, node).culling_residual);
}

}  // namespace

bool may_stop_on_surface(const Work& work, const Node& node) noexcept {
  const PairState& pair = work.pair_of(node);
  return work.rules.stop_on_surface && !work.rules.exact && work.rules.bounds == Bounds::tight &&
         spans_original(*pair.image_a, piece_a(pair, node)) &&
         spans_original(*pair.image_b, piece_b(pair, node)) &&
         residual(pair, node) <= kStopResidual * pair.delta;
}

SurfaceStop probe_surface(Work& work, Node& node) noexcept {
  const PairState& pair = work.pair_of(node);
  const bool may_stop = may_stop_on_surface(work, node);
  const convex::Distance d = work.probe.cull(pair, node, may_stop ? Ask::bound : Ask::nearness);
  SurfaceStop out;
  if (!may_stop || d.state != convex::State::separated || d.distance >= pair.delta) {
    return out;
  }
  const Piece& a = piece_a(pair, node);
  const Piece& b = piece_b(pair, node);
  out.stops = is_original(*pair.image_a, node.piece_a,
                          feature_of(*pair.image_a, a, d.vertices_a, d.count_a)) &&
              is_original(*pair.image_b, node.piece_b,
                          feature_of(*pair.image_b, b, d.vertices_b, d.count_b));
  out.contact.found = out.stops;
  out.contact.distance = out.contact.upper_bound = d.distance;
  out.contact.lower_bound = d.lower_bound - residual(pair, node);
  out.contact.point_a = d.point_a;
  out.contact.point_b = d.point_b;
  out.contact.normal = d.normal;
  return out;
}

void keep_on_surface(const PairState& pair, Node& node, const LeafContact& contact) noexcept {
  keep(pair, piece_a(pair, node), piece_b(pair, node), contact, node);
  node.slack = 0;  // the witnesses are on the original surfaces: nothing is missing
  node.s_star = node.excess = 0;
}

}  // namespace palpate::levels
