// SPDX-License-Identifier: GPL-3.0-or-later
// Judges levels of detail with the checks that meshes and decompositions go through.
#pragma once

#include <string>
#include <vector>

#include "host_bake/simplify/simplify.hpp"

namespace palpate::test {

/// A mesh checked, decomposed and simplified.
struct Simplified {
  bake::NormalMesh mesh;
  bake::CheckReport check;
  std::vector<bake::Patch> patches;
  std::vector<bake::SimplifiedLevel> levels;
  bake::SimplifyReport report;
};

Simplified simplified(const bake::Mesh& mesh, const bake::SimplifyOptions& options = {});

/// What is wrong with the levels, or nothing: manifold, oriented, Euler number, crossings, patches
/// and the three constraints, resolutions, heirs.
std::string judge_levels(const Simplified& result);

}  // namespace palpate::test
