// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/image_text.hpp"

#include <array>
#include <cinttypes>
#include <cstdarg>
#include <cstdio>

#include "tools/palpate/image_json.hpp"

namespace palpate::cli {
namespace {

__attribute__((format(printf, 2, 3))) void append(std::string& out, const char* format, ...) {
  std::array<char, 256> line{};
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line.data(), line.size(), format, arguments);
  va_end(arguments);
  out += line.data();
}

bool flag(const image::Header& header, image::HeaderFlag f) {
  return (header.flags & static_cast<std::uint32_t>(f)) != 0;
}

void append_hash(std::string& out, const char* name, const std::uint8_t (&hash)[32]) {
  out += name;
  for (const std::uint8_t b : hash) append(out, "%02x", static_cast<unsigned>(b));
  out += '\n';
}

void append_source(std::string& out, const image::Header& h) {
  append(out, "source         %u triangles, %u vertices, %u component%s, ", h.source_triangles,
         h.source_vertices, h.source_components, h.source_components == 1 ? "" : "s");
  if (flag(h, image::HeaderFlag::open)) {
    append(out, "%u boundary edges", h.source_boundary_edges);
  } else {
    out += "closed";
  }
  if (flag(h, image::HeaderFlag::self_crossing)) {
    append(out, ", %u pairs of faces cross", h.source_crossings);
  }
  if (h.source_deviation_rel > 0) {
    append(out, ", within %.3g of the radius of the mesh read",
           static_cast<double>(h.source_deviation_rel));
  }
  out += flag(h, image::HeaderFlag::repaired) ? ", repaired before baking\n" : "\n";
  append_hash(out, "  SHA-256      ", h.source_sha256);
}

void append_header(std::string& out, const ImageView& image) {
  const image::Header& h = *image.header;
  append(out, "image          format %u.%u, %" PRIu64 " bytes\n", unsigned{h.format_major},
         unsigned{h.format_minor}, h.total_bytes);
  append_hash(out, "  SHA-256      ", h.content_sha256);
  append_source(out, h);
  append(out, "object         radius %.6g m, centre (%.6g, %.6g, %.6g) m\n", h.radius_m,
         h.centre_m[0], h.centre_m[1], h.centre_m[2]);
  append(out, "metrics for    contact tolerance %.6g of the radius (%.6g m)\n",
         static_cast<double>(h.delta_rel), static_cast<double>(h.delta_rel) * h.radius_m);
  append(out, "tree           %zu pieces, %u on the longest way down, up to %u children a piece\n",
         image.pieces.size(), h.tree_depth, h.max_children);
  append(out, "pieces         up to %u hull vertices, %u neighbours a vertex, %u triangles\n",
         h.max_hull_vertices, h.max_valence, h.max_patch_triangles);
  if (h.dropped_levels > 0) {
    append(
        out,
        "serves         s0 from %.6g up, against support areas from %.6g up; %u finer level%s left "
        "out\n",
        static_cast<double>(h.s0_min), static_cast<double>(h.partner_area), h.dropped_levels,
        h.dropped_levels == 1 ? "" : "s");
  }
  append(out, "engine memory  %zu bytes for two bodies of this image",
         engine_bytes(image, EngineKind::levels));
  if (image.regions.empty()) {
    out += "\n";
    return;
  }
  append(out, " (levels), %zu (regions)\n", engine_bytes(image, EngineKind::regions));
  append(out, "regions        %zu, of radii up to %.3g, in a tree of %zu nodes\n",
         image.regions.size(), static_cast<double>(largest_region_radius(image)),
         image.region_nodes.size());
}

// The coarsest level that simplification made is the last one that is not free.
void append_table_2(std::string& out, const ImageView& image) {
  const image::Level& finest = image.levels.front();
  const image::Level& coarsest = image.levels[image.levels.size() - image.header->free_levels - 1];
  append(out, "\n%11s %10s %11s %10s %10s %10s %10s %6s\n", "Orig. Tris", "Orig. Pcs", "Simp. Tris",
         "Simp. Pcs", "r_1", "r_lambda", "Free LODs", "LODs");
  const std::uint32_t triangles = image.header->source_triangles;
  append(out, "%11u %10u %11u %10u %10.2f %10.2f %10u %6zu\n", triangles, finest.pieces,
         coarsest.triangles, coarsest.pieces, static_cast<double>(finest.resolution),
         static_cast<double>(coarsest.resolution), image.header->free_levels, image.levels.size());
}

void append_levels(std::string& out, const ImageView& image) {
  append(out, "\n%5s %10s %8s %11s %11s %11s %11s\n", "level", "triangles", "pieces", "resolution",
         "largest s", "largest h", "smallest D");
  for (std::size_t i = 0; i < image.levels.size(); ++i) {
    const image::Level& level = image.levels[i];
    if (level.free != 0) {
      append(out, "%5zu %10s %8u %11s", i, "free", level.pieces, "-");
    } else {
      append(out, "%5zu %10u %8u %11.2f", i, level.triangles, level.pieces,
             static_cast<double>(level.resolution));
    }
    append(out, " %11.4g %11.4g %11.4g\n", static_cast<double>(level.max_surface_deviation_rel),
           static_cast<double>(level.max_hausdorff_rel),
           static_cast<double>(level.min_support_area_rel));
  }
}

}  // namespace

std::string table_2_text(const ImageView& image) {
  std::string out;
  append_table_2(out, image);
  return out;
}

std::string image_text(const ImageView& image) {
  std::string out;
  append_header(out, image);
  append_table_2(out, image);
  append_levels(out, image);
  return out;
}

}  // namespace palpate::cli
