// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify_random.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "decompose_shapes.hpp"
#include "host_bake/mesh/check.hpp"

namespace palpate::test {
namespace {

using namespace bake;

Mesh rounded_to(double step, Mesh mesh) {
  for (Point& p : mesh.points)
    for (double& x : p) x = step * std::round(x / step);
  return mesh;
}

Mesh shape_of(std::uint32_t kind, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  const double amplitude = std::pow(10.0, -4 * unit(random));
  const int size = 3 + static_cast<int>(5 * unit(random));
  const auto noise = [&](const Point&) { return amplitude * 0.3 * (unit(random) - 0.5); };
  switch (kind) {
    case 0:
      return bumpy_sphere(size, noise);
    case 1: {  // slivers
      Mesh mesh = bumpy_sphere(size, noise);
      for (Point& p : mesh.points) p[2] *= 0.02;
      return mesh;
    }
    case 2:  // coplanar regions with steps
      return block(size + 2,
                   [&](double x, double) { return 0.25 * std::floor(3 * x + amplitude); });
    case 3: {  // needles
      Mesh mesh = bumpy_sphere(size, noise);
      for (int i = 0; i < 3; ++i) {
        Point& p = mesh.points[random() % mesh.points.size()];
        for (double& x : p) x *= 1.5 + 2 * unit(random);
      }
      return mesh;
    }
    case 4: {  // components that touch or nearly do
      Mesh other = sphere(size);
      for (Point& p : other.points) p[0] += unit(random) < 0.5 ? 2.0 : 2.0 + 1e-6;
      return together(bumpy_sphere(size, [](const Point&) { return 0.0; }), other);
    }
    case 5: {  // holes
      Mesh mesh = bumpy_sphere(size, noise);
      std::erase_if(mesh.faces, [&](const Face&) { return unit(random) < 0.08; });
      return mesh;
    }
    case 6:  // many equal coordinates
      return rounded_to(0.125, bumpy_sphere(size, noise));
    default:
      return torus(size + 3, size + 2, 0.2 + 0.3 * unit(random), 0.1 * amplitude,
                   static_cast<std::uint32_t>(random()));
  }
}

}  // namespace

Mesh awkward_mesh(std::uint32_t seed) {
  std::mt19937 random(seed);
  Mesh mesh = shape_of(seed % 8, random);
  repair(mesh);
  return mesh;
}

}  // namespace palpate::test
