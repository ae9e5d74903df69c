// SPDX-License-Identifier: Apache-2.0
// Valid images in memory, without the baker: leaves as given, boxes merged two by two above them.
//
//   const AlignedBytes bytes = seal(parts_of({box_part({0, 0, 0}, {0.5f, 0.5f, 0.5f})}));
//   ImageView view;
//   ASSERT_EQ(validate(bytes, view), Status::ok);
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <new>
#include <set>
#include <span>
#include <vector>

#include "rt_core/image/view.hpp"

namespace palpate::test {

template <class T>
struct AlignedAllocator {
  using value_type = T;
  AlignedAllocator() = default;
  template <class U>
  explicit AlignedAllocator(const AlignedAllocator<U>&) {}
  T* allocate(std::size_t n) {
    return static_cast<T*>(::operator new (n * sizeof(T), std::align_val_t{image::kAlignment}));
  }
  void deallocate(T* p, std::size_t) { ::operator delete (p, std::align_val_t{image::kAlignment}); }
  bool operator==(const AlignedAllocator&) const { return true; }
};

/// Exactly as many bytes as it says, on a 64-byte boundary: the address sanitizer sees one byte too
/// far.
using AlignedBytes = std::vector<std::byte, AlignedAllocator<std::byte>>;

using PointF = std::array<float, 3>;
using Corners = std::array<std::uint32_t, 3>;

/// A leaf: the hull of its points, which must all be extreme and lie in the unit ball. Faces are
/// counter-clockwise seen from outside and index the points; together they close the hull, unless
/// the part is flat (then one side of it will do).
struct Part {
  std::vector<PointF> points;
  std::vector<Corners> triangles;      ///< of the surface
  std::vector<Corners> virtual_faces;  ///< of the hull alone
  bool back_open = false;
};

/// An image before it is laid out: everything but sections, total_bytes and the hash.
struct ImageParts {
  image::Header header{};
  std::vector<image::Level> levels;
  std::vector<image::Piece> pieces;
  std::vector<image::Vertex> vertices;
  std::vector<std::uint32_t> neighbour_starts;
  std::vector<std::uint32_t> neighbours;
  std::vector<image::Triangle> triangles;
  std::vector<image::VirtualFace> virtual_faces;
  std::vector<image::Vertex> culling_vertices;
};

inline constexpr std::array<Corners, 12> kBoxFaces = {{{0, 2, 1},
                                                       {1, 2, 3},
                                                       {4, 5, 6},
                                                       {5, 7, 6},
                                                       {0, 1, 4},
                                                       {1, 5, 4},
                                                       {2, 6, 3},
                                                       {3, 6, 7},
                                                       {0, 4, 2},
                                                       {2, 4, 6},
                                                       {1, 3, 5},
                                                       {3, 7, 5}}};

inline std::vector<PointF> box_points(PointF low, PointF high) {
  std::vector<PointF> points;
  for (unsigned i = 0; i < 8; ++i) {
    points.push_back({(i & 1) != 0 ? high[0] : low[0], (i & 2) != 0 ? high[1] : low[1],
                      (i & 4) != 0 ? high[2] : low[2]});
  }
  return points;
}

/// A closed box, 12 triangles.
inline Part box_part(PointF centre, PointF half) {
  const PointF low{centre[0] - half[0], centre[1] - half[1], centre[2] - half[2]};
  const PointF high{centre[0] + half[0], centre[1] + half[1], centre[2] + half[2]};
  return {box_points(low, high), {kBoxFaces.begin(), kBoxFaces.end()}, {}};
}

/// One triangle, flat.
inline Part triangle_part(PointF a, PointF b, PointF c) { return {{a, b, c}, {{0, 1, 2}}, {}}; }

/// A tetrahedron whose last face is not of the surface.
inline Part tetrahedron_part() {
  return {{{0.5f, 0.5f, 0.5f}, {0.5f, -0.5f, -0.5f}, {-0.5f, 0.5f, -0.5f}, {-0.5f, -0.5f, 0.5f}},
          {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}},
          {{1, 3, 2}}};
}

