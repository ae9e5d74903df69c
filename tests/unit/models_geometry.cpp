// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/models_geometry.hpp"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>
#include <vector>

namespace palpate::test {
namespace {

using bake::Face;
using bake::Mesh;
using bake::Point;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using SurfaceMesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Primitive = CGAL::AABB_face_graph_triangle_primitive<SurfaceMesh>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

SurfaceMesh to_cgal(const Mesh& mesh) {
  SurfaceMesh out;
  for (const Point& p : mesh.points) out.add_vertex(Kernel::Point_3(p[0], p[1], p[2]));
  using Vertex = SurfaceMesh::Vertex_index;
  for (const Face& f : mesh.faces) out.add_face(Vertex(f[0]), Vertex(f[1]), Vertex(f[2]));
  return out;
}

double distance(const Point& a, const Point& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Half-edges (from, to, face), sorted.
struct HalfEdge {
  std::uint32_t from, to;
  std::size_t face;
  bool operator<(const HalfEdge& o) const { return std::pair(from, to) < std::pair(o.from, o.to); }
};

std::vector<HalfEdge> half_edges(const Mesh& mesh) {
  std::vector<HalfEdge> edges;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      edges.push_back({mesh.faces[f][k], mesh.faces[f][(k + 1) % 3], f});
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

/// Index of the half-edge from -> to, or edges.size().
std::size_t find(const std::vector<HalfEdge>& edges, std::uint32_t from, std::uint32_t to) {
  const HalfEdge wanted{from, to, 0};
  const auto at = std::lower_bound(edges.begin(), edges.end(), wanted);
  if (at == edges.end() || wanted < *at) return edges.size();
  return static_cast<std::size_t>(at - edges.begin());
}

class Components {
 public:
  explicit Components(std::size_t count) : parent_(count), count_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    a = root(a);
    b = root(b);
    if (a == b) return;
    parent_[a] = b;
    --count_;
  }
  [[nodiscard]] std::size_t count() const { return count_; }

 private:
  std::vector<std::size_t> parent_;
  std::size_t count_;
};

/// The vertex of a face that is neither of the two.
std::uint32_t apex(const Face& face, std::uint32_t a, std::uint32_t b) {
  return face[0] + face[1] + face[2] - a - b;
}

/// The faces around each vertex, walked over edges, are all the faces at it.
bool one_fan_each(const Mesh& mesh, const std::vector<HalfEdge>& edges) {
  std::vector<std::size_t> faces_at(mesh.points.size(), 0);
  std::vector<std::size_t> start(mesh.points.size(), edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    ++faces_at[edges[e].from];
    start[edges[e].from] = e;
  }
  for (std::uint32_t v = 0; v < mesh.points.size(); ++v) {
    if (start[v] == edges.size()) return false;
    std::size_t walked = 0;
    std::size_t e = start[v];
    do {
      e = find(edges, v, apex(mesh.faces[edges[e].face], v, edges[e].to));
      if (e == edges.size() || ++walked > faces_at[v]) return false;
    } while (e != start[v]);
    if (walked != faces_at[v]) return false;
  }
  return true;
}

double least_to(const Mesh& from, const Tree& tree) {
  double least = 1e300;
  const auto probe = [&](const Point& p) {
    const Kernel::Point_3 at(p[0], p[1], p[2]);
    least = std::min(least, CGAL::squared_distance(at, tree.closest_point(at)));
  };
  for (const Point& p : from.points) probe(p);
  for (const Face& f : from.faces) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Point& a = from.points[f[k]];
      const Point& b = from.points[f[(k + 1) % 3]];
      if (f[k] < f[(k + 1) % 3]) {
        probe({(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2});
      }
    }
  }
  return std::sqrt(least);
}

}  // namespace

Topology topology(const Mesh& mesh) {
  const std::vector<HalfEdge> edges = half_edges(mesh);
  Topology t;
  t.closed_manifold = !edges.empty();
  Components components(mesh.points.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const bool repeated = e > 0 && !(edges[e - 1] < edges[e]);
    const bool lonely = find(edges, edges[e].to, edges[e].from) == edges.size();
    if (repeated || lonely || edges[e].from == edges[e].to) t.closed_manifold = false;
    components.join(edges[e].from, edges[e].to);
  }
  t.closed_manifold = t.closed_manifold && one_fan_each(mesh, edges);
  t.components = components.count();
  t.euler = static_cast<std::int64_t>(mesh.points.size() + mesh.faces.size()) -
            static_cast<std::int64_t>(edges.size() / 2);
  for (const Face& f : mesh.faces) {
    const Point& a = mesh.points[f[0]];
    const Point& b = mesh.points[f[1]];
    const Point& c = mesh.points[f[2]];
    t.volume_m3 += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                    a[2] * (b[0] * c[1] - b[1] * c[0])) /
                   6.0;
  }
  return t;
}

