// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/models/models.hpp"

#include <array>
#include <string>

#include "host_bake/base/error.hpp"
#include "host_bake/models/shapes.hpp"

namespace palpate::bake {
namespace {

using Shape = Mesh (*)(std::size_t triangles, std::uint64_t seed);

constexpr std::array<ModelInfo, 10> kModels{{
    {"golf_ball", 177'876, 200, 0.0214, "ball with 336 dimples"},
    {"golf_shell", 177'876, 1'000, 0.0256, "open shell around golf_ball, dimpled to match"},
    {"golf_club", 104'888, 1'000, 0.060, "iron with a grooved face, hosel and rough back"},
    {"ball_joint_head", 137'060, 1'000, 0.025, "bone-like ball with a neck"},
    {"ball_joint_cup", 137'060, 1'000, 0.020, "socket around ball_joint_head"},
    {"jaw_lower", 40'180, 1'000, 0.035, "dental arch with teeth and gums"},
    {"jaw_upper", 47'339, 1'000, 0.035, "the other arch, its teeth between those of jaw_lower"},
    {"ellipsoid", 2'000, 100, 0.020, "convex, semi-axes 20, 12 and 8 mm"},
    {"screw", 40'000, 1'000, 0.0094, "screw with six turns of thread and a knurled head"},
    {"nut", 40'000, 1'000, 0.008, "hexagonal nut on the thread of screw"},
}};

constexpr std::array<Shape, kModels.size()> kShapes{
    golf_ball, golf_shell, golf_club, ball_joint_head, ball_joint_cup,
    jaw_lower, jaw_upper,  ellipsoid, screw,           nut};

}  // namespace

std::span<const ModelInfo> models() { return kModels; }

Mesh make_model(std::string_view name, std::size_t triangles, std::uint64_t seed) {
  for (std::size_t i = 0; i < kModels.size(); ++i) {
    const ModelInfo& model = kModels[i];
    if (model.name != name) continue;
    const std::size_t wanted = triangles == 0 ? model.default_triangles : triangles;
    if (wanted < model.least_triangles || wanted > kMostModelTriangles) {
      throw InputRefused("impossible triangle count", std::to_string(wanted),
                         "choose " + std::to_string(model.least_triangles) + " to " +
                             std::to_string(kMostModelTriangles));
    }
    return kShapes[i](wanted, seed);
  }
  throw InputRefused("unknown model", std::string(name), "see make-model --help");
}

}  // namespace palpate::bake
