// SPDX-License-Identifier: GPL-3.0-or-later
#include "decompose_shapes.hpp"

#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <utility>

namespace palpate::test {
namespace {

using bake::Mesh;
using bake::Point;

/// Vertices named by integer positions.
class Lattice {
 public:
  explicit Lattice(Mesh& mesh) : mesh_(mesh) {}
  template <class Place>
  std::uint32_t at(std::array<int, 3> key, Place place) {
    const auto [entry, fresh] =
        index_.try_emplace(key, static_cast<std::uint32_t>(mesh_.points.size()));
    if (fresh) mesh_.points.push_back(place(key));
    return entry->second;
  }

 private:
  Mesh& mesh_;
  std::map<std::array<int, 3>, std::uint32_t> index_;
};

void add_quad(Mesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  mesh.faces.push_back({a, b, c});
  mesh.faces.push_back({a, c, d});
}

}  // namespace

Mesh bumpy_sphere(int n, const std::function<double(const Point&)>& height) {
  Mesh mesh;
  Lattice lattice(mesh);
  const auto place = [&](std::array<int, 3> k) {
    const Point p = {double(k[0]), double(k[1]), double(k[2])};
    const double length = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    const Point u = {p[0] / length, p[1] / length, p[2] / length};
    const double r = 1 + height(u);
    return Point{r * u[0], r * u[1], r * u[2]};
  };
  for (int octant = 0; octant < 8; ++octant) {
    const int x = (octant & 1) != 0 ? -1 : 1;
    const int y = (octant & 2) != 0 ? -1 : 1;
    const int z = (octant & 4) != 0 ? -1 : 1;
    const auto vertex = [&](int i, int j) {
      return lattice.at({x * i, y * j, z * (n - i - j)}, place);
    };
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      if (x * y * z < 0) std::swap(b, c);
      mesh.faces.push_back({a, b, c});
    };
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        add(vertex(i, j), vertex(i + 1, j), vertex(i, j + 1));
        if (i + j + 1 < n) add(vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1));
      }
  }
  return mesh;
}

Mesh sphere(int n, Point scale) {
  Mesh mesh = bumpy_sphere(n, [](const Point&) { return 0.0; });
  for (Point& p : mesh.points)
    for (std::size_t i = 0; i < 3; ++i) p[i] *= scale[i];
  return mesh;
}

Mesh open_hemisphere(int n) {
  Mesh mesh = sphere(n);
  std::erase_if(mesh.faces, [&](const bake::Face& f) {
    return mesh.points[f[0]][2] + mesh.points[f[1]][2] + mesh.points[f[2]][2] < 0;
  });
  return mesh;
}

Mesh torus(int around, int along, double tube, double noise, std::uint32_t seed) {
  Mesh mesh;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(-noise, noise);
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < along; ++j) {
      const double a = 2 * std::numbers::pi * i / around;
      const double b = 2 * std::numbers::pi * j / along;
      const double r = tube + (noise > 0 ? jitter(random) : 0);
      mesh.points.push_back({(1 + r * std::cos(b)) * std::cos(a),
                             (1 + r * std::cos(b)) * std::sin(a), r * std::sin(b)});
    }
  const auto vertex = [&](int i, int j) {
    return static_cast<std::uint32_t>((i % around) * along + j % along);
  };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < along; ++j)
      add_quad(mesh, vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1));
  return mesh;
}

Mesh cylinder(int sides) {
  Mesh mesh;
  for (const double z : {-1.0, 1.0})
    for (int i = 0; i < sides; ++i) {
      const double a = 2 * std::numbers::pi * i / sides;
      mesh.points.push_back({std::cos(a), std::sin(a), z});
    }
  const auto n = static_cast<std::uint32_t>(sides);
  for (std::uint32_t i = 0; i < n; ++i) add_quad(mesh, i, (i + 1) % n, n + (i + 1) % n, n + i);
  for (std::uint32_t i = 1; i + 1 < n; ++i) {
    mesh.faces.push_back({0, i + 1, i});
    mesh.faces.push_back({n, n + i, n + i + 1});
  }
  return mesh;
}

Mesh voxels(const std::vector<std::array<int, 3>>& cells) {
  Mesh mesh;
  Lattice lattice(mesh);
  const std::set<std::array<int, 3>> solid(cells.begin(), cells.end());
  const auto place = [](std::array<int, 3> k) {
    return Point{double(k[0]), double(k[1]), double(k[2])};
  };
  for (const std::array<int, 3>& cell : solid)
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const int side : {0, 1}) {
        std::array<int, 3> beyond = cell;
        beyond[axis] += 2 * side - 1;
        if (solid.contains(beyond)) continue;
        const auto corner = [&](int u, int v) {
          std::array<int, 3> k = cell;
          k[axis] += side;
          k[(axis + 1) % 3] += u;
          k[(axis + 2) % 3] += v;
          return lattice.at(k, place);
        };
        if (side == 1)
          add_quad(mesh, corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1));
        else
          add_quad(mesh, corner(0, 0), corner(0, 1), corner(1, 1), corner(1, 0));
      }
  return mesh;
}

Mesh block(int n, const std::function<double(double, double)>& height) {
  Mesh mesh;
  Lattice lattice(mesh);
  const auto place = [&](std::array<int, 3> k) {
    const double x = 2.0 * k[0] / n - 1;
    const double y = 2.0 * k[1] / n - 1;
    return Point{x, y, k[2] == 1 ? height(x, y) : -1.0};
  };
  const auto vertex = [&](int i, int j, int level) { return lattice.at({i, j, level}, place); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      add_quad(mesh, vertex(i, j, 1), vertex(i + 1, j, 1), vertex(i + 1, j + 1, 1),
               vertex(i, j + 1, 1));
      add_quad(mesh, vertex(i, j, 0), vertex(i, j + 1, 0), vertex(i + 1, j + 1, 0),
               vertex(i + 1, j, 0));
    }
  for (int i = 0; i < n; ++i) {
    add_quad(mesh, vertex(i, 0, 0), vertex(i + 1, 0, 0), vertex(i + 1, 0, 1), vertex(i, 0, 1));
    add_quad(mesh, vertex(i + 1, n, 0), vertex(i, n, 0), vertex(i, n, 1), vertex(i + 1, n, 1));
    add_quad(mesh, vertex(0, i + 1, 0), vertex(0, i, 0), vertex(0, i, 1), vertex(0, i + 1, 1));
    add_quad(mesh, vertex(n, i, 0), vertex(n, i + 1, 0), vertex(n, i + 1, 1), vertex(n, i, 1));
  }
  return mesh;
}

bake::NormalMesh as_is(const Mesh& mesh) {
  bake::NormalMesh normal;
  normal.faces = mesh.faces;
  normal.radius_m = 1;
  for (const Point& p : mesh.points)
    normal.points.push_back(
        {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
  return normal;
}

bake::CheckReport sound_report(const bake::NormalMesh& mesh) {
  bake::CheckReport report;
  report.vertices = mesh.points.size();
  report.faces = mesh.faces.size();
  report.components = report.closed_components = 1;
  report.face_component.assign(mesh.faces.size(), 0);
  report.component_closed.assign(1, 1);
  return report;
}

}  // namespace palpate::test
