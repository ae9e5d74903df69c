// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/regions/region_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "host_bake/base/error.hpp"
#include "host_bake/base/parallel.hpp"
#include "host_bake/mesh/topology.hpp"
#include "host_bake/metrics/vector.hpp"
#include "host_bake/regions/fitted_box.hpp"
#include "rt_core/image/format.hpp"

namespace palpate::bake {
namespace {

constexpr std::uint32_t kWidth = image::kRegionWidth;

void refuse_above(std::size_t value, std::size_t limit, const std::string& what) {
  if (value <= limit) return;
  throw InputRefused("the regions would pass a limit of the image format",
                     std::to_string(value) + " " + what + ", at most " + std::to_string(limit),
                     "divide or simplify the mesh, or bake for the levels engine");
}

float next_float_above(double v) {
  return std::nextafter(static_cast<float>(v), std::numeric_limits<float>::infinity());
}

class Builder {
 public:
  Builder(const NormalMesh& mesh, Partition partition) : mesh_(mesh), part_(std::move(partition)) {}

  RegionTree run(std::span<const std::size_t> crossing_faces) && {
    fold();
    count_regions();
    parallel_for(out_.nodes.size(), [&](std::size_t i) { fit_children(i); });
    measure_regions();
    fill_triangles();
    out_.surface = surface_parts(mesh_, out_.triangles, out_.regions.size(), crossing_faces);
    set_normal_cones(out_.triangles, out_.surface.runs);
    return std::move(out_);
  }

 private:
  /// Wide nodes breadth first; members_[i] are the binary nodes that are children of wide node i,
  /// or the one group whose triangles are.
  void fold() {
    std::vector<std::uint32_t> depth{1};
    out_.nodes.push_back({});
    out_.nodes[0].parent = image::kNone;
    out_.nodes[0].region = image::kNone;
    members_.push_back(children_of_root());
    for (std::uint32_t i = 0; i < out_.nodes.size(); ++i) {
      refuse_above(depth[i], image::kMaxRegionDepth, "levels of nodes");
      if (out_.nodes[i].leaf != 0) {
        out_.nodes[i].first = static_cast<std::uint32_t>(order_.size());
        take_triangles(i);
        continue;
      }
      out_.nodes[i].first = static_cast<std::uint32_t>(out_.nodes.size());
      out_.nodes[i].children = static_cast<std::uint32_t>(members_[i].size());
      const std::vector<std::uint32_t> members = members_[i];
      for (std::uint32_t slot = 0; slot < members.size(); ++slot) {
        add_child(i, slot, members[slot]);
        depth.push_back(depth[i] + 1);
      }
    }
    refuse_above(out_.nodes.size(), image::kMaxRegionNodes, "nodes");
    refuse_above(out_.regions.size(), image::kMaxRegions, "regions");
  }

  std::vector<std::uint32_t> children_of_root() const {
    if (part_.nodes[0].region) return {0};
    return opened(0);
  }

  void add_child(std::uint32_t parent, std::uint32_t slot, std::uint32_t member) {
    const Partition::Node& from = part_.nodes[member];
    image::RegionNode node{};
    node.parent = parent;
    node.region = out_.nodes[parent].region;
    if (from.region) {
      node.region = static_cast<std::uint32_t>(out_.regions.size());
      out_.regions.push_back({.parent = parent, .slot = slot, .reach = 0, .radius = 0});
    }
    node.leaf = Partition::is_group(from) ? 1 : 0;
    out_.nodes.push_back(node);
    members_.push_back(node.leaf != 0 ? std::vector<std::uint32_t>{member} : opened(member));
  }

