// SPDX-License-Identifier: GPL-3.0-or-later
// What a replay writes: TICKS.csv and CONTACTS.csv.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rt_core/palpate_rt.hpp"

namespace palpate::cli {

inline constexpr std::string_view kTicksHeader =
    "tick,t,fx,fy,fz,tx,ty,tz,contacts,clusters,min_distance,front,queries,time_ns,truncated,s_"
    "worst,error_bound,force_bound";
inline constexpr std::string_view kContactsHeader =
    "tick,pair,ax,ay,az,bx,by,bz,nx,ny,nz,distance,piece_a,lod_a,piece_b,lod_b,weight";

/// One tick; the fields are TickResult's.
struct TickRow {
  double t_s = 0;
  Wrench wrench;
  std::size_t contacts = 0;
  std::uint32_t clusters = 0;
  double min_distance_m = 0;  ///< NaN where there are no contacts: an empty field
  std::uint64_t front_nodes = 0;
  std::uint64_t queries = 0;
  std::uint64_t time_ns = 0;
  Certificate certificate;
};

struct ContactRow {
  std::size_t tick = 0;
  Contact contact;
};

// Rows as text, LF line ends. Numbers are the shortest text that reads back as the same double.

/// The whole table, with its header.
std::string ticks_csv(std::span<const TickRow> rows);

/// The same numbers back from such a table; of what ended refinement only that something did
/// (truncated_by_time stands for all). Nothing where the text is no such table or is cut short.
std::optional<std::vector<TickRow>> ticks_from_csv(std::string_view text);

/// Rows of a table that is too large to be held.
std::string contact_rows(std::span<const ContactRow> rows);

}  // namespace palpate::cli
