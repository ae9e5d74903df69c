// SPDX-License-Identifier: GPL-3.0-or-later
// FCL's queries between two meshes, with trees of oriented boxes and rectangle swept spheres.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "host_bake/mesh/mesh.hpp"
#include "rt_core/geometry/pose.hpp"

namespace palpate::bench {

/// Owns FCL's copies of two meshes.
class FclPair {
 public:
  FclPair(const bake::Mesh& a, const bake::Mesh& b);
  ~FclPair();
  FclPair(const FclPair&) = delete;
  FclPair& operator=(const FclPair&) = delete;

  /// The least distance, m; not positive where the surfaces cross.
  [[nodiscard]] double distance_m(const Pose& a, const Pose& b) const;

  /// How many pairs of triangles cross; at most `most` are looked for.
  [[nodiscard]] std::size_t crossings(const Pose& a, const Pose& b, std::size_t most) const;

 private:
  struct Models;
  std::unique_ptr<Models> models_;
};

}  // namespace palpate::bench
