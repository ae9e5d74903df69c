// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/metrics/nearest.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "host_bake/simplify/surface.hpp"

namespace palpate::bake {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// 8^11 > 2^32: a search holds at most the seven other children of each of eleven nodes, and eight.
constexpr std::size_t kMaxOpen = 11 * 7 + 8;

// Distances to boxes are computed in float. For points at most 2 from the origin the rounding of
// the point moves them by 2.1e-7, their own arithmetic by 3e-7 of their length; doubled.
constexpr double kBoxRounding = 4.2e-7;
constexpr double kBoxRelativeRounding = 6e-7;

// A box whose squared distance in float is not below this has nothing as near as `squared`.
float box_limit(double squared) {
  const double limit = std::sqrt(squared) * (1 + kBoxRelativeRounding) + kBoxRounding;
  return static_cast<float>(limit * limit);
}

struct Open {
  std::uint32_t child;
  float squared_distance;
};

}  // namespace

// Divides faces into subtrees of 8^k, so that all nodes but the last of each size are full.
struct NearestSurface::Builder {
  const NormalMesh& mesh;
  NearestSurface& out;
  std::vector<std::array<float, 3>> middles = {};  // of the faces' boxes, twice
  std::vector<std::uint32_t> triangle_of_face = {};

  [[nodiscard]] Box box_of(const Face& face) const {
    Box box{mesh.points[face[0]], mesh.points[face[0]]};
    for (const std::uint32_t v : face) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        box.low[axis] = std::min(box.low[axis], mesh.points[v][axis]);
        box.high[axis] = std::max(box.high[axis], mesh.points[v][axis]);
      }
    }
    return box;
  }

  [[nodiscard]] std::size_t longest_axis(std::span<const std::uint32_t> faces) const {
    Box box{middles[faces[0]], middles[faces[0]]};
    for (const std::uint32_t f : faces) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        box.low[axis] = std::min(box.low[axis], middles[f][axis]);
        box.high[axis] = std::max(box.high[axis], middles[f][axis]);
      }
    }
    std::size_t longest = 0;
    for (std::size_t axis = 1; axis < 3; ++axis) {
      if (box.high[axis] - box.low[axis] > box.high[longest] - box.low[longest]) longest = axis;
    }
    return longest;
  }

  // Orders faces by place and cuts them into parts of `size` (the last may be smaller).
  void divide(std::span<std::uint32_t> faces, std::size_t size,
              std::vector<std::span<std::uint32_t>>& out_parts) const {
    if (faces.size() <= size) {
      out_parts.push_back(faces);
      return;
    }
    const std::size_t half = (faces.size() + size - 1) / size / 2 * size;
    const std::size_t axis = longest_axis(faces);
    std::nth_element(faces.begin(), faces.begin() + static_cast<std::ptrdiff_t>(half), faces.end(),
                     [&](std::uint32_t a, std::uint32_t b) {
                       if (middles[a][axis] != middles[b][axis])
                         return middles[a][axis] < middles[b][axis];
                       return a < b;
                     });
    divide(faces.first(half), size, out_parts);
    divide(faces.subspan(half), size, out_parts);
  }

  void add_node(std::span<std::uint32_t> faces, Box& out_box) {
    const std::size_t place = out.nodes_.size();
    out.nodes_.emplace_back();
    std::size_t size = 1;
    while (size * kChildren < faces.size()) size *= kChildren;
    std::vector<std::span<std::uint32_t>> parts;
    divide(faces, size, parts);
    Node node{};
    for (auto& low : node.low) low.fill(Floats{} + kInfinity);
    for (auto& high : node.high) high.fill(Floats{} - kInfinity);
    out_box.low.fill(kInfinity);
    out_box.high.fill(-kInfinity);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      Box box{};
      node.child[i] = add_child(parts[i], box);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        node.low[axis][i / 4][i % 4] = box.low[axis];
        node.high[axis][i / 4][i % 4] = box.high[axis];
        out_box.low[axis] = std::min(out_box.low[axis], box.low[axis]);
        out_box.high[axis] = std::max(out_box.high[axis], box.high[axis]);
      }
    }
    out.nodes_[place] = node;
  }

  std::uint32_t add_child(std::span<std::uint32_t> faces, Box& out_box) {
    if (faces.size() > 1) {
      const auto place = static_cast<std::uint32_t>(out.nodes_.size());
      add_node(faces, out_box);
      return place;
    }
    const Face& face = mesh.faces[faces[0]];
    out_box = box_of(face);
    const auto triangle = static_cast<std::uint32_t>(out.triangles_.size());
    triangle_of_face[faces[0]] = triangle;
    out.triangles_.push_back({mesh.points[face[0]], mesh.points[face[1]], mesh.points[face[2]]});
    return triangle | kIsTriangle;
  }

  void build() {
    std::vector<std::uint32_t> order(mesh.faces.size());
    middles.resize(mesh.faces.size());
    triangle_of_face.resize(mesh.faces.size());
    for (std::uint32_t f = 0; f < order.size(); ++f) {
      order[f] = f;
      const Box box = box_of(mesh.faces[f]);
      for (std::size_t axis = 0; axis < 3; ++axis)
        middles[f][axis] = box.low[axis] + box.high[axis];
    }
    out.triangles_.reserve(order.size());
    Box box{};
    add_node(order, box);
    join_neighbours();
  }

  void join_neighbours() {
    out.neighbours_.assign(mesh.faces.size(), {kNoTriangle, kNoTriangle, kNoTriangle});
    const std::vector<std::uint32_t> twin = Surface(mesh).twin;
    for (std::size_t h = 0; h < twin.size(); ++h) {
      if (twin[h] != kNothing)
        out.neighbours_[triangle_of_face[h / 3]][h % 3] = triangle_of_face[twin[h] / 3];
    }
  }
};

