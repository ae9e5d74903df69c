// SPDX-License-Identifier: GPL-3.0-or-later
// The data of a report's page: one JSON object, docs/REPORT.md, "The data". Arrays of numbers are
// little-endian float32 or uint32 in base64: a third of their text.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <type_traits>

#include "tools/palpate/report_contacts.hpp"
#include "tools/palpate/report_frames.hpp"
#include "tools/palpate/report_input.hpp"

namespace palpate::cli {

/// RFC 4648, Sec. 4.
std::string base64(std::span<const std::byte> bytes);

/// The bytes of plain records, in base64.
template <class Range>
std::string packed(const Range& values) {
  static_assert(std::is_trivially_copyable_v<typename Range::value_type>);
  return base64(std::as_bytes(std::span(values)));
}

/// Everything but the view. @param frames  of the plots, of input.lines; ignored where there are
/// none
nlohmann::ordered_json report_json(const ReportInput& input, const Frames& frames);

/// How many frames, how many ticks each, and when: times of the first line. @param input  has lines
nlohmann::ordered_json frames_json(const ReportInput& input, const Frames& frames);

/// The 3D view but for its frames_json(). Opens the scene's images: throws Failure(kRefused) where
/// one is refused or does not have a piece that a contact names.
nlohmann::ordered_json view_json(const ReportScene& view, const ShownContacts& contacts,
                                 const Frames& frames);

/// The bodies of a scene where it puts them: what view_json() begins with, for a live view. Throws
/// likewise.
nlohmann::ordered_json scene_json(const config::Scene& scene);

}  // namespace palpate::cli
