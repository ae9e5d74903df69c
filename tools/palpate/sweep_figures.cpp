// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/sweep_figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::cli {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kRounding = 2e-6;       // of the radius, in a distance from float geometry
constexpr double kBoundSlack = 1.0001;   // a bound is itself rounded
constexpr double kNearlyDelta = 0.99;    // farther, a contact may be missed by rounding
constexpr double kRightDistance = 1e-6;  // of delta: smaller errors say nothing of a bound

void cost(std::span<const TickRow> ticks, SweepFigures& out) {
  std::vector<double> times;
  const double share = 1.0 / double(ticks.size());
  for (const TickRow& tick : ticks) {
    if (tick.time_ns > 0) times.push_back(double(tick.time_ns));
    out.front_mean += share * double(tick.front_nodes);
    out.queries_mean += share * double(tick.queries);
    if (tick.certificate.truncated()) out.truncated += share;
  }
  out.timed_ticks = times.size();
  out.median_ns = percentile(times, 0.5);
  out.p99_ns = percentile(times, 0.99);
  out.p999_ns = percentile(times, 0.999);
  out.max_ns = percentile(times, 1.0);
}

void force_error(std::span<const TickRow> ticks, std::span<const TickRow> exact,
                 const Observer& observer, SweepFigures& out) {
  std::vector<double> angles;
  std::vector<Vec3d> torques, true_torques;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const Vec3d force = ticks[i].wrench.force_N;
    const Vec3d truth = exact[i].wrench.force_N;
    torques.push_back(ticks[i].wrench.torque_Nm);
    true_torques.push_back(exact[i].wrench.torque_Nm);
    out.force_error_max_N = std::max(out.force_error_max_N, norm(force - truth));
    if (i > 0) {
      out.force_step_max_N =
          std::max(out.force_step_max_N, norm(force - ticks[i - 1].wrench.force_N));
    }
    if (noticeable(observer, force, truth)) out.noticeable += 1.0 / double(ticks.size());
    if (norm(force) > observer.floor_N && norm(truth) > observer.floor_N) {
      angles.push_back(std::atan2(norm(cross(force, truth)), dot(force, truth)));
    }
  }
  out.force_nrmse = nrmse(forces_of(ticks), forces_of(exact));
  out.torque_nrmse = nrmse(torques, true_torques);
  out.direction_error_median_rad = percentile(angles, 0.5);
}

void certainty(std::span<const TickRow> ticks, std::span<const TickRow> exact, double delta_m,
               double radius_m, SweepFigures& out) {
  std::vector<double> bounds, errors, ratios;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const Certificate& certificate = ticks[i].certificate;
    bounds.push_back(certificate.error_bound_m);
    out.s_worst_mean += certificate.s_worst / double(ticks.size());
    out.s_worst_max = std::max(out.s_worst_max, certificate.s_worst);
    const double error_m = std::abs(ticks[i].min_distance_m - exact[i].min_distance_m);
    if (!std::isnan(error_m)) errors.push_back(error_m);
    if (error_m > kRightDistance * delta_m) ratios.push_back(certificate.error_bound_m / error_m);
    if (certificate_broken(ticks[i], exact[i].min_distance_m, delta_m, radius_m)) {
      ++out.certificates_broken;
    }
  }
  out.error_bound_median_m = percentile(bounds, 0.5);
  out.error_bound_max_m = percentile(bounds, 1.0);
  out.true_error_median_m = percentile(errors, 0.5);
  out.bound_over_error_median = percentile(ratios, 0.5);
}

}  // namespace

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return kNone;
  const auto rank = static_cast<std::size_t>(std::ceil(share * double(values.size())));
  const auto place = values.begin() + std::ptrdiff_t(std::max<std::size_t>(rank, 1) - 1);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

double nrmse(std::span<const Vec3d> values, std::span<const Vec3d> truth) {
  double error = 0, size = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    error += squared_norm(values[i] - truth[i]);
    size += squared_norm(truth[i]);
  }
  if (error == 0) return 0;
  return size > 0 ? std::sqrt(error / size) : kNone;
}

bool noticeable(const Observer& observer, Vec3d force_N, Vec3d truth_N) {
  return norm(force_N - truth_N) >
         std::max(observer.weber_fraction * norm(truth_N), observer.floor_N);
}

bool certificate_broken(const TickRow& tick, double exact_distance_m, double delta_m,
                        double radius_m) {
  if (std::isnan(exact_distance_m) || exact_distance_m <= 0) return false;
  const double bound_m = tick.certificate.error_bound_m;
  if (std::isnan(tick.min_distance_m)) return exact_distance_m + bound_m < kNearlyDelta * delta_m;
  return std::abs(tick.min_distance_m - exact_distance_m) >
         kBoundSlack * bound_m + kRounding * radius_m;
}

SweepFigures figures(std::span<const TickRow> ticks, std::span<const TickRow> exact,
                     const Observer& observer, double delta_m, double radius_m) {
  SweepFigures out;
  out.ticks = ticks.size();
  cost(ticks, out);
  force_error(ticks, exact, observer, out);
  certainty(ticks, exact, delta_m, radius_m, out);
  return out;
}

std::vector<Vec3d> forces_of(std::span<const TickRow> ticks) {
  std::vector<Vec3d> out;
  for (const TickRow& tick : ticks) out.push_back(tick.wrench.force_N);
  return out;
}

}  // namespace palpate::cli
