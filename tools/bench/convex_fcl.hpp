// SPDX-License-Identifier: GPL-3.0-or-later
// FCL's convex distance by libccd, on the hulls of a motion.
#pragma once

#include <cstdint>
#include <memory>

#include "tools/bench/convex_motions.hpp"

namespace palpate::bench {

/// What a peer answers: distance and two witnesses in the coordinates of a.
struct PeerAnswer {
  double distance = 0;
  Vec3d point_a{};
  Vec3d point_b{};
};

/// Owns FCL's copies of the hulls and poses of one motion.
class FclMotion {
 public:
  explicit FclMotion(const Motion& motion);
  ~FclMotion();
  FclMotion(FclMotion&&) noexcept;
  FclMotion& operator=(FclMotion&&) = delete;

  [[nodiscard]] PeerAnswer distance(std::uint32_t pose) const;

 private:
  struct Shapes;
  std::unique_ptr<Shapes> shapes_;
};

}  // namespace palpate::bench
