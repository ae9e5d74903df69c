// SPDX-License-Identifier: GPL-3.0-or-later
// How a run or a replay starts: the mock hand's motion, and what is inside what.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "config/scene.hpp"
#include "tools/palpate/scene_engine.hpp"

namespace palpate::cli {

/// A pose file as the mock hand's path; its first row is the start. Throws Failure as read_poses()
/// does, and kRefused where another body moves: the hand holds the tool alone.
std::vector<config::Waypoint> hand_path(const std::filesystem::path& poses,
                                        const config::Scene& scene);

/// "'upper' and 'lower' overlap at the start, by 0.0003 m", and so on for each pair; empty where
/// nothing is inside anything by more than a hundredth of delta.
std::string overlap_line(const config::Scene& scene, std::span<const Contact> contacts);

/// The same, of bodies where the hand begins. One tick without a budget; the engine is as new
/// afterwards.
std::string overlap_line(const config::Scene& scene, SceneEngine& engine, bool hand_on_path);

}  // namespace palpate::cli
