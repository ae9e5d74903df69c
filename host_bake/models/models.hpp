// SPDX-License-Identifier: GPL-3.0-or-later
// Procedural benchmark models, after the paper's Table 2 and Appendix C.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "host_bake/mesh/mesh.hpp"

namespace palpate::bake {

struct ModelInfo {
  std::string_view name;
  std::size_t default_triangles;
  double radius_m;                ///< about; the real-world size of the thing
  std::string_view what;          ///< one line for --help
};

/// All models, in the order in which help lists them.
std::span<const ModelInfo> models();

/// Makes a model: closed, oriented outward, free of self-intersections, triangle count within 2 % of `triangles` (0: the
/// default). Pairs (jaw_lower and jaw_upper, ball_joint_head and _cup, golf_ball and golf_shell, screw and nut) share one
/// frame and interlock with a clearance of 0.2 to 1 % of the radius at their default counts and above 1000 triangles.
/// The same arguments give the same mesh on every machine with IEEE arithmetic.
/// Throws InputRefused for an unknown name or a count that the model cannot have (says the least one).
Mesh make_model(std::string_view name, std::size_t triangles = 0, std::uint64_t seed = 1);

}  // namespace palpate::bake
