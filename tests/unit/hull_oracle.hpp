// SPDX-License-Identifier: GPL-3.0-or-later
// An independent judge of hulls: whole numbers and brute force.
#pragma once

#include <span>
#include <string>

#include "host_bake/hull/hull.hpp"

namespace palpate::test {

/// Sign of ((b - a) x (c - a)) . (d - a), exactly.
int exact_side(const bake::PointF& a, const bake::PointF& b, const bake::PointF& c,
               const bake::PointF& d);

/// Exactly in line.
bool in_line(const bake::PointF& a, const bake::PointF& b, const bake::PointF& c);

/// What is wrong with the hull of the points, or nothing: dimension, closedness, orientation, every
/// point inside, extreme vertices only, order.
std::string judge_hull(std::span<const bake::PointF> points, const bake::HullMesh& hull);

}  // namespace palpate::test
