// SPDX-License-Identifier: Apache-2.0
#include "rt_core/image/checks.hpp"

namespace palpate::image::checks {
namespace {

double exact(float v) noexcept { return static_cast<double>(v); }

bool empty(const ImageView& image) noexcept {
  return image.region_nodes.empty() && image.region_triangles.empty() && image.regions.empty();
}

bool any_empty(const ImageView& image) noexcept {
  return image.region_nodes.empty() || image.region_triangles.empty() || image.regions.empty();
}

std::uint32_t slot_in_parent(const ImageView& image, std::uint32_t index) noexcept {
  return index - image.region_nodes[image.region_nodes[index].parent].first;
}

// Nodes are in breadth-first order, so the runs of their children follow one another, inner nodes'
// in the nodes and leaves' in the triangles.
bool runs_tile(const ImageView& image) noexcept {
  std::uint64_t next_node = 1;
  std::uint64_t next_triangle = 0;
  for (std::uint32_t i = 0; i < image.region_nodes.size(); ++i) {
    const RegionNode& node = image.region_nodes[i];
    if (node.children < 1 || node.children > kRegionWidth || node.leaf > 1) return false;
    std::uint64_t& next = node.leaf != 0 ? next_triangle : next_node;
    if (node.first != next) return false;
    next += node.children;
    if (node.leaf == 0 && (next > image.region_nodes.size() || node.first <= i)) return false;
  }
  return next_node == image.region_nodes.size() && next_triangle == image.region_triangles.size();
}

// The tiling proves that every node but the root is in one parent's run.
bool parents_agree(const ImageView& image) noexcept {
  if (image.region_nodes[0].parent != kNone || image.region_nodes[0].leaf != 0) return false;
  for (std::uint32_t i = 0; i < image.region_nodes.size(); ++i) {
    const RegionNode& node = image.region_nodes[i];
    if (node.leaf != 0) continue;
    for (std::uint32_t c = 0; c < node.children; ++c) {
      if (image.region_nodes[node.first + c].parent != i) return false;
    }
  }
  return true;
}

bool depth_sound(const ImageView& image, std::uint32_t index) noexcept {
  std::uint32_t depth = 1;
  for (; image.region_nodes[index].parent != kNone && depth <= kMaxRegionDepth; ++depth) {
    index = image.region_nodes[index].parent;
  }
  return depth <= kMaxRegionDepth;
}

bool is_region_root(const ImageView& image, std::uint32_t index) noexcept {
  const RegionNode& node = image.region_nodes[index];
  return node.region != kNone && image.region_nodes[node.parent].region == kNone;
}

bool root_sound(const ImageView& image, std::uint32_t index) noexcept {
  const RegionNode& node = image.region_nodes[index];
  if (node.region >= image.regions.size()) return false;
  const Region& region = image.regions[node.region];
  return region.parent == node.parent && region.slot == slot_in_parent(image, index);
}

// Inside a region all nodes are of it; above, the regions below the children follow one another.
bool region_links_sound(const ImageView& image, std::uint32_t index) noexcept {
  const RegionNode& node = image.region_nodes[index];
  if (node.region != kNone) {
    const bool inherits = image.region_nodes[node.parent].region == node.region;
    return node.first_region == node.region && node.regions == 1 &&
           (inherits || (is_region_root(image, index) && root_sound(image, index)));
  }
  if (node.leaf != 0) return false;
  std::uint64_t next = node.first_region;
  for (std::uint32_t c = 0; c < node.children; ++c) {
    const RegionNode& child = image.region_nodes[node.first + c];
    if (child.first_region != next) return false;
    next += child.regions;
  }
  return next == std::uint64_t{node.first_region} + node.regions;
}

// Region roots name regions and regions name them back, so where there are as many, each region
// has its own.
bool regions_sound(const ImageView& image) noexcept {
  const RegionNode& root = image.region_nodes[0];
  if (root.region != kNone || root.first_region != 0 || root.regions != image.regions.size()) {
    return false;
  }
  std::uint64_t roots = 0;
  for (std::uint32_t i = 0; i < image.region_nodes.size(); ++i) {
    if (!depth_sound(image, i) || !region_links_sound(image, i)) return false;
    if (i > 0 && is_region_root(image, i)) ++roots;
  }
  return roots == image.regions.size();
}

double axis_dot(const RegionNode& node, std::uint32_t slot, std::uint32_t k,
                std::uint32_t m) noexcept {
  double sum = 0;
  for (std::uint32_t c = 0; c < 3; ++c) {
    sum += exact(node.axes[3 * k + c][slot]) * exact(node.axes[3 * m + c][slot]);
  }
  return sum;
}

bool box_sound(const RegionNode& node, std::uint32_t slot) noexcept {
  for (std::uint32_t k = 0; k < 3; ++k) {
    if (!within(node.centre[k][slot], -kMaxNorm, kMaxNorm) ||
        !within(node.half[k][slot], 0.0f, kMaxLength)) {
      return false;
    }
    for (std::uint32_t m = 0; m <= k; ++m) {
      const double off = axis_dot(node, slot, k, m) - (k == m ? 1.0 : 0.0);
      if (!within(off, -exact(kBoxAxisTolerance), exact(kBoxAxisTolerance))) return false;
    }
  }
  return true;
}

bool repeats_first(const RegionNode& node, std::uint32_t slot) noexcept {
  bool same = true;
  for (std::uint32_t k = 0; k < 3; ++k) {
    same =
        same && node.centre[k][slot] == node.centre[k][0] && node.half[k][slot] == node.half[k][0];
  }
  for (const auto& row : node.axes) same = same && row[slot] == row[0];
  return same;
}

bool boxes_sound(const RegionNode& node) noexcept {
  for (std::uint32_t slot = 0; slot < kRegionWidth; ++slot) {
    if (slot < node.children ? !box_sound(node, slot) : !repeats_first(node, slot)) return false;
  }
  return true;
}

// The baker rounds half lengths up with room; the slack covers the rounding of these operations.
bool in_box(const RegionNode& node, std::uint32_t slot, const float* corner) noexcept {
  constexpr double kSlack = 1e-14;
  for (std::uint32_t k = 0; k < 3; ++k) {
    double along = 0;
    for (std::uint32_t c = 0; c < 3; ++c) {
      along += exact(node.axes[3 * k + c][slot]) * (exact(corner[c]) - exact(node.centre[c][slot]));
    }
    const double most = exact(node.half[k][slot]) + kSlack;
    if (!within(along, -most, most)) return false;
  }
  return true;
}

// A triangle in slot `slot` of leaf `index` is in the boxes of all its ancestors.
bool in_boxes(const ImageView& image, std::uint32_t index, std::uint32_t slot,
              const RegionTriangle& triangle) noexcept {
  while (true) {
    const RegionNode& node = image.region_nodes[index];
    for (std::uint32_t c = 0; c < 3; ++c) {
      if (!in_box(node, slot, triangle.corners + 3 * c)) return false;
    }
    if (node.parent == kNone) return true;
    slot = slot_in_parent(image, index);
    index = node.parent;
  }
}

bool corners_sound(const RegionTriangle& triangle, const Region& region) noexcept {
  for (std::uint32_t c = 0; c < 3; ++c) {
    double squared = 0;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const float v = triangle.corners[3 * c + k];
      if (!within(v, -kMaxNorm, kMaxNorm)) return false;
      squared += exact(v) * exact(v);
    }
    if (!(squared <= exact(region.reach) * exact(region.reach))) return false;
  }
  return true;
}

bool neighbours_sound(const ImageView& image, std::uint32_t index) noexcept {
  for (const std::uint32_t n : image.region_triangles[index].neighbours) {
    if (n == kNone) continue;
    if (n >= image.region_triangles.size() || n == index) return false;
    const auto& back = image.region_triangles[n].neighbours;
    if (back[0] != index && back[1] != index && back[2] != index) return false;
  }
  return true;
}

bool triangle_links_sound(const ImageView& image, const RegionNode& leaf,
                          std::uint32_t index) noexcept {
  const RegionTriangle& t = image.region_triangles[index];
  return t.region == leaf.region && t.piece < image.pieces.size() &&
         image.pieces[t.piece].level == 0 && t.source < image.header->source_triangles &&
         neighbours_sound(image, index);
}

Status check_leaf(const ImageView& image, std::uint32_t index) noexcept {
  const RegionNode& leaf = image.region_nodes[index];
  for (std::uint32_t slot = 0; slot < leaf.children; ++slot) {
    const std::uint32_t triangle = leaf.first + slot;
    if (!triangle_links_sound(image, leaf, triangle)) return Status::image_bad_index;
    const RegionTriangle& t = image.region_triangles[triangle];
    if (!corners_sound(t, image.regions[leaf.region])) return Status::image_bad_float;
    if (!in_boxes(image, index, slot, t)) return Status::image_bad_tree;
  }
  return Status::ok;
}

bool records_clear(const ImageView& image) noexcept {
  if (image.header->format_minor > kFormatMinor) return true;
  std::uint32_t bits = 0;
  for (const RegionNode& node : image.region_nodes) {
    for (const std::uint32_t r : node.reserved) bits |= r;
  }
  return bits == 0;
}

// Whether each triangle leads to the first one of its component, and those from one to the next.
bool components_sound(const ImageView& image) noexcept {
  const auto triangles = image.region_triangles;
  const std::uint32_t count = image.header->source_components;
  std::uint32_t first = count > 1 ? 0 : kNone;  // of the next component
  std::uint32_t seen = 0;
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const std::uint32_t named = triangles[i].component;
    if (i == first) {
      if (named <= i || (named >= triangles.size() && named != kNone)) return false;
      first = named;
      ++seen;
    } else if (count > 1 ? named >= i || triangles[named].component <= named : named != 0) {
      return false;
    }
  }
  return count == 1 || seen == count;
}

