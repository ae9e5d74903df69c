// SPDX-License-Identifier: GPL-3.0-or-later
// The table of a sweep, sweep.json, as the report shows it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace palpate::cli {

/// One setting; NaN: the table has no such figure.
struct SweepPoint {
  std::string id;      ///< the table's, or its place in it
  std::string engine;  ///< "levels" or "regions"
  bool exact = false;
  std::string words;  ///< what tells it from the others, for people: "s0 2.5 %, budget 400 us"
  double delta_m = 0;
  double median_us = 0, p99_us = 0, p999_us = 0, max_us = 0;
  double front_mean = 0, queries_mean = 0;
  double truncated = 0;  ///< share of ticks
  double force_nrmse = 0, torque_nrmse = 0;
  double noticeable = 0;  ///< share of ticks
  double bound_m = 0;     ///< median of the certificate's error bound
  double error_m = 0;     ///< median of the true error
  double speedup = 0;     ///< of the median
  bool pareto = false;    ///< no other setting with this delta is faster and more accurate
  std::uint64_t certificates_broken = 0;
};

/// Reads sweep.json. Throws Failure(kRefused) with the file and, where one is wrong, the setting's
/// place in the list, from 0: not readable, not a list of objects, no settings, a key of the
/// contract (docs/REPORT.md, "What it reads") missing or of another type.
std::vector<SweepPoint> read_sweep(const std::filesystem::path& file);

}  // namespace palpate::cli
