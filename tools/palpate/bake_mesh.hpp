// SPDX-License-Identifier: GPL-3.0-or-later
// From a mesh that has been read to the bytes of an image.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "host_bake/bake.hpp"
#include "host_bake/mesh/read.hpp"

namespace palpate::cli {

struct Baked {
  std::vector<std::byte> bytes;
  bake::Welded welded;               ///< of the mesh as it was read
  std::vector<std::string> repairs;  ///< what was done, a line each
  bake::BakeReport report;
};

struct BakeRules {
  bool repair = false;  ///< what a safe repair can fix
  bool strict = false;  ///< refuse a mesh whose faces cross one another
};

/// @param file  of the mesh, for errors
/// Throws InputRefused where the mesh cannot be baked.
Baked bake_mesh(bake::ReadMesh read, const std::string& file, const BakeRules& rules,
                bake::BakeOptions how, const bake::Progress& progress);

}  // namespace palpate::cli
