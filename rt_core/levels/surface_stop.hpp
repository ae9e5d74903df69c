// SPDX-License-Identifier: Apache-2.0
// The stop at closest features of the original surfaces: where hulls that hold everything below a
// node are nearest at points of the original surfaces, no pair below it is nearer.
#pragma once

#include "rt_core/levels/leaf_contact.hpp"
#include "rt_core/levels/work.hpp"

namespace palpate::levels {

/// What the query of a node's culling hulls says of the surfaces below.
struct SurfaceStop {
  bool stops = false;
  LeafContact contact;  ///< where it stops: on both original surfaces
};

/// Original descendants may stick out of the culling hulls by this share of delta, for a stop: the
/// least distance below a node is then known to that much.
inline constexpr double kStopResidual = 0.01;

/// Queries the culling hulls of a node, as Probe::cull does, and with Rules::stop_on_surface looks
/// whether their closest features are of the original surfaces: vertices of the hulls, which are
/// points of the original, or edges and corners of one triangle of level 0 below. Never in exact
/// queries, with Bounds::paper (whose hulls hold no original points), or where the hulls overlap.
/// One query, and the pieces around the feature, at most kMaxFeaturePieces a body.
SurfaceStop probe_surface(Work& work, Node& node) noexcept;

inline constexpr std::uint32_t kMaxFeaturePieces = 64;

/// Gives the node that contact in place of what is below: nothing of it is nearer, farther ones are
/// left out.
void stop_on_surface(Work& work, Node& node, const SurfaceStop& surface) noexcept;

}  // namespace palpate::levels
