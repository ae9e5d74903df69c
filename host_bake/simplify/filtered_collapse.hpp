// SPDX-License-Identifier: GPL-3.0-or-later
// Where a filtered edge collapse puts its vertex (Sec. 4.1 to 4.3.1).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host_bake/simplify/quadric.hpp"
#include "host_bake/simplify/surface.hpp"

namespace palpate::bake {

/// Positions of a ring, gathered once for a trial.
struct RingShape {
  std::vector<Vec3d> ring, far;
  std::vector<char> has_far;
};
RingShape& gather(const Surface& surface, const Ring& ring, RingShape& shape);

/// The line on which the new vertex may lie: u = 0 is the full filter, u = 1 the start.
struct FilterLine {
  Vec3d initial{};  ///< v^
  Vec3d goal{};     ///< v~

  [[nodiscard]] Vec3d at(double u) const { return u * initial + (1 - u) * goal; }
};

/// Relaxed from `initial`. A vertex on a boundary stays: second differences are not defined there.
FilterLine filter_from(Vec3d initial, const Ring& ring, const RingShape& shape);

/// Resolution of the edge (eq. 1). N is the mean of the normals at the goal, weighted by area (the
/// paper only says averaged). At most 1e7: projected lengths below that are not resolved by float.
double resolution(const Surface& surface, const Ring& ring, const RingShape& shape,
                  const FilterLine& line);

/// Part of [0, 1] on which eq. 2 holds for every edge inside a patch; the linear program of eqs. 3
/// and 4. patch_of has an entry a face.
struct Feasible {
  double low = 0, high = 1;
  [[nodiscard]] bool empty() const { return !(low <= high); }
};
Feasible feasible_part(const Ring& ring, const RingShape& shape, const FilterLine& line,
                       std::span<const std::uint32_t> patch_of);

/// Eq. 2 as an interval: where a + u (b - a) <= 0 on what is left of `part`.
void restrict_to_negative(double at_goal, double at_initial, Feasible& part);

}  // namespace palpate::bake
