// SPDX-License-Identifier: GPL-3.0-or-later
// Closed triangle meshes lofted over rows of vertices: all procedural models are made of it. A
// surface is a family of closed curves; a row is one of them with some number of vertices on it;
// neighbouring rows are zipped together. Because F = 2 V - 4 (F = 2 V for a torus) holds for every
// such mesh, a wanted number of triangles is met by sharing out vertices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "host_bake/mesh/mesh.hpp"

namespace palpate::bake {

/// One closed curve of a surface: point (metres) at u, period 1.
using Curve = std::function<Point(double u)>;

/// The curve at v. Curves at different v must not meet, but at a pole, where the curve is one
/// point.
using Surface = std::function<Curve(double v)>;

/// Vertices at u = shift + i / count on the curve at v.
struct Row {
  double v = 0;
  std::uint32_t count = 1;  ///< 1: a pole; else at least 3
  double shift = 0;         ///< turns
};

enum class Last { ring, pole };

/// Rows at v in (v0, v1], v0 < v1, that spread `vertices` evenly over the surface between (about
/// equilateral triangles), with `last` saying what the row at v1 is. The rows hold exactly
/// `vertices` vertices where that many suffice for three a row. Depends on nothing but its
/// arguments: two surfaces given the same rows are triangulated alike, which is how mating parts
/// keep their clearance at every triangle count. Cost: 33,000 evaluations of the surface.
std::vector<Row> plan_rows(const Surface& surface, double v0, double v1, std::size_t vertices,
                           Last last);

/// Rows from a pole at v0 to a pole at v1, `vertices` in all.
std::vector<Row> plan_body(const Surface& surface, double v0, double v1, std::size_t vertices);

void append(std::vector<Row>& rows, std::span<const Row> more);

enum class Ends { poles, joined };  ///< joined: the last row is zipped to the first one (a torus)

/// The mesh over the rows, outward oriented (positive volume). Coordinates are multiples of 2^-35 m
/// (3e-11 m), so that compilers that round differently by a last bit still give the same numbers,
/// but at ties. Between two rows the shorter diagonals are taken; over rows of a sphere this is its
/// Delaunay triangulation, hence convex.
Mesh loft(const Surface& surface, std::span<const Row> rows, Ends ends);

}  // namespace palpate::bake
