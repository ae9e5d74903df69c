// SPDX-License-Identifier: GPL-3.0-or-later
// What a replay costs and what it loses against the exact one: the columns of docs/SWEEP.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tools/palpate/replay_csv.hpp"

namespace palpate::cli {

/// When a hand could notice an error of force: docs/SWEEP.md, "Noticeable".
struct Observer {
  double weber_fraction = 0.10;
  double floor_N = 0.02;
};

/// NaN: there is no such figure.
struct SweepFigures {
  std::size_t ticks = 0, timed_ticks = 0;
  double median_ns = 0, p99_ns = 0, p999_ns = 0, max_ns = 0;  ///< NaN where nothing was timed
  double front_mean = 0, queries_mean = 0;
  double truncated = 0;  ///< share of ticks
  double force_nrmse = 0, torque_nrmse = 0;
  double force_error_max_N = 0;
  double direction_error_median_rad = 0;
  double noticeable = 0;  ///< share of ticks
  double force_step_max_N = 0;
  double s_worst_mean = 0, s_worst_max = 0;
  double error_bound_median_m = 0, error_bound_max_m = 0;
  double true_error_median_m = 0;
  double bound_over_error_median = 0;
  std::size_t certificates_broken = 0;
};

/// The smallest of the values that at least `share` of them do not exceed (nearest rank); NaN of
/// none. @param share in (0, 1]
double percentile(std::vector<double> values, double share);

/// Root of the summed squared errors over the summed squared true values; NaN where those are zero
/// and the errors are not, 0 where both are. One entry a tick.
double nrmse(std::span<const Vec3d> values, std::span<const Vec3d> truth);

/// Whether a hand could notice that it feels `force_N` in place of `truth_N`.
bool noticeable(const Observer& observer, Vec3d force_N, Vec3d truth_N);

/// Whether a tick's least distance lies outside what its certificate allows, given the exact one
/// (NaN: none below delta). Overlap and touch are not judged.
/// @param radius_m  of the larger body: rounding is allowed in proportion
bool certificate_broken(const TickRow& tick, double exact_distance_m, double delta_m,
                        double radius_m);

/// @param ticks, exact  one row a tick of the same track; as many of both
SweepFigures figures(std::span<const TickRow> ticks, std::span<const TickRow> exact,
                     const Observer& observer, double delta_m, double radius_m);

/// The force of every tick.
std::vector<Vec3d> forces_of(std::span<const TickRow> ticks);

}  // namespace palpate::cli
