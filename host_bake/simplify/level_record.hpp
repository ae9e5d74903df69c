// SPDX-License-Identifier: GPL-3.0-or-later
// Levels of detail taken out of the process as it goes.
#pragma once

#include <cstdint>
#include <vector>

#include "host_bake/simplify/patch_lists.hpp"
#include "host_bake/simplify/simplify.hpp"
#include "host_bake/simplify/surface.hpp"

namespace palpate::bake {

class LevelRecord {
 public:
  LevelRecord(const NormalMesh& original, std::uint32_t patches);

  /// A vertex or face has gone, another one stands for it.
  void vertex_went(std::uint32_t vertex, std::uint32_t heir) { vertex_heir_[vertex] = heir; }
  void face_went(std::uint32_t face, std::uint32_t heir) { face_heir_[face] = heir; }

  /// The surface as it is now.
  SimplifiedLevel take(const Surface& surface, const PatchLists& patches, double resolution);

 private:
  const NormalMesh& original_;
  std::vector<std::uint32_t> vertex_heir_, face_heir_;
  std::vector<std::uint32_t> vertices_, faces_, patches_;  // of the last level, in the surface
};

}  // namespace palpate::bake
