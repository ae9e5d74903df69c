// SPDX-License-Identifier: GPL-3.0-or-later
// An order in which every beginning stands for all.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host_bake/metrics/vector.hpp"

namespace palpate::bake {

/// Places of points in an order of which every beginning is spread as all of them are: where they
/// lie twice as dense, it does too, so that a mean over a beginning is nearly the mean over all.
///
/// Each next point is the one to which all are nearest and those before it farthest, in the
/// potential 1 / sqrt(r^2 + near^2), each kind counting as one (kernel herding: Chen, Welling and
/// Smola 2010). Farthest points first spread evenly over space instead, and stay there too few
/// where points are dense.
/// @param near  below such distances points count as one place; > 0, in the points' units
/// @return of every point its place; each once. Deterministic, also across numbers of threads.
/// O(n^2)
std::vector<std::uint32_t> even_order(std::span<const Vec3d> points, double near);

}  // namespace palpate::bake
