// SPDX-License-Identifier: GPL-3.0-or-later
// Nearest points on a fixed surface.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "host_bake/mesh/mesh.hpp"
#include "host_bake/metrics/nearest_on_triangle.hpp"
#include "host_bake/metrics/vector.hpp"
#include "rt_core/geometry/vec3.hpp"

namespace palpate::bake {

inline constexpr std::uint32_t kNoTriangle = 0xffffffffu;

struct Nearest {
  /// The nearest triangle; of several at the same distance the first one. Numbered as
  /// NearestSurface keeps them, not as the mesh does.
  std::uint32_t triangle = 0;
  double squared_distance = std::numeric_limits<double>::infinity();
};

/// The triangles of a mesh in a tree of boxes, eight children to a node. Keeps its own copy.
class NearestSurface {
 public:
  /// At least one face; coordinates inside the unit ball (up to rounding). O(n log n); about 90
  /// bytes a triangle.
  explicit NearestSurface(const NormalMesh& mesh);

  /// The triangle nearest to p, which is at most 2 away from the origin. The search passes over a
  /// box only where, with all its roundings, nothing nearer can be in it. O(log n) near the
  /// surface.
  /// @param hint  a triangle presumed near: saves time, never changes the result
  [[nodiscard]] Nearest nearest(Vec3d p, std::uint32_t hint) const;
  [[nodiscard]] Nearest nearest(Vec3d p) const { return search(p, {}); }

  /// Of p to one triangle; too large by rounding at most, see nearest_on_triangle().
  [[nodiscard]] double squared_distance(Vec3d p, std::uint32_t triangle) const {
    const auto [a, b, c] = corners(triangle);
    return squared_norm(p - nearest_on_triangle(p, a, b, c));
  }

  [[nodiscard]] std::array<Vec3d, 3> corners(std::uint32_t triangle) const {
    const auto& t = triangles_[triangle];
    return {vec(t[0]), vec(t[1]), vec(t[2])};
  }

  /// The triangle on the other side of the edge from corner `side` to the next; kNoTriangle where
  /// the edge does not have exactly two, oppositely oriented.
  [[nodiscard]] std::uint32_t neighbour(std::uint32_t triangle, std::size_t side) const {
    return neighbours_[triangle][side];
  }

 private:
  static constexpr std::size_t kChildren = 8;
  static constexpr std::uint32_t kIsTriangle = 0x80000000u;  // in Node::child
  struct Box {
    std::array<float, 3> low, high;
  };
  // GCC's and Clang's vectors: neither vectorises comparisons by itself where they may trap.
  using Floats = float __attribute__((vector_size(16)));
  struct Node {
    std::array<std::array<Floats, kChildren / 4>, 3> low, high;  // empty places: low > high
    std::array<std::uint32_t, kChildren> child;  // a node, or a triangle and kIsTriangle
  };
  struct Builder;
  [[nodiscard]] Nearest search(Vec3d p, Nearest best) const;

  std::vector<Node> nodes_;  // the root first
  std::vector<std::array<std::array<float, 3>, 3>> triangles_;
  std::vector<std::array<std::uint32_t, 3>> neighbours_;
};

}  // namespace palpate::bake
