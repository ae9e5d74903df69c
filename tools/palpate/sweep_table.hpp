// SPDX-License-Identifier: GPL-3.0-or-later
// The table of a sweep: sweep.json and sweep.csv (docs/SWEEP.md, "Columns").
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tools/palpate/sweep_figures.hpp"
#include "tools/palpate/sweep_folder.hpp"
#include "tools/palpate/sweep_settings.hpp"

namespace palpate::cli {

/// One setting; NaN: there is no such figure.
struct SweepRow {
  SweepSetting setting;
  SweepFigures figures;
  double force_nrmse_levels = 0;
  double speedup_median = 0;
  double front_ratio = 0;
  bool pareto = false;
};

/// A row a setting, in their order, from the ticks in the folder. All settings and the references
/// of all of them must be there.
std::vector<SweepRow> tabulate(const SweepFolder& folder, std::span<const SweepSetting> settings,
                               const Observer& observer);

std::string to_json(std::span<const SweepRow> rows);

/// The settings of such a text, in its order; none where it is no such text.
std::vector<SweepSetting> settings_of(const std::string& json);

std::string to_csv(std::span<const SweepRow> rows);

}  // namespace palpate::cli