bool lengths_sound(const ImageView& image) noexcept {
  for (const Region& region : image.regions) {
    if (!within(region.reach, 0.0f, kMaxNorm) || !within(region.radius, 0.0f, kMaxLength)) {
      return false;
    }
  }
  return true;
}

}  // namespace

Status check_regions(const ImageView& image) noexcept {
  if (empty(image)) return Status::ok;
  if (any_empty(image)) return Status::image_missing_section;
  if (image.region_nodes.size() > kMaxRegionNodes || image.regions.size() > kMaxRegions) {
    return Status::image_over_limit;
  }
  if (image.region_triangles.size() != image.header->source_triangles ||
      image.header->dropped_levels != 0 || !records_clear(image)) {
    return Status::image_bad_section;
  }
  if (!runs_tile(image) || !parents_agree(image) || !regions_sound(image)) {
    return Status::image_bad_tree;
  }
  if (!components_sound(image)) return Status::image_bad_index;
  if (!lengths_sound(image)) return Status::image_bad_float;
  for (const RegionNode& node : image.region_nodes) {
    if (!boxes_sound(node)) return Status::image_bad_float;
  }
  for (std::uint32_t i = 0; i < image.region_nodes.size(); ++i) {
    if (image.region_nodes[i].leaf == 0) continue;
    if (const Status s = check_leaf(image, i); s != Status::ok) return s;
  }
  return Status::ok;
}

}  // namespace palpate::image::checks