/// A closed convex body of 2 + rings * segments vertices on a sphere about the origin.
inline Part ball_part(float radius, unsigned rings, unsigned segments) {
  constexpr double kPi = 3.14159265358979323846;
  Part part;
  part.points.push_back({0, 0, radius});
  for (unsigned r = 1; r <= rings; ++r) {
    const double polar = kPi * r / (rings + 1);
    for (unsigned s = 0; s < segments; ++s) {
      const double turn = 2 * kPi * s / segments;
      const auto at = [&](double v) { return static_cast<float>(static_cast<double>(radius) * v); };
      part.points.push_back({at(std::sin(polar) * std::cos(turn)),
                             at(std::sin(polar) * std::sin(turn)), at(std::cos(polar))});
    }
  }
  part.points.push_back({0, 0, -radius});
  const auto south = static_cast<std::uint32_t>(part.points.size() - 1);
  const auto index = [&](unsigned r, unsigned s) { return 1 + r * segments + s % segments; };
  for (unsigned s = 0; s < segments; ++s) {
    part.triangles.push_back({0, index(0, s), index(0, s + 1)});
    for (unsigned r = 0; r + 1 < rings; ++r) {
      part.triangles.push_back({index(r, s), index(r + 1, s), index(r + 1, s + 1)});
      part.triangles.push_back({index(r, s), index(r + 1, s + 1), index(r, s + 1)});
    }
    part.triangles.push_back({south, index(rings - 1, s + 1), index(rings - 1, s)});
  }
  return part;
}

namespace tiny {

inline constexpr float kResolution = 1.0f;
inline constexpr float kSupportArea = 0.25f;

/// A node of the merge tree, before the pieces are put in order.
struct Node {
  Part hull;
  std::uint32_t level = 0;
  std::vector<std::size_t> children;
};

inline Node merge(const std::vector<Node>& nodes, std::vector<std::size_t> children,
                  std::uint32_t level) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  PointF low{kInfinity, kInfinity, kInfinity};
  PointF high{-kInfinity, -kInfinity, -kInfinity};
  for (const std::size_t child : children) {
    for (const PointF& p : nodes[child].hull.points) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], p[axis]);
        high[axis] = std::max(high[axis], p[axis]);
      }
    }
  }
  return {{box_points(low, high), {}, {}}, level, std::move(children)};
}

/// Leaves first, the root last; an odd one out stays for the next round.
inline std::vector<Node> merge_all(const std::vector<Part>& leaves) {
  std::vector<Node> nodes;
  std::vector<std::size_t> round;
  for (const Part& leaf : leaves) {
    round.push_back(nodes.size());
    nodes.push_back({leaf, 0, {}});
  }
  for (std::uint32_t level = 1; round.size() > 1; ++level) {
    std::vector<std::size_t> next;
    for (std::size_t i = 0; i + 1 < round.size(); i += 2) {
      next.push_back(nodes.size());
      nodes.push_back(merge(nodes, {round[i], round[i + 1]}, level));
    }
    if (round.size() % 2 == 1) next.push_back(round.back());
    round = next;
  }
  return nodes;
}

inline void put_sphere(image::Piece& piece, const std::vector<PointF>& points) {
  std::array<double, 3> mean{};
  for (const PointF& p : points) {
    for (std::size_t axis = 0; axis < 3; ++axis) mean[axis] += static_cast<double>(p[axis]);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    piece.centre[axis] = static_cast<float>(mean[axis] / static_cast<double>(points.size()));
  }
  double most = 0;
  for (const PointF& p : points) {
    double squared = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double d = static_cast<double>(p[axis]) - static_cast<double>(piece.centre[axis]);
      squared += d * d;
    }
    most = std::max(most, std::sqrt(squared));
  }
  piece.radius = std::nextafter(static_cast<float>(most), std::numeric_limits<float>::infinity());
}