  /// Up to sixteen binary descendants that cover a node; regions and groups are not opened, nor
  /// what fits below one child of a tree of the least height: so nodes are full.
  std::vector<std::uint32_t> opened(std::uint32_t top) const {
    std::uint64_t fits = kWidth;
    while (fits * kWidth < part_.nodes[top].count) fits *= kWidth;
    std::vector<std::uint32_t> members{part_.nodes[top].child, part_.nodes[top].child + 1};
    while (members.size() < kWidth) {
      std::size_t best = members.size();
      for (std::size_t i = 0; i < members.size(); ++i) {
        const Partition::Node& n = part_.nodes[members[i]];
        if (n.region || Partition::is_group(n) || n.count <= fits) continue;
        if (best == members.size() || n.count > part_.nodes[members[best]].count) best = i;
      }
      if (best == members.size()) break;
      const std::uint32_t child = part_.nodes[members[best]].child;
      members[best] = child;
      members.insert(members.begin() + std::ptrdiff_t(best) + 1, child + 1);
    }
    return members;
  }

  void take_triangles(std::uint32_t index) {
    const Partition::Node& group = part_.nodes[members_[index][0]];
    out_.nodes[index].children = group.count;
    for (std::uint32_t i = 0; i < group.count; ++i) {
      order_.push_back(part_.faces[group.first + i]);
      region_of_.push_back(out_.nodes[index].region);
    }
  }

  /// Regions are numbered breadth first, so those below a node of the top are not contiguous until
  /// they are numbered again depth first.
  void count_regions() {
    std::vector<std::uint32_t> renumbered(out_.regions.size(), image::kNone);
    std::vector<image::Region> regions;
    std::vector<std::uint32_t> open{0};
    while (!open.empty()) {
      image::RegionNode& node = out_.nodes[open.back()];
      open.pop_back();
      if (node.region != image::kNone) {
        renumbered[node.region] = static_cast<std::uint32_t>(regions.size());
        regions.push_back(out_.regions[node.region]);
        continue;
      }
      for (std::uint32_t i = node.children; i > 0; --i) open.push_back(node.first + i - 1);
    }
    out_.regions = std::move(regions);
    for (std::uint32_t& r : region_of_) r = renumbered[r];
    for (std::size_t i = out_.nodes.size(); i > 0; --i) {
      image::RegionNode& node = out_.nodes[i - 1];
      if (node.region != image::kNone) {
        node.region = node.first_region = renumbered[node.region];
        node.regions = 1;
        continue;
      }
      node.first_region = out_.nodes[node.first].first_region;
      for (std::uint32_t c = 0; c < node.children; ++c)
        node.regions += out_.nodes[node.first + c].regions;
    }
  }

  Vec3d point(std::uint32_t face, std::size_t corner) const {
    return vec(mesh_.points[mesh_.faces[face][corner]]);
  }

  FittedBox box_of_face(std::uint32_t face) const {
    const Vec3d p[3] = {point(face, 0), point(face, 1), point(face, 2)};
    const Vec3d edges[3] = {p[1] - p[0], p[2] - p[1], p[0] - p[2]};
    return fit_box(p, cross(edges[0], edges[1]), edges);
  }

  FittedBox box_of_member(std::uint32_t member) const {
    const Partition::Node& from = part_.nodes[member];
    std::vector<Vec3d> points;
    points.reserve(3 * std::size_t{from.count});
    Vec3d normal{};
    for (std::uint32_t i = 0; i < from.count; ++i) {
      const std::uint32_t face = part_.faces[from.first + i];
      for (std::size_t c = 0; c < 3; ++c) points.push_back(point(face, c));
      normal += cross(point(face, 1) - point(face, 0), point(face, 2) - point(face, 0));
    }
    return fit_box(points, normal, {});
  }

  void fit_children(std::size_t index) {
    image::RegionNode& node = out_.nodes[index];
    for (std::uint32_t i = 0; i < kWidth; ++i) {
      if (i >= node.children) {
        repeat_first(node, i);
        continue;
      }
      set_box(
          node, i,
          node.leaf != 0 ? box_of_face(order_[node.first + i]) : box_of_member(members_[index][i]));
    }
  }

