// SPDX-License-Identifier: GPL-3.0-or-later
// Recorded poses: POSES.csv.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/scene.hpp"

namespace palpate::cli {

inline constexpr std::string_view kPosesHeader = "t,body,px,py,pz,qw,qx,qy,qz";

/// One row: a body's new pose.
struct PoseChange {
  std::uint32_t body = 0;  ///< index into the scene's bodies
  Pose pose;
};

/// One distinct time: what changes before the tick.
struct PoseTick {
  double t_s = 0;
  std::size_t first = 0;    ///< into PoseTrack::changes
  std::size_t changes = 0;  ///< each of another body
};

struct PoseTrack {
  std::vector<PoseTick> ticks;  ///< times ascending
  std::vector<PoseChange> changes;

  /// Brings `poses` [bodies of the scene] from the tick before to this one: a body without a row
  /// keeps its last pose.
  void apply(std::size_t tick, std::span<Pose> poses) const;
};

/// Reads a pose file for a scene. The header is kPosesHeader; lines end in LF or CRLF; empty lines
/// are skipped. Throws Failure(kRefused) with file and line: not readable, another header, not nine
/// fields, a number that is malformed, not finite or out of range, a quaternion off unit length by
/// more than 1e-3 (less is normalised), time running backwards, an unknown or fixed body, a body
/// twice at one time, no rows.
PoseTrack read_poses(const std::filesystem::path& file, const config::Scene& scene);

/// One line of a pose file; times in full milliseconds.
std::string pose_row(double t_s, const std::string& body, const Pose& pose);

}  // namespace palpate::cli
