// SPDX-License-Identifier: GPL-3.0-or-later
// Small procedural meshes for tests.
#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>

#include "host_bake/mesh/mesh.hpp"

namespace palpate::test {

using bake::Mesh;

/// A sphere cut along latitudes and longitudes, radius scaled by bumps(latitude, longitude);
/// closed, outward.
template <class Bumps>
Mesh sphere(std::uint32_t rings, std::uint32_t sectors, double radius, Bumps bumps) {
  Mesh m;
  const auto put = [&](double theta, double phi) {
    const double r = radius * bumps(theta, phi);
    m.points.push_back({r * std::sin(theta) * std::cos(phi), r * std::sin(theta) * std::sin(phi),
                        r * std::cos(theta)});
  };
  put(0, 0);
  for (std::uint32_t i = 1; i < rings; ++i) {
    for (std::uint32_t j = 0; j < sectors; ++j) {
      put(std::numbers::pi * i / rings, 2 * std::numbers::pi * j / sectors);
    }
  }
  put(std::numbers::pi, 0);
  const auto at = [&](std::uint32_t ring, std::uint32_t j) {
    return 1 + (ring - 1) * sectors + j % sectors;
  };
  const auto last = static_cast<std::uint32_t>(m.points.size() - 1);
  for (std::uint32_t j = 0; j < sectors; ++j) {
    m.faces.push_back({0, at(1, j), at(1, j + 1)});
    m.faces.push_back({last, at(rings - 1, j + 1), at(rings - 1, j)});
    for (std::uint32_t i = 1; i + 1 < rings; ++i) {
      m.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      m.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return m;
}

inline Mesh ball(std::uint32_t rings, std::uint32_t sectors, double radius) {
  return sphere(rings, sectors, radius, [](double, double) { return 1.0; });
}

/// A ball with dents and bumps: many small pieces.
inline Mesh bumpy_ball(std::uint32_t rings, std::uint32_t sectors, double radius) {
  return sphere(rings, sectors, radius, [](double t, double p) {
    return 1.0 + 0.08 * std::sin(5 * t + 1) * std::sin(4 * p) +
           0.03 * std::cos(9 * t) * std::cos(7 * p + 2);
  });
}

/// A ring (torus), outward.
inline Mesh ring(std::uint32_t around, std::uint32_t tube, double radius, double tube_radius) {
  Mesh m;
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < tube; ++j) {
      const double u = 2 * std::numbers::pi * i / around;
      const double v = 2 * std::numbers::pi * j / tube;
      const double r = radius + tube_radius * std::cos(v);
      m.points.push_back({r * std::cos(u), r * std::sin(u), tube_radius * std::sin(v)});
    }
  }
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return i % around * tube + j % tube; };
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < tube; ++j) {
      m.faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      m.faces.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return m;
}

/// The lower half of a ball without its lid: an open bowl, faces outward.
inline Mesh bowl(std::uint32_t rings, std::uint32_t sectors, double radius) {
  Mesh whole = ball(2 * rings, sectors, radius);
  Mesh m;
  m.points = whole.points;
  for (const bake::Face& f : whole.faces) {
    bool low = true;
    for (const std::uint32_t v : f) low = low && whole.points[v][2] < 1e-9 * radius;
    if (low) m.faces.push_back(f);
  }
  return m;
}

inline Mesh box(double x, double y, double z) {
  Mesh m;
  for (int i = 0; i < 8; ++i)
    m.points.push_back({(i & 1) ? x : -x, (i & 2) ? y : -y, (i & 4) ? z : -z});
  m.faces = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
             {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return m;
}

/// Every triangle cut in four, across the middles of its edges: the same surface.
inline Mesh quartered(const Mesh& coarse, int times) {
  if (times == 0) return coarse;
  Mesh fine{coarse.points, {}};
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [at, added] = middles.try_emplace(std::minmax(a, b), fine.points.size());
    const bake::Point &p = coarse.points[a], &q = coarse.points[b];
    if (added)
      fine.points.push_back({0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1]), 0.5 * (p[2] + q[2])});
    return at->second;
  };
  for (const auto& [a, b, c] : coarse.faces) {
    const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    fine.faces.insert(fine.faces.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return quartered(fine, times - 1);
}

/// Along x, closed.
inline Mesh cylinder(std::uint32_t sides, double radius, double half_length) {
  Mesh m;
  for (const double x : {-half_length, half_length}) {
    for (std::uint32_t k = 0; k < sides; ++k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      m.points.push_back({x, radius * std::cos(angle), radius * std::sin(angle)});
    }
  }
  for (std::uint32_t k = 0; k < sides; ++k) {
    const std::uint32_t next = (k + 1) % sides;
    m.faces.push_back({k, next, sides + next});
    m.faces.push_back({k, sides + next, sides + k});
  }
  for (std::uint32_t k = 1; k + 1 < sides; ++k) {
    m.faces.push_back({0, k + 1, k});
    m.faces.push_back({sides, sides + k, sides + k + 1});
  }
  return m;
}

/// Along x, closed: as parts come out of CAD, its flanks are needles from one end to the other.
inline Mesh gear(std::uint32_t teeth, double radius, double half_length) {
  constexpr std::uint32_t kSidesOfTooth = 8;
  const std::uint32_t sides = kSidesOfTooth * teeth;
  Mesh m;
  for (const double x : {-half_length, half_length}) {
    for (std::uint32_t k = 0; k < sides; ++k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      const double r = radius * (1 + 0.08 * std::cos(teeth * angle));
      m.points.push_back({x, r * std::cos(angle), r * std::sin(angle)});
    }
  }
  m.points.push_back({-half_length, 0, 0});
  m.points.push_back({half_length, 0, 0});
  for (std::uint32_t k = 0; k < sides; ++k) {
    const std::uint32_t next = (k + 1) % sides;
    m.faces.push_back({k, next, sides + next});
    m.faces.push_back({k, sides + next, sides + k});
    m.faces.push_back({2 * sides, next, k});
    m.faces.push_back({2 * sides + 1, sides + k, sides + next});
  }
  return m;
}

inline void append(Mesh& to, const Mesh& from, double dx, double dy, double dz) {
  const auto base = static_cast<std::uint32_t>(to.points.size());
  for (const bake::Point& p : from.points) to.points.push_back({p[0] + dx, p[1] + dy, p[2] + dz});
  for (const bake::Face& f : from.faces)
    to.faces.push_back({f[0] + base, f[1] + base, f[2] + base});
}

inline Mesh scaled(Mesh m, double s) {
  for (bake::Point& p : m.points) {
    for (double& c : p) c *= s;
  }
  return m;
}

}  // namespace palpate::test
