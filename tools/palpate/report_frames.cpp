// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/report_frames.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "tools/palpate/sweep_figures.hpp"

namespace palpate::cli {
namespace {

int bin_of(std::uint64_t ns) {
  return static_cast<int>(std::floor(kBinsPerOctave * std::log2(static_cast<double>(ns))));
}

}  // namespace

Frames frames_of(std::size_t ticks, std::size_t limit) {
  const std::size_t stride = (ticks + limit - 1) / limit;
  return {ticks, stride, (ticks + stride - 1) / stride};
}

DurationBins bin_durations(std::span<const std::vector<std::uint64_t>> sets_ns) {
  int first = std::numeric_limits<int>::max(), last = std::numeric_limits<int>::min();
  for (const auto& set : sets_ns) {
    for (const std::uint64_t ns : set) {
      if (ns == 0) continue;
      first = std::min(first, bin_of(ns));
      last = std::max(last, bin_of(ns));
    }
  }
  DurationBins out;
  for (int bin = first; bin <= last; ++bin) {
    out.from_us.push_back(static_cast<float>(std::exp2(double(bin) / kBinsPerOctave) * 1e-3));
  }
  for (const auto& set : sets_ns) {
    auto& counts = out.counts.emplace_back(out.from_us.size(), 0u);
    for (const std::uint64_t ns : set) {
      if (ns > 0) ++counts[static_cast<std::size_t>(bin_of(ns) - first)];
    }
  }
  return out;
}

double quantile(std::vector<double> values, double share) {
  std::erase_if(values, [](double v) { return std::isnan(v); });
  return percentile(std::move(values), share);
}

double distance_error_m(const TickRow& tick, const TickRow& exact) {
  return std::abs(tick.min_distance_m - exact.min_distance_m);
}

}  // namespace palpate::cli
