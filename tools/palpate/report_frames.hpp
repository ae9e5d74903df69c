// SPDX-License-Identifier: GPL-3.0-or-later
// What a report shows of long recordings: frames in place of ticks, bins in place of times.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tools/palpate/replay_csv.hpp"

namespace palpate::cli {

/// Frames of one 3D view at most: 28 bytes a frame and body, and their contacts.
inline constexpr std::size_t kMaxFrames = 5000;
/// Frames of the plots of one report at most, over all its lines: who zooms in sees every tick.
inline constexpr std::size_t kMaxPlotFrames = 100'000;

/// Every stride-th tick, beginning with the first.
struct Frames {
  std::size_t ticks = 0;   ///< of the recording, >= 1
  std::size_t stride = 1;  ///< ticks a frame
  std::size_t count = 0;   ///< frames, at most the limit

  [[nodiscard]] std::size_t tick(std::size_t frame) const { return frame * stride; }

  /// [count] what `value(tick)` is at each frame's own tick.
  template <class Value>
  [[nodiscard]] std::vector<float> sample(Value value) const {
    std::vector<float> out;
    out.reserve(count);
    for (std::size_t f = 0; f < count; ++f) out.push_back(static_cast<float>(value(tick(f))));
    return out;
  }

  /// [count] the largest `value(tick)` of the ticks from each frame to the next: no peak is lost.
  template <class Value>
  [[nodiscard]] std::vector<float> peak(Value value) const {
    std::vector<float> out;
    out.reserve(count);
    for (std::size_t f = 0; f < count; ++f) {
      auto most = static_cast<double>(value(tick(f)));
      for (std::size_t t = tick(f) + 1; t < std::min(tick(f + 1), ticks); ++t) {
        most = std::max(most, static_cast<double>(value(t)));
      }
      out.push_back(static_cast<float>(most));
    }
    return out;
  }
};

/// @param ticks, limit  >= 1
Frames frames_of(std::size_t ticks, std::size_t limit = kMaxFrames);
/// Those of the plots. @param lines  >= 1
inline Frames plot_frames_of(std::size_t ticks, std::size_t lines) {
  return frames_of(ticks, std::max(kMaxFrames, kMaxPlotFrames / lines));
}

/// How often each duration occurs, in bins of equal width on a logarithmic axis.
struct DurationBins {
  std::vector<float> from_us;                      ///< [bins] lower ends
  std::vector<std::vector<std::uint32_t>> counts;  ///< [sets][bins]
};
inline constexpr int kBinsPerOctave = 4;

/// @param sets_ns  each set of durations with its own counts over common bins; zeros, which stand
/// for ticks that were not timed, are left out. No bins where nothing was timed.
DurationBins bin_durations(std::span<const std::vector<std::uint64_t>> sets_ns);

/// percentile() of the values that are not NaN.
double quantile(std::vector<double> values, double share);

/// How far a tick's least distance is from the exact one's, metres; NaN where one of them has none.
double distance_error_m(const TickRow& tick, const TickRow& exact);

}  // namespace palpate::cli