  static void set_box(image::RegionNode& node, std::uint32_t i, const FittedBox& box) {
    for (std::size_t k = 0; k < 3; ++k) {
      node.centre[k][i] = box.centre[k];
      node.half[k][i] = box.half[k];
      for (std::size_t c = 0; c < 3; ++c) node.axes[3 * k + c][i] = box.axes[k][c];
    }
  }

  static void repeat_first(image::RegionNode& node, std::uint32_t i) {
    for (std::size_t k = 0; k < 3; ++k) {
      node.centre[k][i] = node.centre[k][0];
      node.half[k][i] = node.half[k][0];
    }
    for (auto& row : node.axes) row[i] = row[0];
  }

  void measure_regions() {
    for (image::Region& r : out_.regions) {
      const image::RegionNode& node = out_.nodes[r.parent];
      const Vec3d half{double(node.half[0][r.slot]), double(node.half[1][r.slot]),
                       double(node.half[2][r.slot])};
      r.radius = next_float_above(norm(half));
    }
    for (std::size_t i = 0; i < order_.size(); ++i) {
      image::Region& r = out_.regions[region_of_[i]];
      for (std::size_t c = 0; c < 3; ++c)
        r.reach = std::max(r.reach, next_float_above(norm(point(order_[i], c))));
    }
  }

  void fill_triangles() {
    std::vector<std::uint32_t> place(order_.size());
    for (std::uint32_t i = 0; i < order_.size(); ++i) place[order_[i]] = i;
    out_.triangles.resize(order_.size());
    for (std::uint32_t i = 0; i < order_.size(); ++i) {
      image::RegionTriangle& t = out_.triangles[i];
      for (std::size_t c = 0; c < 3; ++c) {
        std::copy_n(mesh_.points[mesh_.faces[order_[i]][c]].begin(), 3, t.corners + 3 * c);
      }
      std::fill_n(t.neighbours, 3, image::kNone);
      t.region = region_of_[i];
      t.piece = image::kNone;
      t.source = order_[i];
    }
    const std::vector<Side> sides = sorted_sides(mesh_.faces);
    link_neighbours(place, sides);
    link_components(components_of(mesh_.faces, sides));
  }

  /// Of several ones each triangle leads to its component's first, and that to the next one's.
  void link_components(const Components& components) {
    const std::size_t count = components.closed.size();
    if (count < 2) return;
    std::vector<std::uint32_t> first_of(count, image::kNone);
    std::uint32_t last = image::kNone;  // of those first ones
    for (std::uint32_t i = 0; i < order_.size(); ++i) {
      std::uint32_t& first = first_of.at(components.of_face[order_[i]]);
      if (first != image::kNone) {
        out_.triangles[i].component = first;
        continue;
      }
      out_.triangles[i].component = image::kNone;
      if (last != image::kNone) out_.triangles[last].component = i;
      first = last = i;
    }
  }

  void link_neighbours(const std::vector<std::uint32_t>& place, std::span<const Side> sides) {
    for_each_edge(sides, [&](std::span<const Side> edge) {
      if (edge.size() != 2) return;
      for (std::size_t k = 0; k < 2; ++k) {
        const Side& s = edge[k];
        const std::uint32_t corner = corner_of(mesh_.faces[s.face], s.forward ? s.low : s.high);
        out_.triangles[place[s.face]].neighbours[corner] = place[edge[1 - k].face];
      }
    });
  }

  const NormalMesh& mesh_;
  Partition part_;
  std::vector<std::vector<std::uint32_t>> members_;
  std::vector<std::uint32_t> order_;      // faces in the order of the leaves
  std::vector<std::uint32_t> region_of_;  // beside order_
  RegionTree out_;
};

}  // namespace

RegionTree build_regions(const NormalMesh& mesh, const RegionOptions& options,
                         std::span<const std::size_t> crossing_faces) {
  return Builder(mesh, divide(mesh, options)).run(crossing_faces);
}

}  // namespace palpate::bake