inline void put_adjacency(ImageParts& out, image::Piece& piece, const Part& hull) {
  std::vector<std::set<std::uint32_t>> lists(hull.points.size());
  for (const auto* faces : {&hull.triangles, &hull.virtual_faces}) {
    for (const Corners& f : *faces) {
      for (std::size_t i = 0; i < 3; ++i) lists[f[i]].insert({f[(i + 1) % 3], f[(i + 2) % 3]});
    }
  }
  piece.first_neighbour_start = static_cast<std::uint32_t>(out.neighbour_starts.size());
  piece.first_neighbour = static_cast<std::uint32_t>(out.neighbours.size());
  for (const auto& list : lists) {
    out.neighbour_starts.push_back(static_cast<std::uint32_t>(out.neighbours.size()) -
                                   piece.first_neighbour);
    out.neighbours.insert(out.neighbours.end(), list.begin(), list.end());
    out.header.max_valence =
        std::max(out.header.max_valence, static_cast<std::uint32_t>(list.size()));
  }
  out.neighbour_starts.push_back(static_cast<std::uint32_t>(out.neighbours.size()) -
                                 piece.first_neighbour);
}

inline void put_faces(ImageParts& out, image::Piece& piece, const Part& hull) {
  piece.triangles = static_cast<std::uint32_t>(hull.triangles.size());
  if (piece.triangles > 0) {
    piece.first_triangle = static_cast<std::uint32_t>(out.triangles.size());
    piece.flags |=
        hull.virtual_faces.empty() ? static_cast<std::uint32_t>(image::PieceFlag::all_real) : 0u;
  }
  for (const Corners& f : hull.triangles) {
    out.triangles.push_back({{f[0], f[1], f[2]}, static_cast<std::uint32_t>(out.triangles.size())});
  }
  piece.virtual_faces = static_cast<std::uint32_t>(hull.virtual_faces.size());
  if (piece.virtual_faces > 0) {
    piece.first_virtual_face = static_cast<std::uint32_t>(out.virtual_faces.size());
  }
  for (const Corners& f : hull.virtual_faces) out.virtual_faces.push_back({{f[0], f[1], f[2]}});
  if (hull.back_open) piece.flags |= static_cast<std::uint32_t>(image::PieceFlag::back_open);
}

inline image::Piece put_piece(ImageParts& out, const Node& node) {
  image::Piece piece{};
  piece.level = node.level;
  piece.resolution = node.level == 0 ? kResolution : 0.0f;
  piece.first_child = piece.parent = image::kNone;
  piece.first_neighbour_start = piece.first_neighbour = image::kNone;
  piece.first_triangle = piece.first_virtual_face = piece.first_culling_vertex = image::kNone;
  piece.children = static_cast<std::uint32_t>(node.children.size());
  piece.first_vertex = static_cast<std::uint32_t>(out.vertices.size());
  piece.vertices = piece.hull_vertices = static_cast<std::uint32_t>(node.hull.points.size());
  piece.min_support_area = kSupportArea;
  put_sphere(piece, node.hull.points);
  for (const PointF& p : node.hull.points) {
    out.vertices.push_back({{p[0], p[1], p[2]}, piece.min_support_area});
  }
  if (piece.hull_vertices > image::kAdjacencyAbove) put_adjacency(out, piece, node.hull);
  put_faces(out, piece, node.hull);
  return piece;
}

inline void put_levels(ImageParts& out) {
  out.levels.resize(out.pieces[0].level + 1);
  for (std::uint32_t i = 0; i < out.levels.size(); ++i) {
    image::Level& level = out.levels[i];
    level.free = i > 0 ? 1 : 0;
    level.min_support_area_rel = kSupportArea;
    level.resolution = i == 0 ? kResolution : 0.0f;
    for (const image::Piece& p : out.pieces) {
      const bool ended = p.parent != image::kNone && out.pieces[p.parent].level <= i;
      level.pieces += p.level <= i && !ended ? 1 : 0;
    }
  }
  out.levels[0].triangles = out.header.source_triangles;
  out.header.free_levels = static_cast<std::uint32_t>(out.levels.size() - 1);
}

inline std::uint32_t depth(const ImageParts& parts) {
  std::uint32_t most = 0;
  for (const image::Piece& piece : parts.pieces) {
    std::uint32_t steps = 1;
    for (std::uint32_t p = piece.parent; p != image::kNone; p = parts.pieces[p].parent) ++steps;
    most = std::max(most, steps);
  }
  return most;
}

