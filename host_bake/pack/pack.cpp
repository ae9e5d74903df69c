// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/pack/pack.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <type_traits>

#include "host_bake/base/error.hpp"
#include "host_bake/pack/adjacency.hpp"
#include "host_bake/pack/patch_normal.hpp"
#include "host_bake/regions/proximity_cells.hpp"
#include "rt_core/image/view.hpp"

namespace palpate::bake {
namespace {

// The image's sections as they grow. Counts are checked when the layout is made.
struct Content {
  std::vector<image::Level> levels;
  std::vector<image::Piece> pieces;
  std::vector<image::Vertex> vertices;
  std::vector<std::uint32_t> neighbour_starts;
  std::vector<std::uint32_t> neighbours;
  std::vector<image::Triangle> triangles;
  std::vector<image::VirtualFace> virtual_faces;
  std::vector<image::Vertex> culling_vertices;
};

void refuse_above(std::size_t value, std::size_t limit, const std::string& what) {
  if (value <= limit) return;
  throw InputRefused("the image would pass a limit of its format",
                     std::to_string(value) + " " + what + ", at most " + std::to_string(limit),
                     "divide or simplify the mesh");
}

constexpr std::size_t kMaxCount = image::kNone - 1;  // indices are u32 and the last one is kNone

std::uint32_t count_of(std::size_t value, const std::string& what) {
  refuse_above(value, kMaxCount, what);
  return static_cast<std::uint32_t>(value);
}

// Pieces of the tree in the order of the image: breadth first, so that siblings are contiguous and
// follow their parent.
std::vector<std::uint32_t> image_order(const Hierarchy& tree) {
  std::vector<std::uint32_t> order{static_cast<std::uint32_t>(tree.pieces.size() - 1)};
  order.reserve(tree.pieces.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto& children = tree.pieces[order[i]].children;
    order.insert(order.end(), children.begin(), children.end());
  }
  return order;
}

// The piece's own records, appended to the sections; links to other pieces are set by
// link_pieces().
class PieceWriter {
 public:
  PieceWriter(const Hierarchy& tree, const Metrics& metrics, bool dropped, Content& out)
      : tree_(tree), metrics_(metrics), dropped_(dropped), out_(out) {}

  void write(std::uint32_t index) {
    const TreePiece& from = tree_.pieces[index];
    image::Piece to{};
    std::copy_n(metrics_.spheres[index].centre.begin(), 3, to.centre);
    to.radius = metrics_.spheres[index].radius;
    to.level = from.level;
    to.surface_deviation = metrics_.surface_deviation[index];
    to.hausdorff = metrics_.hausdorff[index];
    to.resolution = tree_.levels[from.level].resolution;
    to.flags = (from.all_real ? static_cast<std::uint32_t>(image::PieceFlag::all_real) : 0) |
               (from.back_open ? static_cast<std::uint32_t>(image::PieceFlag::back_open) : 0);
    write_vertices(from, to);
    write_neighbours(from, to);
    write_patch(from, to);
    write_culling(metrics_.culling[index], to);
    out_.pieces.push_back(to);
  }

 private:
  void write_vertices(const TreePiece& from, image::Piece& to) {
    to.first_vertex = count_of(out_.vertices.size(), "vertices");
    to.vertices = static_cast<std::uint32_t>(from.vertices.size());
    to.hull_vertices = from.hull_vertices;
    to.min_support_area = metrics_.support_area[from.vertices.front()];
    for (const std::uint32_t v : from.vertices) {
      const PointF& p = tree_.points[v];
      out_.vertices.push_back({{p[0], p[1], p[2]}, metrics_.support_area[v]});
      to.min_support_area = std::min(to.min_support_area, metrics_.support_area[v]);
    }
  }

  void write_neighbours(const TreePiece& from, image::Piece& to) {
    to.first_neighbour_start = image::kNone;
    to.first_neighbour = image::kNone;
    if (from.hull_vertices <= image::kAdjacencyAbove) return;
    const Adjacency joined = adjacency(from.hull_faces, from.hull_vertices);
    to.first_neighbour_start = count_of(out_.neighbour_starts.size(), "neighbour lists");
    to.first_neighbour = count_of(out_.neighbours.size(), "neighbours");
    out_.neighbour_starts.insert(out_.neighbour_starts.end(), joined.starts.begin(),
                                 joined.starts.end());
    out_.neighbours.insert(out_.neighbours.end(), joined.neighbours.begin(),
                           joined.neighbours.end());
  }