NearestSurface::NearestSurface(const NormalMesh& mesh) { Builder{mesh, *this}.build(); }

Nearest NearestSurface::nearest(Vec3d p, std::uint32_t hint) const {
  return search(p, {hint, squared_distance(p, hint)});
}

Nearest NearestSurface::search(Vec3d p, Nearest best) const {
  const std::array<float, 3> at{static_cast<float>(p.x), static_cast<float>(p.y),
                                static_cast<float>(p.z)};
  float limit = box_limit(best.squared_distance);
  std::array<Open, kMaxOpen> stack;
  std::size_t open = 0;
  stack[open++] = {0, 0};
  while (open > 0) {
    const Open next = stack[--open];
    if (!(next.squared_distance < limit)) continue;
    if ((next.child & kIsTriangle) != 0) {
      const std::uint32_t triangle = next.child & ~kIsTriangle;
      const double squared = squared_distance(p, triangle);
      // The first of equals, so that neither hints nor the order of the search show.
      if (squared < best.squared_distance ||
          (squared == best.squared_distance && triangle < best.triangle)) {
        best = {triangle, squared};
        limit = box_limit(squared);
      }
      continue;
    }
    const Node& node = nodes_[next.child];
    std::array<Floats, kChildren / 4> squared{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t four = 0; four < squared.size(); ++four) {
        const Floats below = node.low[axis][four] - at[axis];
        const Floats above = at[axis] - node.high[axis][four];
        const Floats outside = below > above ? below : above;
        const Floats off = outside > Floats{} ? outside : Floats{};
        squared[four] += off * off;
      }
    }
    const std::size_t first = open;  // nearest children on top
    for (std::size_t i = 0; i < kChildren; ++i) {
      const float child_squared = squared[i / 4][i % 4];
      if (!(child_squared < limit)) continue;
      std::size_t place = open++;
      for (; place > first && stack[place - 1].squared_distance < child_squared; --place)
        stack[place] = stack[place - 1];
      stack[place] = {node.child[i], child_squared};
    }
  }
  return best;
}

}  // namespace palpate::bake
