// SPDX-License-Identifier: GPL-3.0-or-later
// An image's figures as JSON: `inspect --json`, and the first part of `bake --report`.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>

#include "rt_core/palpate_rt.hpp"

namespace palpate::cli {

/// Memory that an engine needs for a scene of two bodies of this image with the default limits,
/// bytes.
std::size_t engine_bytes(const ImageView& image, EngineKind engine);

/// The object documented for `inspect --json`: keys format_version, bytes, radius_m, centre_m,
/// source, delta_rel, pieces_total, leaf_pieces, tree_depth, max_hull_vertices, engine_bytes (of
/// `levels`), content_sha256, levels (finest first), and regions (null without: count,
/// largest_radius_rel, nodes, engine_bytes). Keys ending in _rel are for the model scaled to
/// radius 1; triangles and resolution are null on free levels.
nlohmann::json image_json(const ImageView& image);

/// Of the largest region; 0 without regions.
float largest_region_radius(const ImageView& image);

}  // namespace palpate::cli
