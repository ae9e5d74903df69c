// SPDX-License-Identifier: Apache-2.0
// Sensation preserving selective refinement (Sec. 5.4): which detail can be felt.
#pragma once

#include <cstdint>

#include "rt_core/convex/distance.hpp"
#include "rt_core/levels/body_pair.hpp"
#include "rt_core/palpate_rt.hpp"

namespace palpate::levels {

/// What refinement has to know of the settings.
struct Rules {
  bool exact = false;
  Bounds bounds = Bounds::tight;
  Order order = Order::deviation;
  double s0 = 0;
  double kappa = 0;  ///< infinity: no such rule
};

/// How a query is worked off. What it finds, if nothing ends it, does not depend on it.
enum class Schedule : std::uint8_t {
  by_priority,  ///< it may end at any moment: what matters most comes first, with tight bounds on
                ///< the way
  exhaustive,  ///< nothing ends it before it is exact: in the order, and with the bounds, that cost
               ///< least
};

/// Detail that a pair of pieces leaves out.
struct Detail {
  double s_star = 0;  ///< weighted surface deviation (eq. 7), relative to the radius
  bool refine_a = false;
  bool refine_b = false;
};

constexpr bool has(const image::Piece& piece, image::PieceFlag flag) noexcept {
  return (piece.flags & static_cast<std::uint32_t>(flag)) != 0;
}

/// Free pieces have no metric: always refined where they are near.
inline bool is_free(const image::Piece& piece) noexcept { return piece.triangles == 0; }

/// Whether kappa asks for more than this piece: it does wherever the piece is touched.
inline bool is_too_coarse(const PairState& pair, const image::Piece& piece, double scale,
                          const Rules& rules) noexcept {
  return scale * static_cast<double>(piece.surface_deviation) > rules.kappa * pair.delta;
}

/// The rules applied to two pieces with metrics.
///
/// phi = s / r^2 (eq. 6), s* = phi / max(D_a, D_b) (eq. 7), D at the witnesses of `query`
/// (support_area.hpp); refined where s* > s0 or s > kappa * delta. Departures: s* is taken for each
/// body by itself, relative to its own radius, and only the body whose detail can be felt is
/// refined (the paper takes the larger phi and then splits whichever piece has coarser children):
/// so levels that a scene never asks for can be left out of an image. Hulls that overlap are
/// refined in any case: simplified hulls may overlap where the original surfaces do not.
/// @param query  of the pieces' own hulls
Detail detail(const PairState& pair, const image::Piece& a, const image::Piece& b,
              const convex::Distance& query, const Rules& rules) noexcept;

/// Whether a, and not b, is to be split: of those that may be, the one with the coarser children
/// (Sec. 5.2). Free levels have no resolution and go first; among them, and between levels of equal
/// resolution, the larger piece.
bool splits_a(const PairState& pair, const image::Piece& a, const image::Piece& b, bool may_a,
              bool may_b) noexcept;

}  // namespace palpate::levels