  void write_patch(const TreePiece& from, image::Piece& to) {
    to.first_triangle =
        from.triangles.empty() ? image::kNone : count_of(out_.triangles.size(), "triangles");
    to.triangles = static_cast<std::uint32_t>(from.triangles.size());
    to.first_virtual_face = from.virtual_faces.empty()
                                ? image::kNone
                                : count_of(out_.virtual_faces.size(), "virtual faces");
    to.virtual_faces = static_cast<std::uint32_t>(from.virtual_faces.size());
    for (image::Triangle t : from.triangles) {
      if (from.level > 0 || dropped_) t.source = image::kNone;
      out_.triangles.push_back(t);
    }
    for (const auto& f : from.virtual_faces) out_.virtual_faces.push_back({{f[0], f[1], f[2]}});
    if (!from.back_open) write_patch_normal(from, to);
  }

  void write_patch_normal(const TreePiece& from, image::Piece& to) {
    std::vector<PointF> points;
    points.reserve(from.vertices.size());
    for (const std::uint32_t v : from.vertices) points.push_back(tree_.points[v]);
    const PatchNormal normal = patch_normal(points, from.triangles);
    std::copy(normal.mean.begin(), normal.mean.end(), to.patch_normal);
    to.patch_cosine = normal.least_cosine;
  }

  void write_culling(const CullingBound& from, image::Piece& to) {
    to.culling_residual = from.residual;
    to.culling_vertices = static_cast<std::uint32_t>(from.points.size());
    to.first_culling_vertex = from.points.empty()
                                  ? image::kNone
                                  : count_of(out_.culling_vertices.size(), "culling vertices");
    for (const std::uint32_t v : from.points) {
      const PointF& p = tree_.points[v];
      out_.culling_vertices.push_back({{p[0], p[1], p[2]}, 0});
    }
  }

  const Hierarchy& tree_;
  const Metrics& metrics_;
  bool dropped_;  // the original surface is not in the tree
  Content& out_;
};

void link_pieces(const Hierarchy& tree, const std::vector<std::uint32_t>& order,
                 std::vector<image::Piece>& pieces) {
  std::uint32_t next = 1;
  pieces.front().parent = image::kNone;
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    const auto children = static_cast<std::uint32_t>(tree.pieces[order[i]].children.size());
    refuse_above(children, image::kMaxChildren, "children of one piece");
    pieces[i].children = children;
    pieces[i].first_child = children == 0 ? image::kNone : next;
    for (std::uint32_t c = 0; c < children; ++c) pieces[next + c].parent = i;
    next += children;
  }
}

std::vector<image::Level> level_table(const Hierarchy& tree,
                                      const std::vector<image::Piece>& pieces) {
  std::vector<image::Level> levels;
  for (const TreeLevel& from : tree.levels) {
    levels.push_back({.pieces = from.pieces,
                      .triangles = from.triangles,
                      .free = from.free ? 1u : 0u,
                      .resolution = from.resolution,
                      .max_surface_deviation_rel = 0,
                      .max_hausdorff_rel = 0,
                      .min_support_area_rel = image::kMaxArea,
                      .reserved = 0});
  }
  for (const image::Piece& piece : pieces) {
    const std::uint32_t above =
        piece.parent == image::kNone ? piece.level + 1 : pieces[piece.parent].level;
    for (std::uint32_t l = piece.level; l < above; ++l) {
      image::Level& level = levels[l];
      level.max_surface_deviation_rel =
          std::max(level.max_surface_deviation_rel, piece.surface_deviation);
      level.max_hausdorff_rel = std::max(level.max_hausdorff_rel, piece.hausdorff);
      level.min_support_area_rel = std::min(level.min_support_area_rel, piece.min_support_area);
    }
  }
  return levels;
}

void fill_capacities(const Content& content, image::Header& header) {
  std::vector<std::uint32_t> depth(content.pieces.size(), 1);
  for (std::size_t i = 0; i < content.pieces.size(); ++i) {
    const image::Piece& p = content.pieces[i];
    if (p.parent != image::kNone) depth[i] = depth[p.parent] + 1;
    header.tree_depth = std::max(header.tree_depth, depth[i]);
    header.max_children = std::max(header.max_children, p.children);
    header.max_hull_vertices = std::max(header.max_hull_vertices, p.hull_vertices);
    header.max_patch_triangles = std::max(header.max_patch_triangles, p.triangles);
    for (std::uint32_t v = 0; p.first_neighbour_start != image::kNone && v < p.hull_vertices; ++v) {
      const std::uint32_t* starts = content.neighbour_starts.data() + p.first_neighbour_start + v;
      header.max_valence = std::max(header.max_valence, starts[1] - starts[0]);
    }
  }
  header.leaf_pieces = content.levels.front().pieces;
  header.free_levels =
      static_cast<std::uint32_t>(std::count_if(content.levels.begin(), content.levels.end(),
                                               [](const image::Level& l) { return l.free != 0; }));
  refuse_above(header.max_hull_vertices, image::kMaxHullVertices, "vertices of one hull");
}

std::size_t padded(std::size_t bytes) {
  return (bytes + image::kAlignment - 1) / image::kAlignment * image::kAlignment;
}

// Appends sections behind the header, each on its boundary.
class ImageWriter {
 public:
  explicit ImageWriter(const image::Header& header)
      : header_(header), bytes_(sizeof(image::Header)) {}

