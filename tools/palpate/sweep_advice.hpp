// SPDX-License-Identifier: GPL-3.0-or-later
// Which setting of a sweep to take.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "tools/palpate/sweep_table.hpp"

namespace palpate::cli {

/// The row of the least force_nrmse whose p999_ns is at most budget_us; of several with the same
/// error the one of the least p999_ns. Null where none fits.
const SweepRow* most_accurate(std::span<const SweepRow> rows, double budget_us);

/// What it costs and what it loses: lines for a person.
std::string advice(const SweepRow& row, double budget_us);

/// The text of the scene file with this setting in its [engine], for a file in `folder`: relative
/// images are still found from there. A setting without a budget gets budget_us as one. Keys keep
/// their values, comments are lost. Throws Failure(kUsage) where the scene cannot be read again.
std::string scene_text(const std::filesystem::path& scene, const std::filesystem::path& folder,
                       const SweepSetting& setting, double budget_us);

}  // namespace palpate::cli
