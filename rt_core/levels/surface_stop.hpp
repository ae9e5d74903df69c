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

/// Pieces that are looked through for a feature, at most, a body.
inline constexpr std::uint32_t kMaxFeaturePieces = 64;

/// Rules::stop_on_surface is set and the culling hulls of a node may tell: they are spanned by
/// original points and hold the rest to kStopResidual. Never in exact queries or with
/// Bounds::paper, whose hulls hold no original points.
bool may_stop_on_surface(const Work& work, const Node& node) noexcept;

/// Queries the culling hulls of a node, as Probe::cull does, and where the node may stop looks
/// whether their closest features are of the original surfaces: vertices of the hulls, which are
/// points of the original, or edges and corners of one triangle of level 0 below. Not where the
/// hulls overlap. One query, and the pieces around the feature.
SurfaceStop probe_surface(Work& work, Node& node) noexcept;

/// Keeps that contact in the node, in place of what is below: nothing of it is nearer, farther ones
/// are left out.
void keep_on_surface(const PairState& pair, Node& node, const LeafContact& contact) noexcept;

}  // namespace palpate::levels