std::size_t self_crossings(const Mesh& mesh) {
  const SurfaceMesh surface = to_cgal(mesh);
  if (surface.number_of_faces() != mesh.faces.size()) return mesh.faces.size();
  std::vector<std::pair<SurfaceMesh::Face_index, SurfaceMesh::Face_index>> pairs;
  CGAL::Polygon_mesh_processing::self_intersections(surface, std::back_inserter(pairs));
  return pairs.size();
}

std::size_t edges_not_convex(const Mesh& mesh) {
  const auto at = [&](std::uint32_t v) {
    return Kernel::Point_3(mesh.points[v][0], mesh.points[v][1], mesh.points[v][2]);
  };
  const std::vector<HalfEdge> edges = half_edges(mesh);
  std::size_t bad = 0;
  for (const HalfEdge& e : edges) {
    const std::size_t twin = find(edges, e.to, e.from);
    const std::uint32_t here = apex(mesh.faces[e.face], e.from, e.to);
    const std::uint32_t there = apex(mesh.faces[edges.at(twin).face], e.from, e.to);
    if (CGAL::orientation(at(e.from), at(e.to), at(here), at(there)) != CGAL::NEGATIVE) ++bad;
  }
  return bad;
}

double radius_m(const Mesh& mesh) {
  // Badoiu and Clarkson, "Smaller core-sets for balls", 2003: step towards the farthest point.
  Point centre = mesh.points.front();
  double radius = 0.0;
  for (int step = 1; step <= 400; ++step) {
    const auto farthest = std::max_element(
        mesh.points.begin(), mesh.points.end(),
        [&](const Point& a, const Point& b) { return distance(a, centre) < distance(b, centre); });
    radius = distance(*farthest, centre);
    for (std::size_t k = 0; k < 3; ++k) centre[k] += ((*farthest)[k] - centre[k]) / (step + 1.0);
  }
  return radius;
}

Clearance clearance(const Mesh& a, const Mesh& b) {
  const SurfaceMesh surface_a = to_cgal(a);
  const SurfaceMesh surface_b = to_cgal(b);
  Tree tree_a(faces(surface_a).begin(), faces(surface_a).end(), surface_a);
  Tree tree_b(faces(surface_b).begin(), faces(surface_b).end(), surface_b);
  Clearance c;
  for (const Face& f : a.faces) {
    const auto at = [&](std::size_t k) {
      const Point& p = a.points[f[k]];
      return Kernel::Point_3(p[0], p[1], p[2]);
    };
    if (tree_b.do_intersect(Kernel::Triangle_3(at(0), at(1), at(2)))) ++c.crossings;
  }
  c.least_m = std::min(least_to(a, tree_b), least_to(b, tree_a));
  return c;
}

std::uint64_t fingerprint(const Mesh& mesh) {
  std::uint64_t hash = 0xCBF29CE484222325U;
  const auto add = [&](std::uint64_t value) {
    for (unsigned shift = 0; shift < 64; shift += 8) {
      hash = (hash ^ ((value >> shift) & 0xFFU)) * 0x100000001B3U;
    }
  };
  for (const Point& p : mesh.points) {
    for (const double c : p) add(static_cast<std::uint64_t>(std::llround(c * 0x1p35)));
  }
  for (const Face& f : mesh.faces) {
    for (const std::uint32_t v : f) add(v);
  }
  return hash;
}

}  // namespace palpate::test
