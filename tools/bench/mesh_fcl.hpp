// SPDX-License-Identifier: GPL-3.0-or-later
// The distance of two meshes by FCL, to stand beside the region engine's on the same poses.
#pragma once

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

 private:
  struct Models;
  std::unique_ptr<Models> models_;
};

}  // namespace palpate::bench
