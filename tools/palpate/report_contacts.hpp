// SPDX-License-Identifier: GPL-3.0-or-later
// The contacts of a report's 3D view.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "host_bake/base/error.hpp"
#include "tools/palpate/report_frames.hpp"
#include "tools/palpate/report_input.hpp"

namespace palpate::cli {

/// Of one report: 60 bytes each.
inline constexpr std::size_t kMaxShownContacts = 100'000;
/// Of one frame; fewer where a report has many frames.
inline constexpr std::size_t kMaxContactsOfFrame = 64;

struct ShownContacts {
  std::string origin;                 ///< where they are from, a sentence
  std::vector<Contact> contacts;      ///< frame by frame, those with the largest force first
  std::vector<std::uint32_t> starts;  ///< [frames + 1] into contacts
  std::vector<std::uint32_t> found;   ///< [frames] all that there were, shown or not
  std::vector<Vec3d> force_N;         ///< [frames] on the tool
};

/// From the view's CONTACTS.csv. Throws Failure(kRefused) with file and line: not readable, a row
/// that is none, a tick without as many rows as the line counts contacts, a pair that the scene
/// does not have.
ShownContacts read_shown_contacts(const ReportScene& view, const ReportLine& line,
                                  const Frames& frames);

/// By replaying the frames' poses at the scene's settings, without a budget. Throws as replay().
ShownContacts replay_shown_contacts(const ReportScene& view, const Frames& frames,
                                    const bake::Progress& progress);

}  // namespace palpate::cli
