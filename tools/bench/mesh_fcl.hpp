// SPDX-License-Identifier: GPL-3.0-or-later
// Distance and collision of two meshes by FCL, to stand beside Palpate's on the same poses.
#pragma once

#include <cstddef>
#include <memory>

#include "host_bake/mesh/mesh.hpp"
#include "rt_core/geometry/pose.hpp"

namespace palpate::bench {

/// Two meshes with FCL's tree of OBBs and rectangle swept spheres, its fastest for distances.
class FclPair {
 public:
  FclPair(const bake::Mesh& a, const bake::Mesh& b);
  ~FclPair();
  /// One least distance, in metres, without points; exact, cold as every query of FCL.
  [[nodiscard]] double distance(const Pose& a, const Pose& b) const;

  /// How many pairs of triangles cross; at most `most` are looked for.
  [[nodiscard]] std::size_t crossings(const Pose& a, const Pose& b, std::size_t most) const;

 private:
  struct Models;
  std::unique_ptr<Models> models_;
};

}  // namespace palpate::bench
