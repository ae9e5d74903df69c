// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts of two meshes by Bullet's GImpact, to stand beside Palpate's on the same poses.
#pragma once

#include <cstddef>
#include <memory>

#include "host_bake/mesh/mesh.hpp"
#include "rt_core/geometry/pose.hpp"

namespace palpate::bench {

/// What Bullet finds; NaN: it found nothing.
struct BulletContacts {
  std::size_t count = 0;
  double least_distance_m = 0;
};

/// Two meshes with GImpact's quantized box trees. Bullet computes in float32 and in units of about
/// one, so the meshes are scaled to millimetres for it.
class BulletPair {
 public:
  /// @param delta_m  half of it is the collision margin of each mesh
  BulletPair(const bake::Mesh& a, const bake::Mesh& b, double delta_m);
  ~BulletPair();

  /// Contact points of pairs of triangles that overlap when each is made thicker by half of delta:
  /// by clipping one triangle at the other's edge planes, so that a distance is one along a
  /// triangle's normal.
  [[nodiscard]] BulletContacts contacts(const Pose& a, const Pose& b);

 private:
  struct World;
  std::unique_ptr<World> world_;
};

}  // namespace palpate::bench
