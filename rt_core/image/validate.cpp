// SPDX-License-Identifier: Apache-2.0
#include "rt_core/image/checks.hpp"
#include "rt_core/image/sha256.hpp"
#include "rt_core/image/view.hpp"

namespace palpate {
namespace {

using image::Header;

constexpr std::size_t kHashOffset = offsetof(Header, content_sha256);
constexpr std::size_t kHashBytes = sizeof(Header::content_sha256);

// The caller has proved that the bytes are aligned and hold what is asked for.
template <class T>
const T* at(std::span<const std::byte> bytes, std::uint64_t offset) noexcept {
  return static_cast<const T*>(
      static_cast<const void*>(bytes.data() + static_cast<std::size_t>(offset)));
}

template <class T>
std::span<const T> records(std::span<const std::byte> bytes, image::SectionId id) noexcept {
  const auto& section = at<Header>(bytes, 0)->sections[static_cast<std::size_t>(id)];
  return {at<T>(bytes, section.offset), section.count};
}

ImageView view_of(std::span<const std::byte> bytes) noexcept {
  using Id = image::SectionId;
  ImageView view;
  view.header = at<Header>(bytes, 0);
  view.levels = records<image::Level>(bytes, Id::levels);
  view.pieces = records<image::Piece>(bytes, Id::pieces);
  view.vertices = records<image::Vertex>(bytes, Id::vertices);
  view.neighbour_starts = records<std::uint32_t>(bytes, Id::neighbour_starts);
  view.neighbours = records<std::uint32_t>(bytes, Id::neighbours);
  view.triangles = records<image::Triangle>(bytes, Id::triangles);
  view.virtual_faces = records<image::VirtualFace>(bytes, Id::virtual_faces);
  view.culling_vertices = records<image::Vertex>(bytes, Id::culling_vertices);
  view.region_nodes = records<image::RegionNode>(bytes, Id::region_nodes);
  view.region_triangles = records<image::RegionTriangle>(bytes, Id::region_triangles);
  view.regions = records<image::Region>(bytes, Id::regions);
  const auto grid = records<image::ProximityGrid>(bytes, Id::proximity_grid);
  view.proximity_grid = grid.empty() ? nullptr : grid.data();
  view.proximity_bricks = records<std::uint32_t>(bytes, Id::proximity_bricks);
  view.proximity_cells = records<std::uint32_t>(bytes, Id::proximity_cells);
  view.surface_vertices = records<image::SurfaceVertex>(bytes, Id::surface_vertices);
  view.vertex_normals = records<image::SurfaceNormal>(bytes, Id::vertex_normals);
  view.surface_edges = records<std::uint32_t>(bytes, Id::surface_edges);
  view.surface_runs = records<image::SurfaceRun>(bytes, Id::surface_runs);
  view.triangle_vertices = records<image::TriangleVertices>(bytes, Id::triangle_vertices);
  return view;
}

// What tells a foreign, cut or damaged file from an image.
Status check_envelope(std::span<const std::byte> bytes) noexcept {
  if (bytes.size() < sizeof(Header)) return Status::image_too_small;
  if (reinterpret_cast<std::uintptr_t>(bytes.data()) % image::kAlignment != 0) {
    return Status::image_misaligned;
  }
  const Header& header = *at<Header>(bytes, 0);
  for (std::size_t i = 0; i < sizeof(image::kMagic); ++i) {
    if (header.magic[i] != image::kMagic[i]) return Status::image_bad_magic;
  }
  if (header.byte_order_mark != image::kByteOrderMark) return Status::image_bad_byte_order;
  if (header.format_major != image::kFormatMajor) return Status::image_bad_version;
  if (header.total_bytes != bytes.size()) return Status::image_bad_size;
  const auto hash = content_sha256(bytes);
  for (std::size_t i = 0; i < hash.size(); ++i) {
    if (header.content_sha256[i] != hash[i]) return Status::image_bad_hash;
  }
  return Status::ok;
}

}  // namespace

std::array<std::uint8_t, 32> content_sha256(std::span<const std::byte> image) noexcept {
  constexpr std::byte kZeros[kHashBytes] = {};
  Sha256 hash;
  hash.update(image.first(kHashOffset));
  hash.update(kZeros);
  hash.update(image.subspan(kHashOffset + kHashBytes));
  return hash.finish();
}

Status validate(std::span<const std::byte> bytes, ImageView& out_view) noexcept {
  if (const Status s = check_envelope(bytes); s != Status::ok) return s;
  const Header& header = *at<Header>(bytes, 0);
  if (const Status s = image::checks::check_header(header); s != Status::ok) return s;
  if (const Status s = image::checks::check_sections(header, bytes); s != Status::ok) return s;

  // Each pass may read what the ones before it have proved to be in range, so the order matters.
  constexpr Status (*kPasses[])(const ImageView&) noexcept = {
      image::checks::check_levels,     image::checks::check_pieces,
      image::checks::check_tree,       image::checks::check_indices,
      image::checks::check_vertices,   image::checks::check_level_totals,
      image::checks::check_capacities, image::checks::check_regions,
      image::checks::check_proximity,  image::checks::check_surface};
  const ImageView view = view_of(bytes);
  for (const auto pass : kPasses) {
    if (const Status s = pass(view); s != Status::ok) return s;
  }
  out_view = view;
  return Status::ok;
}

}  // namespace palpate