  template <class Record>
  void add(image::SectionId id, const std::vector<Record>& records) {
    static_assert(std::is_trivially_copyable_v<Record>);
    if (records.empty()) return;
    const std::uint32_t count = count_of(records.size(), "records of one section");
    header_.sections[static_cast<std::size_t>(id)] = {bytes_.size(), count, sizeof(Record)};
    const std::size_t offset = bytes_.size(), size = records.size() * sizeof(Record);
    bytes_.resize(padded(offset + size));
    std::memcpy(bytes_.data() + offset, records.data(), size);
  }

  std::vector<std::byte> finish() && {
    header_.total_bytes = bytes_.size();
    std::memcpy(bytes_.data(), &header_, sizeof header_);
    const std::array<std::uint8_t, 32> hash = content_sha256(bytes_);
    std::memcpy(bytes_.data() + offsetof(image::Header, content_sha256), hash.data(), hash.size());
    return std::move(bytes_);
  }

 private:
  image::Header header_;
  std::vector<std::byte> bytes_;
};

// Each triangle with the piece of level 0 whose patch holds it.
std::vector<image::RegionTriangle> linked_to_pieces(std::vector<image::RegionTriangle> triangles,
                                                    const Content& content) {
  std::vector<std::uint32_t> piece_of(triangles.size(), image::kNone);
  for (std::uint32_t i = 0; i < content.pieces.size(); ++i) {
    const image::Piece& piece = content.pieces[i];
    if (piece.level != 0 || triangles.empty()) continue;
    for (std::uint32_t t = 0; t < piece.triangles; ++t) {
      piece_of.at(content.triangles[piece.first_triangle + t].source) = i;
    }
  }
  for (image::RegionTriangle& t : triangles) t.piece = piece_of.at(t.source);
  return triangles;
}

image::Header header_of(const Content& content, const image::Header& facts) {
  image::Header header = facts;
  std::copy(std::begin(image::kMagic), std::end(image::kMagic), header.magic);
  header.format_major = image::kFormatMajor;
  header.format_minor = image::kFormatMinor;
  header.byte_order_mark = image::kByteOrderMark;
  header.header_bytes = sizeof(image::Header);
  fill_capacities(content, header);
  return header;
}

}  // namespace

std::vector<std::byte> pack(const Hierarchy& tree, const Metrics& metrics,
                            const image::Header& facts, const RegionTree& regions) {
  refuse_above(tree.pieces.size(), image::kMaxPieces, "pieces");
  refuse_above(tree.levels.size(), image::kMaxLevels, "levels");
  const std::vector<std::uint32_t> order = image_order(tree);
  Content content;
  content.pieces.reserve(order.size());
  PieceWriter writer(tree, metrics, facts.dropped_levels > 0, content);
  for (const std::uint32_t i : order) writer.write(i);
  link_pieces(tree, order, content.pieces);
  content.levels = level_table(tree, content.pieces);

  ImageWriter image(header_of(content, facts));
  image.add(image::SectionId::levels, content.levels);
  image.add(image::SectionId::pieces, content.pieces);
  image.add(image::SectionId::vertices, content.vertices);
  image.add(image::SectionId::neighbour_starts, content.neighbour_starts);
  image.add(image::SectionId::neighbours, content.neighbours);
  image.add(image::SectionId::triangles, content.triangles);
  image.add(image::SectionId::virtual_faces, content.virtual_faces);
  image.add(image::SectionId::culling_vertices, content.culling_vertices);
  image.add(image::SectionId::region_nodes, regions.nodes);
  image.add(image::SectionId::region_triangles, linked_to_pieces(regions.triangles, content));
  image.add(image::SectionId::regions, regions.regions);
  if (!regions.regions.empty()) {
    const ProximityCells near = proximity_cells(regions.triangles, double(facts.delta_rel));
    image.add(image::SectionId::proximity_grid, std::vector{near.grid});
    image.add(image::SectionId::proximity_bricks, near.bricks);
    image.add(image::SectionId::proximity_cells, near.cells);
    image.add(image::SectionId::surface_vertices, regions.surface.vertices);
    image.add(image::SectionId::vertex_normals, regions.surface.normals);
    image.add(image::SectionId::surface_edges, regions.surface.edges);
    image.add(image::SectionId::surface_runs, regions.surface.runs);
    image.add(image::SectionId::triangle_vertices, regions.surface.triangle_vertices);
  }
  return std::move(image).finish();
}

}  // namespace palpate::bake
