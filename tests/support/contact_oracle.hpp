// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts and wrench of docs/CONTACT.md by trying everything, written from that page: an oracle
// that shares no code with the engine. Section numbers are that page's.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "rt_core/geometry/pose.hpp"
#include "rt_core/image/view.hpp"

namespace palpate::test {

/// The baked surface of a body, from the positions and corners in its image alone. Lengths in
/// metres, origin at the body's.
class OracleSurface {
 public:
  /// @param image  with surface sections
  explicit OracleSurface(const ImageView& image);
  ~OracleSurface();
  OracleSurface(const OracleSurface&) = delete;
  OracleSurface& operator=(const OracleSurface&) = delete;

  struct Triangle {
    std::array<std::uint32_t, 3> corner{};
    std::array<std::uint32_t, 3> edge{};  ///< from corner i to i + 1
    Vec3d normal{};                       ///< unit; 0 of a sliver
    bool crosses = false;  ///< has no inside: all its corners are of faces that cross
  };
  struct Edge {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    std::vector<std::uint32_t> faces;
    bool convex = false;
    bool concave = false;
  };
  struct Vertex {
    Vec3d position{};
    std::vector<Vec3d> normals;          ///< of its faces
    std::vector<Vec3d> concave_normals;  ///< of faces beside its concave edges
    Vec3d pseudonormal{};                ///< 0: borders and crossing faces meet here
  };
  std::vector<Triangle> triangles;
  std::vector<Edge> edges;
  std::vector<Vertex> vertices;
  bool open = false;
  double solid_depth_m = 0;  ///< T of Sec. 2.3

  struct Tree;
  std::unique_ptr<Tree> tree;

 private:
  void read_triangles(const ImageView& image);
  void link_edges(const ImageView& image);
  void bend(Edge& edge, std::uint32_t opposite) const;
  void gather_normals(const ImageView& image);
  void build_tree();
};

/// The wrench on a, the tool, about its origin, world axes; each contact counts in the torque
/// (cluster radius 0).
/// @param delta_m  contact tolerance, > 0  @param stiffness_N_per_m  >= 0
/// Cost: every vertex and convex edge of each body asks for closest points of the other; the least
/// push is solved densely for all contacts. Departures from the page: there is no limit of ways and
/// contacts of one vertex.
Wrench contact_oracle(const OracleSurface& a, const Pose& pose_a, const OracleSurface& b,
                      const Pose& pose_b, double delta_m, double stiffness_N_per_m);

}  // namespace palpate::test
