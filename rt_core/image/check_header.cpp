// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include "rt_core/image/checks.hpp"
#include "rt_core/image/region_format.hpp"

namespace palpate::image::checks {
namespace {

constexpr std::uint32_t kKnownFlags = static_cast<std::uint32_t>(HeaderFlag::repaired) |
                                      static_cast<std::uint32_t>(HeaderFlag::open) |
                                      static_cast<std::uint32_t>(HeaderFlag::self_crossing) |
                                      static_cast<std::uint32_t>(HeaderFlag::grown_support);

// Bytes a record, by slot.
constexpr std::uint32_t kStrides[] = {
    sizeof(Level),         sizeof(Piece),          sizeof(Vertex),          sizeof(std::uint32_t),
    sizeof(std::uint32_t), sizeof(Triangle),       sizeof(VirtualFace),     sizeof(Vertex),
    sizeof(RegionNode),    sizeof(RegionTriangle), sizeof(Region),          sizeof(ProximityGrid),
    sizeof(std::uint32_t), sizeof(std::uint32_t),  sizeof(SurfaceVertex),   sizeof(SurfaceNormal),
    sizeof(std::uint32_t), sizeof(SurfaceRun),     sizeof(TriangleVertices)};
constexpr std::size_t kKnownSections = sizeof(kStrides) / sizeof(kStrides[0]);
constexpr SectionId kRequired[] = {SectionId::levels, SectionId::pieces, SectionId::vertices,
                                   SectionId::triangles};

bool is_newer(const Header& header) noexcept { return header.format_minor > kFormatMinor; }

bool flag(const Header& header, HeaderFlag f) noexcept {
  return (header.flags & static_cast<std::uint32_t>(f)) != 0;
}

bool reserved_clear(const Header& header) noexcept {
  std::uint32_t bits = header.reserved0 | header.reserved1 | (header.flags & ~kKnownFlags);
  for (const std::uint8_t r : header.reserved2) bits |= r;
  return bits == 0;
}

bool source_sound(const Header& header) noexcept {
  return header.source_triangles >= 1 && header.source_vertices >= 1 &&
         header.source_components >= 1 && header.source_components <= header.source_triangles &&
         flag(header, HeaderFlag::open) == (header.source_boundary_edges > 0) &&
         flag(header, HeaderFlag::self_crossing) == (header.source_crossings > 0);
}

bool numbers_sound(const Header& header) noexcept {
  constexpr float kLargest = std::numeric_limits<float>::max();
  for (const double c : header.centre_m) {
    if (!within(c, -kMaxCentre_m, kMaxCentre_m)) return false;
  }
  return within(header.radius_m, kMinRadius_m, kMaxRadius_m) &&
         within(header.delta_rel, 0.0f, kMaxLength) &&
         within(header.stop_resolution, 0.0f, kLargest) &&
         within(header.stop_deviation_rel, 0.0f, kMaxLength) &&
         within(header.s0_min, 0.0f, kLargest) && within(header.partner_area, 0.0f, kLargest) &&
         within(header.source_deviation_rel, 0.0f, kMaxLength);
}

// An image without the original surface says what it serves; one with it serves everything.
bool promise_sound(const Header& header) noexcept {
  return header.dropped_levels <= kMaxLevels &&
         (header.dropped_levels > 0) == (header.s0_min > 0) &&
         (header.dropped_levels > 0 || header.partner_area == 0);
}

std::uint64_t aligned(std::uint64_t offset) noexcept {
  return (offset + (kAlignment - 1)) / kAlignment * kAlignment;
}

// [first, last) lies in `bytes` and is shorter than kAlignment.
bool padding_clear(std::span<const std::byte> bytes, std::uint64_t first,
                   std::uint64_t last) noexcept {
  for (std::uint64_t i = first; i < last; ++i) {
    if (bytes[static_cast<std::size_t>(i)] != std::byte{0}) return false;
  }
  return true;
}

bool stride_sound(const Header& header, std::size_t slot) noexcept {
  const std::uint32_t stride = header.sections[slot].stride;
  return slot < kKnownSections ? stride == kStrides[slot] : is_newer(header) && stride > 0;
}

// Moves `cursor` from the end of the section before this one to the end of this one.
bool section_sound(const Header& header, std::size_t slot, std::span<const std::byte> bytes,
                   std::uint64_t& cursor) noexcept {
  const Section& section = header.sections[slot];
  if (section.count == 0) return section.offset == 0 && section.stride == 0;
  const std::uint64_t length = std::uint64_t{section.count} * section.stride;
  if (!stride_sound(header, slot) || section.offset != aligned(cursor) ||
      section.offset > bytes.size() || length > bytes.size() - section.offset ||
      !padding_clear(bytes, cursor, section.offset)) {
    return false;
  }
  cursor = section.offset + length;
  return true;
}

}  // namespace

Status check_header(const Header& header) noexcept {
  const bool sound = header.header_bytes == sizeof(Header) &&
                     (is_newer(header) || reserved_clear(header)) && source_sound(header) &&
                     numbers_sound(header) && promise_sound(header);
  return sound ? Status::ok : Status::image_bad_header;
}

Status check_sections(const Header& header, std::span<const std::byte> bytes) noexcept {
  std::uint64_t cursor = sizeof(Header);
  for (std::size_t slot = 0; slot < kSectionSlots; ++slot) {
    if (!section_sound(header, slot, bytes, cursor)) return Status::image_bad_section;
  }
  if (aligned(cursor) != bytes.size() || !padding_clear(bytes, cursor, bytes.size())) {
    return Status::image_bad_section;
  }
  for (const SectionId id : kRequired) {
    if (header.sections[static_cast<std::size_t>(id)].count == 0) {
      return Status::image_missing_section;
    }
  }
  return Status::ok;
}

}  // namespace palpate::image::checks
