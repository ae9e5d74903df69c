// SPDX-License-Identifier: GPL-3.0-or-later
// From two meshes to a scene that can be felt.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host_bake/base/error.hpp"
#include "tools/palpate/command.hpp"
#include "tools/palpate/motion_paths.hpp"

namespace palpate::cli {

struct NewSceneOptions {
  std::string tool, other;           ///< mesh files; may be one
  std::filesystem::path scene;       ///< to write; the images go beside it
  std::optional<double> unit_scale;  ///< metres of one unit of either file; absent: guessed
  unsigned threads = 0;              ///< 0: all cores
};

struct NewScene {
  /// The tool as it stands, in the coordinates of the other body, and the way to it.
  Waymark start;
  double slide_m = 0;  ///< across the approach, what a hand may slide and stay on the smaller body
  Vec3d across{};      ///< unit, of the slide
  std::vector<std::string> said;  ///< what was guessed, repaired and placed, a line each
};

/// Guesses the unit (guessed_unit_m), repairs what is safe, bakes both meshes for the regions
/// engine, places the tool one delta off the other along the direction in which both take least
/// room, and writes the scene last. Throws Failure and InputRefused.
NewScene make_scene(const NewSceneOptions& options, const bake::Progress& progress);

/// Adds --unit-scale as of NewSceneOptions.
void add_unit_scale(CLI::App& command, std::optional<double>& unit_scale);

}  // namespace palpate::cli
