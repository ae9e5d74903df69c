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
  std::size_t least_triangles;  ///< with fewer the shape would not hold
  double radius_m;              ///< about; the real-world size of the thing
  std::string_view what;        ///< one line for --help
};

/// More are refused.
inline constexpr std::size_t kMostModelTriangles = 20'000'000;

/// All models, in the order in which help lists them.
std::span<const ModelInfo> models();

/// Makes a model, about its own origin, metres: closed, one component, oriented outward, free of
/// self-intersections; genus 0 but for the nut (a torus). The triangle count is the asked-for one
/// (0: the default), rounded down to an even number.
///
/// Pairs (jaw_lower and jaw_upper, ball_joint_head and _cup, golf_ball and golf_shell, screw and
/// nut) of one seed share one frame and interlock without touching. Their least distance is 0.2 to
/// 1 % of the radius of either: at the default counts, at any equal counts, and at any two counts
/// of 20,000 or more. At equal counts mating surfaces are triangulated alike, so that even coarse
/// ones keep apart; unequal coarse ones may cross.
///
/// The same arguments give the same mesh on every machine with IEEE arithmetic: no function of the
/// C library but sqrt and floor, no contraction, coordinates rounded to 2^-35 m (3e-11 m).
/// The seed changes textures and places: the ellipsoid has none.
/// Cost: about a microsecond a triangle; memory about 60 bytes a triangle.
/// Throws InputRefused for an unknown name or a count outside [least_triangles,
/// kMostModelTriangles].
Mesh make_model(std::string_view name, std::size_t triangles = 0, std::uint64_t seed = 1);

}  // namespace palpate::bake
