// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/image_json.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>

#include "tools/palpate/words.hpp"

namespace palpate::cli {
namespace {

nlohmann::json level_json(const image::Level& level, std::size_t index) {
  const bool is_free = level.free != 0;
  nlohmann::json j{{"level", index},
                   {"free", is_free},
                   {"triangles", level.triangles},
                   {"pieces", level.pieces},
                   {"resolution", level.resolution},
                   {"max_surface_deviation_rel", level.max_surface_deviation_rel},
                   {"max_hausdorff_rel", level.max_hausdorff_rel},
                   {"min_support_area_rel", level.min_support_area_rel}};
  if (is_free) {
    j["triangles"] = nullptr;
    j["resolution"] = nullptr;
  }
  return j;
}

nlohmann::json regions_json(const ImageView& image) {
  if (image.regions.empty()) return nullptr;
  return {{"count", image.regions.size()},
          {"largest_radius_rel", largest_region_radius(image)},
          {"nodes", image.region_nodes.size()},
          {"engine_bytes", engine_bytes(image, EngineKind::regions)}};
}

}  // namespace

std::size_t engine_bytes(const ImageView& image, EngineKind engine) {
  const std::array bodies{image, image};
  const std::array pairs{BodyPair{.a = 0, .b = 1}};
  return required_bytes({.bodies = bodies, .pairs = pairs, .tool = 0}, Limits{}, engine);
}

float largest_region_radius(const ImageView& image) {
  float largest = 0;
  for (const image::Region& region : image.regions) largest = std::max(largest, region.radius);
  return largest;
}

nlohmann::json image_json(const ImageView& image) {
  const image::Header& h = *image.header;
  nlohmann::json levels = nlohmann::json::array();
  for (const image::Level& level : image.levels) {
    levels.push_back(level_json(level, levels.size()));
  }
  return {{"format_version", std::to_string(h.format_major) + "." + std::to_string(h.format_minor)},
          {"bytes", h.total_bytes},
          {"radius_m", h.radius_m},
          {"centre_m", h.centre_m},
          {"source",
           {{"triangles", h.source_triangles},
            {"vertices", h.source_vertices},
            {"components", h.source_components},
            {"boundary_edges", h.source_boundary_edges},
            {"crossings", h.source_crossings},
            {"deviation_rel", h.source_deviation_rel},
            {"sha256", hex(h.source_sha256)}}},
          {"content_sha256", hex(h.content_sha256)},
          {"delta_rel", h.delta_rel},
          {"stop",
           {{"resolution", h.stop_resolution},
            {"deviation_rel", h.stop_deviation_rel},
            {"pieces", h.stop_pieces}}},
          {"dropped_levels", h.dropped_levels},
          {"s0_min", h.s0_min},
          {"partner_area", h.partner_area},
          {"pieces_total", image.pieces.size()},
          {"leaf_pieces", h.leaf_pieces},
          {"tree_depth", h.tree_depth},
          {"max_hull_vertices", h.max_hull_vertices},
          {"engine_bytes", engine_bytes(image, EngineKind::levels)},
          {"regions", regions_json(image)},
          {"levels", levels}};
}

}  // namespace palpate::cli
