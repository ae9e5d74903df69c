// SPDX-License-Identifier: GPL-3.0-or-later
// The plots of a sweep, as SVG text.
#pragma once

#include <span>
#include <string>

#include "tools/palpate/sweep_table.hpp"

namespace palpate::cli {

/// Force error against median time, a point a setting; a panel for each delta, a colour for each
/// engine and for the Pareto front.
std::string trade_plot(std::span<const SweepRow> rows);

/// Force, time and front against tick (the paper's Figs. 10 and 11) at the first delta: the exact
/// runs, and the settings without budget and kappa, up to six in all, the others left out.
std::string profile_plot(const SweepFolder& folder, std::span<const SweepRow> rows);

}  // namespace palpate::cli