inline void put_header(ImageParts& out, std::size_t leaves, double radius_m) {
  image::Header& h = out.header;
  std::copy(std::begin(image::kMagic), std::end(image::kMagic), h.magic);
  h.format_major = image::kFormatMajor;
  h.format_minor = image::kFormatMinor;
  h.byte_order_mark = image::kByteOrderMark;
  h.header_bytes = sizeof(image::Header);
  h.radius_m = radius_m;
  h.delta_rel = 0.01f;
  h.source_triangles = static_cast<std::uint32_t>(out.triangles.size());
  h.source_vertices = static_cast<std::uint32_t>(out.vertices.size());
  h.source_components = 1;
  h.leaf_pieces = static_cast<std::uint32_t>(leaves);
  for (const image::Piece& p : out.pieces) {
    h.max_children = std::max(h.max_children, p.children);
    h.max_hull_vertices = std::max(h.max_hull_vertices, p.hull_vertices);
    h.max_patch_triangles = std::max(h.max_patch_triangles, p.triangles);
  }
  h.tree_depth = depth(out);
}

}  // namespace tiny

/// At least one leaf; where there are more, the corners of their common box must lie in the unit
/// ball, for the boxes above the leaves have them. Level 0 is exact (s = h = 0); every support area
/// is 0.25.
inline ImageParts parts_of(const std::vector<Part>& leaves, double radius_m = 1.0) {
  const std::vector<tiny::Node> nodes = tiny::merge_all(leaves);
  ImageParts out;
  // Breadth first: a node's children are put at the end of the queue, so siblings are contiguous.
  std::vector<std::pair<std::size_t, std::uint32_t>> queue{{nodes.size() - 1, image::kNone}};
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const tiny::Node& node = nodes[queue[i].first];
    image::Piece piece = tiny::put_piece(out, node);
    piece.parent = queue[i].second;
    if (!node.children.empty()) piece.first_child = static_cast<std::uint32_t>(queue.size());
    for (const std::size_t child : node.children) {
      queue.emplace_back(child, static_cast<std::uint32_t>(i));
    }
    out.pieces.push_back(piece);
  }
  tiny::put_header(out, leaves.size(), radius_m);
  tiny::put_levels(out);
  return out;
}

/// Makes the hash right again after bytes were changed on purpose.
inline void rehash(std::span<std::byte> image) {
  const auto hash = content_sha256(image);
  std::memcpy(image.data() + offsetof(image::Header, content_sha256), hash.data(), hash.size());
}

/// Lays the sections out and fills in sections, total_bytes and the hash. Proves nothing: parts
/// that were spoilt on purpose give a spoilt image.
inline AlignedBytes seal(ImageParts parts) {
  AlignedBytes bytes(sizeof(image::Header));
  const auto append = [&](image::SectionId id, const auto& records) {
    image::Section& section = parts.header.sections[static_cast<std::size_t>(id)];
    section = {};
    if (records.empty()) return;
    section.offset = bytes.size();
    section.count = static_cast<std::uint32_t>(records.size());
    section.stride = sizeof(records[0]);
    const std::size_t length = records.size() * sizeof(records[0]);
    bytes.resize((bytes.size() + length + image::kAlignment - 1) / image::kAlignment *
                 image::kAlignment);
    std::memcpy(bytes.data() + section.offset, records.data(), length);
  };
  append(image::SectionId::levels, parts.levels);
  append(image::SectionId::pieces, parts.pieces);
  append(image::SectionId::vertices, parts.vertices);
  append(image::SectionId::neighbour_starts, parts.neighbour_starts);
  append(image::SectionId::neighbours, parts.neighbours);
  append(image::SectionId::triangles, parts.triangles);
  append(image::SectionId::virtual_faces, parts.virtual_faces);
  append(image::SectionId::culling_vertices, parts.culling_vertices);
  parts.header.total_bytes = bytes.size();
  std::memcpy(bytes.data(), &parts.header, sizeof(parts.header));
  rehash(bytes);
  return bytes;
}

}  // namespace palpate::test
