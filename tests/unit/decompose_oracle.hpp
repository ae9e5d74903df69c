// SPDX-License-Identifier: GPL-3.0-or-later
// An independent judge of hulls and patches: whole numbers, brute force, sampling. It shares no
// code with what it judges.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host_bake/decompose/decompose.hpp"

namespace palpate::test {

/// Sign of ((b - a) x (c - a)) . (d - a), exactly.
int exact_side(const bake::PointF& a, const bake::PointF& b, const bake::PointF& c,
               const bake::PointF& d);

/// Exactly in line.
bool in_line(const bake::PointF& a, const bake::PointF& b, const bake::PointF& c);

/// What is wrong with the hull of the points, or nothing: dimension, closedness, orientation, every
/// point inside, extreme vertices only, order.
std::string judge_hull(std::span<const bake::PointF> points, const bake::HullMesh& hull);

/// What is wrong with a decomposition, or nothing: the partition, the three constraints, hulls,
/// virtual faces, flags; with `connected` also that the faces of a patch hang together over edges.
std::string judge_patches(const bake::NormalMesh& mesh, const bake::CheckReport& report,
                          const std::vector<bake::Patch>& patches, bool connected = true);

}  // namespace palpate::test
